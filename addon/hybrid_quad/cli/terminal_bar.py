"""A bar that shows how far something is, where there is a terminal to show it in."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tqdm import tqdm


def terminal_bar(**options: Any) -> tqdm[None] | None:
    """tqdm's bar on the error stream, by tqdm's options; None where that is no terminal, or in Blender, which has no tqdm."""
    if sys.stderr is None or not sys.stderr.isatty():
        return None
    try:
        from tqdm import tqdm  # takes longer to load than all else here
    except ImportError:
        return None
    return tqdm(file=sys.stderr, **options)
