"""The program of the worker process: reads one request, solves it, writes the result.

Started by :mod:`.process` with a Python, or with Blender as one; never imported. The last argument names the file of its
order (JSON). Its input stays open for as long as somebody waits for the result; what it has to say goes to a file.
"""

from __future__ import annotations

import contextlib
import faulthandler
import importlib
import importlib.util
import json
import os
import shutil
import sys
import threading
from typing import Any

_NICENESS = 5  # so that the window stays smooth while every core works
_DIES_FIRST = "500"  # of 1000: where memory runs out, Linux ends this process rather than Blender


def main() -> None:
    """Does what the order says and ends the process."""
    control = _take_input()
    faulthandler.enable()
    _step_back()
    with open(sys.argv[-1], encoding="utf-8") as file:  # noqa: PTH123
        order = json.load(file)
    sys.path[:] = order["sys_path"]
    messages = _package(order["package"], "worker.messages")
    with open(order["messages"], "ab", buffering=0) as output:  # noqa: PTH123

        def send(message: dict[str, Any]) -> None:
            output.write(messages.encode(message))

        try:
            if order["python"] != sys.implementation.cache_tag:
                raise ImportError(f"{sys.executable} is {sys.implementation.cache_tag}, not {order['python']}")
            run = importlib.import_module("hybrid_quad.worker.run")
            # From here on, as libraries that are being loaded on Windows may wait for what a blocked thread holds.
            threading.Thread(target=_end_with, args=(control, order["folder"]), daemon=True).start()
            run.run(order["folder"], send, stays=order["stays"])
        except BaseException as error:
            send(messages.error_message(error))
    # Straight out: everything is written, and libraries take their time, or crash, as they are unloaded.
    os._exit(0)


def _take_input() -> int:
    """File descriptor of the input, which nothing else can read any more."""
    control = os.dup(0)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    return control


def _step_back() -> None:
    """Lets other programs go first, and survive where memory runs out."""
    with contextlib.suppress(AttributeError, OSError):  # not on Windows, where the parent sets the priority
        os.nice(_NICENESS)
    with contextlib.suppress(OSError), open("/proc/self/oom_score_adj", "w") as file:  # noqa: PTH123
        file.write(_DIES_FIRST)


def _package(folder: str, module: str) -> Any:
    """A module of the package in a folder, whatever the package is called in Blender."""
    spec = importlib.util.spec_from_file_location(
        "hybrid_quad", os.path.join(folder, "__init__.py"), submodule_search_locations=[folder]
    )
    assert spec is not None and spec.loader is not None
    package = importlib.util.module_from_spec(spec)
    sys.modules["hybrid_quad"] = package
    spec.loader.exec_module(package)
    return importlib.import_module(f"hybrid_quad.{module}")


def _end_with(control: int, folder: str) -> None:
    """Waits until nobody holds the other end of the input, and then ends this process and removes its files."""
    while os.read(control, 1024):
        pass
    shutil.rmtree(folder, ignore_errors=True)
    os._exit(1)


main()
