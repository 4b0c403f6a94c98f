"""What the worker tells while it runs: one JSON object a line."""

from __future__ import annotations

import json
import traceback
from typing import Any

from ..core.errors import Cancelled, InputError, InternalError

Message = dict[str, Any]

# Kinds of error that come back as they were; each is made of its message alone.
_PLAIN_ERRORS: dict[str, type[Exception]] = {
    error.__name__: error for error in (ValueError, TypeError, ImportError, MemoryError, OSError)
}


def progress_message(stage: str, fraction: float) -> Message:
    """`fraction` of the whole run is done, and `stage` runs."""
    return {"event": "progress", "stage": stage, "fraction": fraction}


def done_message() -> Message:
    """The result's file is written and closed."""
    return {"event": "done"}


def stopped_message() -> Message:
    """The run was stopped, as nobody waits for it any more."""
    return {"event": "stopped"}


def error_message(error: BaseException) -> Message:
    """The run failed; all that the error says of itself."""
    message: Message = {"event": "error", "kind": _kind_of(error), "text": str(error)}
    if isinstance(error, InputError):
        message.update(code=error.code, element_kind=error.element_kind, elements=list(error.elements))
    elif isinstance(error, Cancelled):
        message.update(code=error.code)
    elif isinstance(error, InternalError):
        message.update(stage=error.stage)
    else:
        message.update(name=type(error).__name__)
    message["traceback"] = "".join(traceback.format_exception(type(error), error, error.__traceback__))
    return message


def error_of(message: Message) -> Exception:
    """The error that :func:`error_message` described, of the same kind.

    What is no error of this package's nor one of the plain ones is a bug of ours: InternalError. The worker's traceback
    is the cause, so that it is printed with the error.
    """
    kind, text = message["kind"], message["text"]
    error: Exception
    if kind == "InputError":
        error = InputError(message["code"], text, message["element_kind"], message["elements"])
    elif kind == "Cancelled":
        error = Cancelled(text, message["code"])
    elif kind == "InternalError":
        error = InternalError(text, message["stage"])
    elif kind in _PLAIN_ERRORS:
        error = _PLAIN_ERRORS[kind](text)
    else:
        error = InternalError(f"{message['name']}: {text}")
    error.__cause__ = WorkerTraceback(message["traceback"])
    return error


def encode(message: Message) -> bytes:
    """One line of ASCII."""
    return json.dumps(message).encode() + b"\n"


def decode(line: bytes) -> Message | None:
    """The message in a line; None where it is none, as a line of another program."""
    try:
        message = json.loads(line)
    except ValueError:
        return None
    return message if isinstance(message, dict) and "event" in message else None


class WorkerTraceback(Exception):
    """Where in the worker an error was raised, as text."""

    def __str__(self) -> str:
        return f"\n{self.args[0]}"


def _kind_of(error: BaseException) -> str:
    for kind in (InputError, Cancelled, InternalError, *_PLAIN_ERRORS.values()):
        if isinstance(error, kind):
            return kind.__name__
    return ""
