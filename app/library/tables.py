"""The tables of a library, and the two statements that differ between databases.

``meta`` holds the version of these tables. A skill is a list of versions, ``steps``: each
is small JSON whose arrays lie in ``arrays`` under their content hash, once for all skills,
and ``uses`` says which step needs which. `app.library.upgrade` brings older tables here.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from sqlalchemy import (
    BigInteger,
    Column,
    Connection,
    Float,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
    select,
)
from sqlalchemy.dialects import postgresql, sqlite

from app.history import BEGIN

SCHEMA: Final = "2"
"""Version of these tables."""

metadata = MetaData()
meta = Table(
    "meta",
    metadata,
    Column("key", String(32), primary_key=True),
    Column("value", Text, nullable=False),
)
skills = Table(
    "skills",
    metadata,
    Column("code", String(64), primary_key=True),
    Column("title", Text, nullable=False),
    Column("updated", Float, nullable=False, index=True),  # [s] since 1970, UTC
    Column("present", BigInteger, nullable=False),  # stamp of the step that is worked on
    Column("deleted", Float),  # [s] since 1970, UTC; null: it is not
    Column("tried", Text, nullable=False, server_default=""),  # of the lesson; words with spaces between
    Column("drawing", Text),  # <svg> of the tube; null: not drawn yet
)
steps = Table(
    "steps",
    metadata,
    Column("code", String(64), ForeignKey("skills.code", ondelete="CASCADE"), primary_key=True),
    Column("stamp", BigInteger, primary_key=True, autoincrement=False),  # [us] since 1970, UTC
    Column("name", Text, nullable=False),
    Column("document", Text, nullable=False),
)
arrays = Table(
    "arrays",
    metadata,
    Column("hash", String(64), primary_key=True),
    Column("dtype", String(16), nullable=False),
    Column("shape", String(128), nullable=False),  # JSON list
    Column("bytes", LargeBinary, nullable=False),
    Column("packing", String(16), nullable=False, server_default=""),  # see app.library.packing
)
uses = Table(
    "uses",
    metadata,
    Column("code", String(64), primary_key=True),
    Column("stamp", BigInteger, primary_key=True, autoincrement=False),
    Column("hash", String(64), ForeignKey("arrays.hash"), primary_key=True),
    ForeignKeyConstraint(["code", "stamp"], ["steps.code", "steps.stamp"], ondelete="CASCADE"),
    Index("uses_hash", "hash"),
)

untouched = (
    select(steps.c.code)
    .where(steps.c.code == skills.c.code, steps.c.stamp == skills.c.present, steps.c.name.startswith(BEGIN))
    .exists()
)
"""Of a skill: it was begun, and nothing was done since."""


def insert_new(connection: Connection, table: Table, rows: Sequence[dict[str, Any]]) -> None:
    """Insert rows; those whose key exists already are left as they are."""
    if rows:
        statement = _insert(connection, table).on_conflict_do_nothing()
        connection.execute(statement, rows)


def upsert(connection: Connection, table: Table, row: dict[str, Any]) -> None:
    """Insert a row or, where its key exists, replace its values."""
    statement = _insert(connection, table).values(row)
    keys = [column.name for column in table.primary_key]
    changed = {name: statement.excluded[name] for name in row if name not in keys}
    connection.execute(statement.on_conflict_do_update(index_elements=keys, set_=changed))


def _insert(connection: Connection, table: Table) -> Any:
    return postgresql.insert(table) if connection.dialect.name == "postgresql" else sqlite.insert(table)
