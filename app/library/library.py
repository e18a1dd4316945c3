"""Saved skills, by code. One `Library` serves any number of threads.

A skill is saved with its history: one step an edit. Arrays are stored once by their
content, so a save after one gesture writes one small JSON text and the array that
changed. What is deleted stays for a month.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Collection, Generator, Iterable
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from threading import Lock
from typing import Any, Final

from sqlalchemy import Connection, delete, select, update
from sqlalchemy.exc import SQLAlchemyError

from app.document import Document
from app.history import History, Version, begin
from app.library.codec import Array, Known, decode_document, encode_document
from app.library.connect import open_engine
from app.library.errors import BadCodeError, LibraryError, UnreadableSkillError, cause_of
from app.library.packing import ArrayNames, Packed, row_of
from app.library.tables import arrays, insert_new, skills, steps, untouched, upsert, uses

KEPT_DELETED: Final = 30 * 24 * 3600.0
"""So long a deleted skill can be brought back [s]."""
_CODE: Final = re.compile(r"[A-Za-z0-9_-]{1,64}")
_LISTED: Final = (skills.c.code, skills.c.title, skills.c.updated, skills.c.deleted)


@dataclass(frozen=True)
class Summary:
    """A saved skill as a list shows it."""

    code: str
    title: str
    updated: datetime
    """When it was last saved, UTC."""
    deleted: datetime | None = None
    """When it was deleted, UTC; None: it was not."""


@dataclass(frozen=True, eq=False)
class Kept:
    """All that is saved of a skill."""

    history: History
    tried: frozenset[str]
    """Of the lesson, what was tried."""
    deleted: bool
    """Whether it is among the recently deleted."""


class Library:
    """Skills in a database; see `app.library.connect` for addresses."""

    def __init__(self, url: str, clock: Callable[[], float] = time.time) -> None:
        """Open the library at an address, and forget what was deleted long ago.

        Raises
        ------
        LibraryError
            If it cannot be opened, or is another program's or version's; it is then left as it is.
        """
        self._engine = open_engine(url)
        self._clock = clock
        self._names = ArrayNames()
        self._lock = Lock()
        self._forget_old()

    def save(self, code: str, document: Document) -> None:
        """Save a skill without a history, in the place of what was saved under its code before.

        Raises
        ------
        LibraryError
            As `keep`.
        """
        self.keep(code, begin(document, self._clock()))

    def keep(
        self, code: str, history: History, *, tried: Iterable[str] = (), drawing: str | None = None
    ) -> None:
        """Save a skill with its history; only what is new is written. A deleted one is back.

        Parameters
        ----------
        code : str
        history : History
        tried : iterable of str
            Of the lesson, what was tried.
        drawing : str, optional
            An ``<svg>`` element for the list; None: one is made when it is listed.

        Raises
        ------
        LibraryError
            If the code is none, or the database cannot be written; the former state then stays.
        """
        _check_code(code)
        present = history.present
        row = {
            "code": code,
            "title": present.document.title,
            "updated": self._clock(),
            "present": present.stamp,
            "deleted": None,
            "tried": " ".join(sorted(tried)),
            "drawing": drawing,
        }
        with self._transaction("saved") as connection:
            upsert(connection, skills, row)
            stored = set(connection.execute(select(steps.c.stamp).where(steps.c.code == code)).scalars())
            wanted = {version.stamp for version in history.versions}
            self._add(connection, code, [v for v in history.versions if v.stamp not in stored])
            _remove(connection, code, stored - wanted)

    def load(self, code: str) -> Document | None:
        """Open a skill as it was last saved; None when there is none with this code.

        Raises
        ------
        LibraryError
            If the database cannot be read, or the skill was saved by a newer version.
        """
        with self._transaction("opened") as connection:
            query = (
                select(steps.c.document, steps.c.stamp)
                .join(skills, skills.c.code == steps.c.code)
                .where(skills.c.code == code, skills.c.present == steps.c.stamp)
            )
            found = connection.execute(query).one_or_none()
            if found is None:
                return None
            numbers = _arrays_of(connection, uses.c.code == code, uses.c.stamp == found.stamp)
        return decode_document(found.document, numbers)

    def open(self, code: str) -> Kept | None:
        """Open a skill with its history; None when there is none with this code.

        Raises
        ------
        LibraryError
            As `load`.
        """
        with self._transaction("opened") as connection:
            skill = connection.execute(select(skills).where(skills.c.code == code)).one_or_none()
            if skill is None:
                return None
            rows = connection.execute(select(steps).where(steps.c.code == code).order_by(steps.c.stamp)).all()
            numbers = _arrays_of(connection, uses.c.code == code)
        known: Known = {}
        versions = tuple(
            Version(row.stamp, row.name, partial(decode_document, row.document, numbers, known))
            for row in rows
        )
        place = next((i for i, row in enumerate(rows) if row.stamp == skill.present), None)
        if place is None:
            raise UnreadableSkillError("its present version is missing")
        _ = versions[place].document  # now, so that whoever opens it is told; the others when asked for
        return Kept(History(versions, place), frozenset(skill.tried.split()), skill.deleted is not None)

    def recent(self, limit: int = 20, among: Collection[str] | None = None) -> list[Summary]:
        """List skills, the last saved first, but for those that were only begun.

        Parameters
        ----------
        limit : int
            Most that are listed.
        among : collection of str, optional
            Codes of those that may be; None: all.

        Raises
        ------
        LibraryError
            If the database cannot be read.
        """
        query = select(*_LISTED).where(skills.c.deleted.is_(None), ~untouched)
        return self._list(query.order_by(skills.c.updated.desc()), limit, among)

    def deleted(self, limit: int = 20, among: Collection[str] | None = None) -> list[Summary]:
        """List the skills that can be brought back, the last deleted first; otherwise as `recent`."""
        query = select(*_LISTED).where(skills.c.deleted.is_not(None)).order_by(skills.c.deleted.desc())
        return self._list(query, limit, among)

    def delete(self, code: str) -> bool:
        """Put a skill among the recently deleted; say whether there was one that was not.

        Raises
        ------
        LibraryError
            If the database cannot be written.
        """
        return self._mark(code, self._clock(), skills.c.deleted.is_(None))

    def restore(self, code: str) -> bool:
        """Bring a deleted skill back; say whether there was one. Raises as `delete`."""
        return self._mark(code, None, skills.c.deleted.is_not(None))

    def forget(self, code: str) -> bool:
        """Delete a skill for good, with its history; say whether there was one. Raises as `delete`."""
        with self._transaction("deleted") as connection:
            return _forget(connection, code)

    def drawings(self, codes: Iterable[str]) -> dict[str, str]:
        """Give the drawings of those skills that have one, by code; raises as `recent`."""
        query = select(skills.c.code, skills.c.drawing).where(
            skills.c.code.in_(list(codes)), skills.c.drawing.is_not(None)
        )
        with self._transaction("read") as connection:
            return {row.code: row.drawing for row in connection.execute(query)}

    def draw(self, code: str, drawing: str) -> None:
        """Keep the drawing of a skill that had none; raises as `delete`."""
        change = update(skills).where(skills.c.code == code, skills.c.drawing.is_(None))
        with self._transaction("drawn") as connection:
            connection.execute(change.values(drawing=drawing))

    def close(self) -> None:
        """Close all connections. Everything saved is safe without it."""
        with self._lock:
            self._engine.dispose()

    def _add(self, connection: Connection, code: str, versions: list[Version]) -> None:
        """Write versions, and those of their arrays that no skill has yet."""
        encoded = [(version, encode_document(version.document, self._names)) for version in versions]
        numbers: dict[str, Array] = {name: a for _, parts in encoded for name, a in parts.arrays.items()}
        names = select(arrays.c.hash).where(arrays.c.hash.in_(numbers))
        missing = numbers.keys() - set(connection.execute(names).scalars())
        insert_new(connection, arrays, [row_of(name, numbers[name]) for name in sorted(missing)])
        texts = [
            {"code": code, "stamp": version.stamp, "name": version.name, "document": parts.text}
            for version, parts in encoded
        ]
        needs = [
            {"code": code, "stamp": version.stamp, "hash": name}
            for version, parts in encoded
            for name in parts.arrays
        ]
        insert_new(connection, steps, texts)
        insert_new(connection, uses, needs)

    def _list(self, query: Any, limit: int, among: Collection[str] | None) -> list[Summary]:
        query = query.order_by(skills.c.code).limit(limit)
        if among is not None:
            query = query.where(skills.c.code.in_(list(among)))
        with self._transaction("read") as connection:
            rows = connection.execute(query).all()
        return [
            Summary(
                row.code, row.title, _time(row.updated), None if row.deleted is None else _time(row.deleted)
            )
            for row in rows
        ]

    def _mark(self, code: str, deleted: float | None, which: Any) -> bool:
        change = update(skills).where(skills.c.code == code, which).values(deleted=deleted)
        with self._transaction("deleted" if deleted else "brought back") as connection:
            return connection.execute(change).rowcount > 0

    def _forget_old(self) -> None:
        old = select(skills.c.code).where(skills.c.deleted < self._clock() - KEPT_DELETED)
        with self._transaction("deleted") as connection:
            for code in connection.execute(old).scalars().all():
                _forget(connection, code)

    @contextmanager
    def _transaction(self, done: str) -> Generator[Connection]:
        """One transaction at a time; nothing of it stays when it fails."""
        try:
            with self._lock, self._engine.begin() as connection:
                yield connection
        except SQLAlchemyError as error:
            raise LibraryError(
                f"The skill could not be {done}: the library says {cause_of(error)!r}. "
                "Your work is still here; check the disk and try again."
            ) from error


def _check_code(code: str) -> None:
    if not _CODE.fullmatch(code):
        raise BadCodeError(code)


def _time(seconds: float) -> datetime:
    return datetime.fromtimestamp(seconds, UTC)


def _arrays_of(connection: Connection, *which: Any) -> Packed:
    names = select(uses.c.hash).where(*which)
    rows = connection.execute(select(arrays).where(arrays.c.hash.in_(names)))
    return Packed({row.hash: row for row in rows})


def _remove(connection: Connection, code: str, stamps: set[int]) -> None:
    """Remove steps, and the arrays that nobody needs any more."""
    if not stamps:
        return
    mine = (uses.c.code == code, uses.c.stamp.in_(stamps))
    names = connection.execute(select(uses.c.hash).distinct().where(*mine)).scalars().all()
    connection.execute(delete(uses).where(*mine))
    connection.execute(delete(steps).where(steps.c.code == code, steps.c.stamp.in_(stamps)))
    needed = select(uses.c.hash).where(uses.c.hash == arrays.c.hash).exists()
    connection.execute(delete(arrays).where(arrays.c.hash.in_(names), ~needed))


def _forget(connection: Connection, code: str) -> bool:
    stamps = set(connection.execute(select(steps.c.stamp).where(steps.c.code == code)).scalars())
    _remove(connection, code, stamps)
    return connection.execute(delete(skills).where(skills.c.code == code)).rowcount > 0
