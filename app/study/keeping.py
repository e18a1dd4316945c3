"""Finished parts on disk: one file each, written so that it is there as a whole or not at all.

A part's file is called by its key, so that nothing is believed that was made of other data, by
another plan or by other versions.
"""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path

from app.study.errors import FolderError
from app.study.experiments import Done, Timing
from app.study.measures import Row
from app.study.parts import Part


@dataclass(frozen=True)
class Shelf:
    """A folder of finished parts."""

    folder: Path

    def path(self, key: str) -> Path:
        """Where the part with a key is kept."""
        return self.folder / f"{key}.json"

    def put(self, key: str, part: Part, done: Done) -> None:
        """Keep a part: written beside, forced to the disk, then renamed.

        Raises
        ------
        FolderError
            If it cannot be written.
        """
        rows = [
            {name: value for name, value in asdict(row).items() if value is not None} for row in done.rows
        ]
        content = {"part": part.name, "rows": rows, "timing": asdict(done.timing)}
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            write_whole(self.path(key), json.dumps(content).encode())
        except OSError as error:
            raise FolderError(str(self.folder), error.strerror or str(error)) from error

    def get(self, key: str) -> Done | None:
        """Give a part that is finished; None when there is none, or its file is damaged."""
        try:
            content = json.loads(self.path(key).read_text(encoding="utf-8"))
            rows = tuple(Row(**row) for row in content["rows"])
            return Done(rows, Timing(**content["timing"]))
        except (OSError, ValueError, KeyError, TypeError):
            return None


def write_whole(path: Path, content: bytes) -> None:
    """Write a file so that whoever looks at it sees the former content or all of the new one.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    beside = path.with_name(path.name + ".part")
    with beside.open("wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    beside.replace(path)
