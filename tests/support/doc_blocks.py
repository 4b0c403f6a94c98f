"""The fenced blocks of code in the documentation."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

NOT_RUN = re.compile(r"<!-- not run: (.+) -->")


@dataclass(frozen=True)
class Block:
    """A block of code of a page.

    Attributes
    ----------
    page : str
        Path in the repository.
    line : int
        Of its first line of code, from 1.
    language : str
        As it stands behind the fence; may be empty.
    text : str
    not_run : str or None
        Why it is not run, where a comment ``<!-- not run: REASON -->`` stands in the line above.
    """

    page: str
    line: int
    language: str
    text: str
    not_run: str | None

    @property
    def place(self) -> str:
        return f"{self.page}:{self.line}"

    @property
    def knows_blender(self) -> bool:
        """Whether it is Python for inside Blender."""
        return self.language == "python" and re.search(r"\bbpy\b", self.text) is not None

    def commands(self) -> list[list[str]]:
        """The words of every command of a block of shell; lines that go on are joined, comments left out."""
        lines = self.text.replace("\\\n", " ").splitlines()
        return [words for words in (shlex.split(line, comments=True) for line in lines) if words]


def pages_of(root: Path) -> list[str]:
    """README.md and the pages of docs/, as paths in the repository."""
    return ["README.md", *sorted(f"docs/{page.name}" for page in (root / "docs").glob("*.md"))]


def blocks_of(root: Path, page: str) -> list[Block]:
    """The page's blocks in their order."""
    lines = (root / page).read_text().splitlines()
    blocks: list[Block] = []
    start = 0
    while start < len(lines):
        fence = re.fullmatch(r"```(\w*)", lines[start])
        if fence is None:
            start += 1
            continue
        end = lines.index("```", start + 1)
        comment = NOT_RUN.fullmatch(lines[start - 1]) if start else None
        text = "\n".join(lines[start + 1 : end]) + "\n"
        blocks.append(Block(page, start + 2, fence[1], text, comment[1] if comment else None))
        start = end + 1
    return blocks
