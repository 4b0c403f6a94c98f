"""Small PNG files of pixels: by zlib, as neither a bare Python nor Blender's has Pillow.

After the W3C's "Portable Network Graphics (PNG) Specification". Colours are taken from a palette, the most frequent ones of the
picture, which makes a third of the bytes.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Pixels = npt.NDArray[np.uint8]

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_BITS = 5  # of each channel: colours alike in these are one


def png_of(pixels: Pixels, colours: int = 64, kept: Sequence[tuple[int, int, int]] = ()) -> bytes:
    """A PNG file.

    Parameters
    ----------
    pixels : (height, width, 3) uint8
        Red, green and blue, from the top.
    colours : int
        The most that the file has, up to 256.
    kept : sequence of (red, green, blue)
        Colours that it has for certain.
    """
    height, width = pixels.shape[:2]
    palette, places = _with_palette(pixels.reshape(-1, 3), colours, kept)
    rows = np.zeros((height, width + 1), np.uint8)  # each begins with how it is filtered: not at all
    rows[:, 1:] = places.reshape(height, width)
    header = struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)
    chunks = (
        (b"IHDR", header),
        (b"PLTE", palette.tobytes()),
        (b"IDAT", zlib.compress(rows.tobytes(), 9)),
        (b"IEND", b""),
    )
    return _SIGNATURE + b"".join(_chunk(kind, data) for kind, data in chunks)


def _with_palette(pixels: Pixels, colours: int, kept: Sequence[tuple[int, int, int]]) -> tuple[Pixels, Pixels]:
    """(k, 3) colours, and which of them is nearest to each pixel (n,)."""
    coarse = (pixels >> (8 - _BITS)).astype(np.int64) @ np.array([1 << 2 * _BITS, 1 << _BITS, 1])
    _, kind_of, times = np.unique(coarse, return_inverse=True, return_counts=True)
    kind_of = kind_of.reshape(-1)
    sums = np.stack([np.bincount(kind_of, pixels[:, channel]) for channel in range(3)], axis=1)
    means = sums / times[:, None]
    frequent = np.argsort(-times, kind="stable")[: colours - len(kept)]
    palette = np.concatenate([np.array(kept, float).reshape(-1, 3), np.rint(means[frequent])])
    nearest = np.linalg.norm(means[:, None] - palette[None], axis=2).argmin(axis=1).astype(np.uint8)
    return palette.astype(np.uint8), nearest[kind_of]


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
