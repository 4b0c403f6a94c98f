"""Entry point: reads the command line, runs a command and turns every failure into a message and an exit status."""

from __future__ import annotations

import argparse
import contextlib
import shlex
import signal
import sys
from collections.abc import Sequence
from importlib import import_module
from types import FrameType
from typing import NoReturn

from .. import __version__
from ..core.errors import Cancelled, InputError, InternalError
from ..core.file_places import MeshFileError, name_and_reason
from . import exit_codes
from .messages import describe_elements, say, write_error
from .setting_arguments import UsageProblem

COMMANDS = ("remesh", "check", "batch", "case")


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs ``hybrid-quad`` and returns its exit status.

    Parameters
    ----------
    arguments : sequence of str, optional
        Without the program's name; default ``sys.argv[1:]``.
    """
    given = list(sys.argv[1:] if arguments is None else arguments)
    parser = _parser(given)
    try:
        options = parser.parse_args(given)
    except SystemExit as stop:  # argparse has printed usage, help or version
        return int(stop.code or 0)
    except OSError as error:  # the help, which nobody took
        say(name_and_reason(error))
        return exit_codes.WRONG_USAGE
    _heed_signals()
    try:
        return int(options.run(options))
    except InputError as error:
        say(f"{options.input}: {error}{describe_elements(error)} [{error.code}]")
        return exit_codes.CANNOT_REMESH
    except (MeshFileError, UsageProblem, ImportError) as error:  # ImportError: an incomplete installation
        say(str(error))
        return exit_codes.WRONG_USAGE
    except (Cancelled, KeyboardInterrupt) as error:
        say(f"{options.input}: {str(error) or 'cancelled'}; nothing was written")
        return exit_codes.CANCELLED
    except MemoryError:
        say(f"{options.input}: this machine has not enough memory for the run; nothing was written")
        return exit_codes.CANCELLED
    except OSError as error:  # of the output stream, say: what else is read or written has errors of its own
        say(name_and_reason(error))
        return exit_codes.WRONG_USAGE
    except Exception as error:
        kind = "" if isinstance(error, InternalError) else f"{type(error).__name__}: "
        say(
            f"internal error: {kind}{error}\n"
            "This is a bug of hybrid-quad, not of your mesh, and nothing was written. Please report it with the mesh, "
            f"the version ({__version__}) and this command:\n  hybrid-quad {shlex.join(given)}\n"
            "hybrid-quad case packs all of that into one file, and leaves names out if asked."
        )
        return exit_codes.BUG


def _heed_signals() -> None:
    """Has a job scheduler's "terminate", and the end of the terminal, answered like Ctrl-C."""
    with contextlib.suppress(ValueError):  # not in the main thread, where alone handlers can be set
        signal.signal(signal.SIGTERM, _interrupt)
        if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) == signal.SIG_DFL:  # as under nohup it is not
            signal.signal(signal.SIGHUP, _interrupt)


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt("terminated")


class _Parser(argparse.ArgumentParser):
    """Says in a line what is wrong, which the usage of thirty options would hide, and where to read on."""

    def error(self, message: str) -> NoReturn:
        write_error(f"{self.prog}: {message}\n{self.prog} --help tells more\n")
        raise SystemExit(exit_codes.WRONG_USAGE)


def _parser(given: Sequence[str] = ()) -> argparse.ArgumentParser:
    """Of the command that is given, or, where none is, of all: each takes its time to load."""
    parser = _Parser(
        prog="hybrid-quad",
        description="Pure-quad remeshing of surface meshes.",
        epilog="Exit status: 0 done; 1 the input cannot be remeshed; 2 wrong usage or unreadable file; 3 internal "
        "error; 4 cancelled, time or memory limit. A result file is written only with 0.",
    )
    parser.add_argument("--version", action="version", version=f"hybrid-quad {__version__}")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    for command in [given[0]] if given and given[0] in COMMANDS else COMMANDS:
        import_module(f"{__package__}.{command}_command").add_to(commands)
    return parser
