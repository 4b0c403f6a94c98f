"""What a program takes: time by the clock and of the processor, and memory of its own."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import IO

LAUNCHER = Path(__file__).with_name("launcher.py")


@dataclass
class Measured:
    """What a program took."""

    status: str  # "ok", "failed", "crash" or "timeout"
    message: str
    seconds: float
    cpu_seconds: float
    peak_mb: float


def measure(
    command: list[str],
    seconds: float,
    memory_mb: int,
    cpu_seconds: float | None = None,
    environment: Mapping[str, str] | None = None,
    output: int | IO[str] = subprocess.DEVNULL,
) -> Measured:
    """Runs a program with limits (`memory_mb` 0: none), and takes the system's account of it, without this process's memory.

    Parameters
    ----------
    environment : mapping or None
        Variables of the program, in place of this process's own.
    output : int or file
        Where its standard output goes.
    """
    if environment is not None:
        # Of the program alone: a sanitizer's library would make the launcher large.
        command = ["env", "-i", *(f"{name}={value}" for name, value in environment.items()), *command]
    limits = [str(seconds), str(max(memory_mb, 0)), str(0 if cpu_seconds is None else math.ceil(cpu_seconds))]
    read, write = os.pipe()
    with os.fdopen(read) as account:
        try:
            launcher = subprocess.Popen(
                [sys.executable, "-I", "-S", str(LAUNCHER), str(write), *limits, *command],
                stdout=output,
                stderr=subprocess.PIPE,
                text=True,
                errors="replace",
                pass_fds=[write],
            )
        finally:
            os.close(write)
        message = launcher.communicate()[1].strip()
        words = account.read().split()
    if len(words) != 5:
        raise RuntimeError(f"the launcher ended with {launcher.returncode}: {message}")
    timed_out, code = words[0] == "1", os.waitstatus_to_exitcode(int(words[1]))
    if timed_out:
        status = "timeout"
    elif code == -signal.SIGXCPU:
        status, message = "timeout", f"more than {cpu_seconds:g} s of the processor"
    elif code < 0:
        status, message = "crash", f"signal {-code} {message}"
    else:
        status = "failed" if code else "ok"
    return Measured(status, message[-2000:], float(words[2]), float(words[3]), int(words[4]) / 1024)
