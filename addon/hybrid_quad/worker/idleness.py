"""Whether a process hangs: it tells nothing, and uses no time of any processor, where the system says how much that is."""

from __future__ import annotations

import time
from pathlib import Path


class Idleness:
    """How long a process has done nothing.

    Parameters
    ----------
    process_id : int
    """

    def __init__(self, process_id: int) -> None:
        self._stat = Path(f"/proc/{process_id}/stat")
        self._used = ""
        self._since = time.monotonic()

    def reset(self) -> None:
        """The process has told something."""
        self._used, self._since = "", time.monotonic()

    def seconds(self) -> float:
        """Since when it has used no processor; 0 where that is not known. Who waits for a disk uses some."""
        used = self._processor_ticks()
        if not used or used != self._used:
            self._used, self._since = used, time.monotonic()
            return 0.0
        return time.monotonic() - self._since

    def _processor_ticks(self) -> str:
        """In user mode and in the system, of all threads, as Linux writes them; empty elsewhere."""
        try:
            fields = self._stat.read_text().rpartition(")")[2].split()
        except OSError:
            return ""
        return " ".join(fields[11:13])
