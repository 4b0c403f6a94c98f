"""Runs a program with limits from a process of little memory, and writes what the system says that the program took.

    launcher.py FD SECONDS MEMORY_MB CPU_SECONDS PROGRAM [ARGUMENT...]

Linux counts to a program's peak of memory what the process was that it was forked from, past the exec too: started
from a harness that holds a gigabyte, everything has had a gigabyte. So nothing is imported here that is not needed;
what this process takes itself (about 10 MB) is the least that is ever told. It writes to the file descriptor whether
the time was over (0 or 1), the program's wait status, seconds by the clock and of the processor, and the peak in kB.
"""

from __future__ import annotations

import os
import resource
import signal
import sys
import time


def main() -> None:
    """Starts the program, ends it when its time is over, and tells what it took."""
    told, memory_mb, cpu_seconds = int(sys.argv[1]), int(sys.argv[3]), int(sys.argv[4])
    begin = time.monotonic()
    program = os.fork()
    if not program:
        os.close(told)
        start(sys.argv[5:], memory_mb, cpu_seconds)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the program hears it too, and what it does then is told
    timed_out = False

    def end(*_: object) -> None:
        nonlocal timed_out
        timed_out = True
        os.kill(program, signal.SIGKILL)

    signal.signal(signal.SIGALRM, end)
    signal.setitimer(signal.ITIMER_REAL, float(sys.argv[2]))
    _, status, usage = os.wait4(program, 0)
    signal.setitimer(signal.ITIMER_REAL, 0)
    seconds = time.monotonic() - begin
    cpu = usage.ru_utime + usage.ru_stime
    os.write(told, f"{timed_out:d} {status} {seconds} {cpu} {usage.ru_maxrss}".encode())


def start(command: list[str], memory_mb: int, cpu_seconds: int) -> None:
    """Becomes the program; limits of 0 are none."""
    try:
        if memory_mb:
            resource.setrlimit(resource.RLIMIT_AS, (memory_mb << 20, memory_mb << 20))
        if cpu_seconds:
            resource.setrlimit(resource.RLIMIT_CPU, (cpu_seconds, cpu_seconds + 5))
        os.execvp(command[0], command)
    except OSError as error:
        os.write(2, f"{command[0]}: {error}\n".encode())
    finally:
        os._exit(127)


if __name__ == "__main__":
    main()
