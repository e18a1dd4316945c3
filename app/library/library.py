"""Saved skills, by code. One `Library` serves any number of threads.

Arrays are stored once by their content, so a save after one gesture writes the
array that changed and a small JSON text.
"""

from __future__ import annotations

import json
import re
import time
import weakref
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from threading import Lock
from typing import Any, Final

import numpy as np
from sqlalchemy import Connection, Row, delete, select
from sqlalchemy.exc import SQLAlchemyError

from app.document import Document
from app.library.codec import Array, content_hash, decode_document, encode_document
from app.library.connect import open_engine
from app.library.errors import BadCodeError, LibraryError, UnreadableSkillError
from app.library.tables import arrays, insert_new, skills, upsert, uses

_CODE: Final = re.compile(r"[A-Za-z0-9_-]{1,64}")


@dataclass(frozen=True)
class Summary:
    """A saved skill as a list shows it."""

    code: str
    title: str
    updated: datetime
    """When it was last saved, UTC."""


class ArrayNames:
    """Content hashes of read-only arrays, remembered as long as the arrays live."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[weakref.ref[Array], str]] = {}
        self._lock = Lock()

    def __call__(self, array: Array) -> str:
        """Name an array; one that can still be written to is hashed each time."""
        if array.flags.writeable:
            return content_hash(array)
        key = id(array)
        with self._lock:
            known = self._known.get(key)
            if known is not None and known[0]() is array:
                return known[1]
        name = content_hash(array)
        with self._lock:
            self._known[key] = (weakref.ref(array, lambda gone: self._forget(key, gone)), name)
        return name

    def _forget(self, key: int, gone: weakref.ref[Array]) -> None:
        # No lock: this runs wherever the last reference goes, also inside `__call__`.
        known = self._known.get(key)
        if known is not None and known[0] is gone:
            self._known.pop(key, None)


class Library:
    """Skills in a database; see `app.library.connect` for addresses."""

    def __init__(self, url: str, clock: Callable[[], float] = time.time) -> None:
        """Open the library at an address.

        Raises
        ------
        LibraryError
            If it cannot be opened, or is another program's or version's; it is then left as it is.
        """
        self._engine = open_engine(url)
        self._clock = clock
        self._names = ArrayNames()
        self._lock = Lock()

    def save(self, code: str, document: Document) -> None:
        """Save a skill under its code, in the place of what was saved there before.

        Raises
        ------
        LibraryError
            If the code is none, or the database cannot be written; the former state then stays.
        """
        _check_code(code)
        encoded = encode_document(document, self._names)
        row = {"code": code, "title": document.title, "document": encoded.text, "updated": self._clock()}
        with self._transaction("saved") as connection:
            upsert(connection, skills, row)
            present = _used(connection, code)
            added = encoded.arrays.keys() - present
            stored = set(connection.execute(select(arrays.c.hash).where(arrays.c.hash.in_(added))).scalars())
            insert_new(connection, arrays, [_row(name, encoded.arrays[name]) for name in added - stored])
            insert_new(connection, uses, [{"code": code, "hash": name} for name in added])
            _release(connection, code, present - encoded.arrays.keys())

    def load(self, code: str) -> Document | None:
        """Open a skill; None when there is none with this code.

        Raises
        ------
        LibraryError
            If the database cannot be read, or the skill was saved by a newer version.
        """
        with self._transaction("opened") as connection:
            text = connection.execute(select(skills.c.document).where(skills.c.code == code)).scalar()
            if text is None:
                return None
            needed = select(arrays).join(uses, uses.c.hash == arrays.c.hash).where(uses.c.code == code)
            found = {row.hash: _array(row) for row in connection.execute(needed)}
        return decode_document(text, found)

    def recent(self, limit: int = 20) -> list[Summary]:
        """List skills, the last saved first.

        Raises
        ------
        LibraryError
            If the database cannot be read.
        """
        query = (
            select(skills.c.code, skills.c.title, skills.c.updated)
            .order_by(skills.c.updated.desc(), skills.c.code)
            .limit(limit)
        )
        with self._transaction("read") as connection:
            return [
                Summary(row.code, row.title, datetime.fromtimestamp(row.updated, UTC))
                for row in connection.execute(query)
            ]

    def delete(self, code: str) -> bool:
        """Delete a skill and the arrays that no other skill needs; say whether there was one.

        Raises
        ------
        LibraryError
            If the database cannot be written.
        """
        with self._transaction("deleted") as connection:
            _release(connection, code, _used(connection, code))
            return connection.execute(delete(skills).where(skills.c.code == code)).rowcount > 0

    def close(self) -> None:
        """Close all connections. Everything saved is safe without it."""
        with self._lock:
            self._engine.dispose()

    @contextmanager
    def _transaction(self, done: str) -> Generator[Connection]:
        """One transaction at a time; nothing of it stays when it fails."""
        try:
            with self._lock, self._engine.begin() as connection:
                yield connection
        except SQLAlchemyError as error:
            cause = getattr(error, "orig", None) or error
            raise LibraryError(
                f"The skill could not be {done}: the library says {str(cause)!r}. "
                "Your work is still here; check the disk and try again."
            ) from error


def _check_code(code: str) -> None:
    if not _CODE.fullmatch(code):
        raise BadCodeError(code)


def _used(connection: Connection, code: str) -> set[str]:
    return set(connection.execute(select(uses.c.hash).where(uses.c.code == code)).scalars())


def _release(connection: Connection, code: str, names: set[str]) -> None:
    """Let go of arrays, and delete those that nobody uses any more."""
    if not names:
        return
    connection.execute(delete(uses).where(uses.c.code == code, uses.c.hash.in_(names)))
    in_use = select(uses.c.hash).where(uses.c.hash == arrays.c.hash).exists()
    connection.execute(delete(arrays).where(arrays.c.hash.in_(names), ~in_use))


def _row(name: str, array: Array) -> dict[str, Any]:
    plain = np.ascontiguousarray(array)
    shape = json.dumps(plain.shape)
    return {"hash": name, "dtype": plain.dtype.str, "shape": shape, "bytes": plain.tobytes()}


def _array(row: Row[Any]) -> Array:
    values: Any = row
    try:
        flat: Array = np.frombuffer(values.bytes, dtype=np.dtype(values.dtype))
        return flat.reshape(json.loads(values.shape))
    except (ValueError, TypeError) as error:
        raise UnreadableSkillError(f"the numbers {values.hash[:12]} are damaged") from error
