"""A hook of MkDocs: what pages link to elsewhere in the repository becomes part of the site, and docstrings get links.

In the repository links as ``../CONTRIBUTING.md`` lead to a file. The site has such files below ``project/``: Markdown as pages, all
others as they are; a link to a folder leads to its README. Links to other folders and to hidden files become plain text. A link to
what is not there ends the build.
"""

from __future__ import annotations

import posixpath
import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[2]
OUTSIDE = "project"
ROLE = re.compile(r":(?:func|class|meth|mod):<code>([^<]*)</code>")
LINK = re.compile(r"\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)#\s]+)(#[^)\s]*)?\)")


def on_config(config: Any) -> Any:
    """Fills the sections *Decisions* and *Project* of the navigation."""
    decisions = sorted((ROOT / "docs" / "decisions").glob("*.md"))
    _section(config.nav, "Decisions").extend(f"decisions/{page.name}" for page in decisions)
    _section(config.nav, "Project").extend(sorted(path for path in _outside() if path.endswith(".md")))
    return config


def on_files(files: Files, config: Any) -> Files:
    """Adds the files outside docs/."""
    for path in sorted(_outside()):
        files.append(File.generated(config, path, abs_src_path=str(ROOT / _repository_path(path))))
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Lets links lead to where the site has their files."""
    own = page.file.src_uri

    def moved(link: re.Match[str]) -> str:
        target = _target(own, link[2])
        if target is None:
            return link[0]
        if not _is_shown(target):
            return link[1]
        return f"[{link[1]}]({posixpath.relpath(_site_path(target), posixpath.dirname(own))}{link[3] or ''})"

    return LINK.sub(moved, markdown)


def on_page_content(html: str, **_: Any) -> str:
    """Roles of docstrings, as ``:func:`remesh```, become links to what the page has, else plain code."""

    def shown(role: re.Match[str]) -> str:
        name = role[1].rpartition(".")[2]
        code = f"<code>{name}</code>"
        return f'<a href="#hybrid_quad.{name}">{code}</a>' if f'id="hybrid_quad.{name}"' in html else code

    return ROLE.sub(shown, html)


def _section(nav: list[Any], name: str) -> list[str]:
    """The list of that name in the navigation, which mkdocs.yml leaves empty."""
    for entry in nav:
        for title, content in entry.items() if isinstance(entry, dict) else ():
            if title == name:
                return content
            if isinstance(content, list) and any(name in each for each in content if isinstance(each, dict)):
                return _section(content, name)
    raise KeyError(name)


def _outside() -> set[str]:
    """Places in the site of the files outside docs/ that its pages link to, and those in turn."""
    found: set[str] = set()
    waiting = [_site_path(path.relative_to(ROOT).as_posix()) for path in (ROOT / "docs").rglob("*.md")]
    while waiting:
        page = waiting.pop()
        for link in LINK.finditer((ROOT / _repository_path(page)).read_text()):
            target = _target(page, link[2])
            if target is None or not _is_shown(target) or _site_path(target) in found:
                continue
            if not target.startswith("docs/"):
                found.add(_site_path(target))
                waiting += [_site_path(target)] if target.endswith(".md") else []
    return found


def _is_shown(path: str) -> bool:
    return (ROOT / path).is_file() and not posixpath.basename(path).startswith(".")


def _target(page: str, link: str) -> str | None:
    """The file or folder of the repository that a page of the site links to; none for other links."""
    if "://" in link or link.startswith("mailto:"):
        return None
    path = posixpath.normpath(posixpath.join(posixpath.dirname(_repository_path(page)), link))
    if (ROOT / path).is_dir() and (ROOT / path / "README.md").exists():
        path = f"{path}/README.md"
    return path if (ROOT / path).exists() else None


def _site_path(path: str) -> str:
    return path.removeprefix("docs/") if path.startswith("docs/") else f"{OUTSIDE}/{path}"


def _repository_path(path: str) -> str:
    return path.removeprefix(f"{OUTSIDE}/") if path.startswith(f"{OUTSIDE}/") else f"docs/{path}"
