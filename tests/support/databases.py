"""SQLite files, looked at and changed behind the app's back."""

from __future__ import annotations

import sqlite3
from pathlib import Path


def change(path: Path, *statements: str) -> None:
    """Do something to a file."""
    connection = sqlite3.connect(path)
    for statement in statements:
        connection.execute(statement)
        connection.commit()
    connection.close()


def sound(path: Path) -> bool:
    """Whether SQLite finds nothing wrong with a file, and all that is referred to is there."""
    connection = sqlite3.connect(path)
    checks = [
        connection.execute(f"PRAGMA {name}").fetchall() for name in ("integrity_check", "foreign_key_check")
    ]
    connection.close()
    return checks == [[("ok",)], []]
