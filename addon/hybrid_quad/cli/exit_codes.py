"""What the command's exit status says; scripts rely on the numbers."""

OK = 0
CANNOT_REMESH = 1  # the input is at fault
WRONG_USAGE = 2  # or a file that cannot be read or written
BUG = 3
CANCELLED = 4  # or a limit of time or memory is reached
