"""Where a measured page goes."""

from __future__ import annotations

from pathlib import Path


def put(page: str, out: Path | None) -> None:
    """Write a page of Markdown to a file, or to the screen when there is none."""
    if out is None:
        print(page)
    else:
        out.write_text(page, encoding="utf-8")
