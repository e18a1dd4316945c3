"""The tables of a library, and the two statements that differ between databases.

``meta`` holds the version of these tables. A skill's document is small JSON; its
arrays lie in ``arrays`` under their content hash, once for all skills, and
``uses`` says which skill needs which.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from sqlalchemy import (
    Column,
    Connection,
    Float,
    ForeignKey,
    Index,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
    inspect,
    select,
)
from sqlalchemy.dialects import postgresql, sqlite

from app.library.errors import ForeignDatabaseError

SCHEMA: Final = "1"
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
    Column("document", Text, nullable=False),
    Column("updated", Float, nullable=False, index=True),  # [s] since 1970, UTC
)
arrays = Table(
    "arrays",
    metadata,
    Column("hash", String(64), primary_key=True),
    Column("dtype", String(16), nullable=False),
    Column("shape", String(128), nullable=False),  # JSON list
    Column("bytes", LargeBinary, nullable=False),
)
uses = Table(
    "uses",
    metadata,
    Column("code", String(64), ForeignKey("skills.code", ondelete="CASCADE"), primary_key=True),
    Column("hash", String(64), ForeignKey("arrays.hash"), primary_key=True),
    Index("uses_hash", "hash"),
)


def prepare(connection: Connection, where: str) -> None:
    """Create the tables in an empty database; accept none but our own in another.

    Raises
    ------
    ForeignDatabaseError
        Before anything is written, if the database holds other tables or tables of another version.
    """
    present = set(inspect(connection).get_table_names())
    if not present:
        metadata.create_all(connection)
        connection.execute(meta.insert().values(key="schema", value=SCHEMA))
        return
    if "meta" not in present or not set(metadata.tables) <= present:
        raise ForeignDatabaseError(where, "is a database of another program")
    version = connection.execute(select(meta.c.value).where(meta.c.key == "schema")).scalar()
    if version != SCHEMA:
        raise ForeignDatabaseError(
            where, f"holds skills in version {version} of the tables, and this program knows version {SCHEMA}"
        )


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
