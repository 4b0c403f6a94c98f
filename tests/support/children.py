"""Processes that tests start."""

import signal


def heed_interrupts() -> None:
    """For ``preexec_fn``: a shell that starts the tests in the background has them, and their children, ignore interrupts."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def from_a_shell(command: list[str]) -> list[str]:
    """The command, started by a small process: Linux counts to the peak of a program's memory what its parent took."""
    return ["sh", "-c", '"$@"; exit $?', "sh", *command]
