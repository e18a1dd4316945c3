"""From whatever is at an address to tables of this version, in the transaction that is open.

Version 1 kept the last document of each skill; version 2 keeps every step and says which is
the present one.
"""

from __future__ import annotations

from typing import Final

from sqlalchemy import Connection, inspect, select

from app.library.errors import ForeignDatabaseError
from app.library.tables import SCHEMA, meta, metadata, steps, uses

FIRST_TABLES: Final = frozenset({"meta", "skills", "arrays", "uses"})
"""What a library of any version has."""
_COLUMNS: Final = (
    "skills ADD COLUMN present BIGINT NOT NULL DEFAULT 0",
    "skills ADD COLUMN deleted FLOAT",
    "skills ADD COLUMN tried TEXT NOT NULL DEFAULT ''",
    "skills ADD COLUMN drawing TEXT",
    "arrays ADD COLUMN packing VARCHAR(16) NOT NULL DEFAULT ''",
)


def prepare(connection: Connection, where: str) -> None:
    """Create the tables in an empty database, bring older ones of ours to this version, accept no others.

    Raises
    ------
    ForeignDatabaseError
        Before anything is written, if the database holds other tables or tables of a newer version.
    """
    present = set(inspect(connection).get_table_names())
    if not present:
        metadata.create_all(connection)
        connection.execute(meta.insert().values(key="schema", value=SCHEMA))
        return
    if not present >= FIRST_TABLES:
        raise ForeignDatabaseError(where, "is a database of another program")
    version = connection.execute(select(meta.c.value).where(meta.c.key == "schema")).scalar()
    if version == "1" and "steps" not in present:
        _from_first(connection)
        connection.execute(meta.update().where(meta.c.key == "schema").values(value=SCHEMA))
    elif version != SCHEMA or not set(metadata.tables) <= present:
        raise ForeignDatabaseError(
            where, f"holds skills in version {version} of the tables, and this program knows version {SCHEMA}"
        )


def _from_first(connection: Connection) -> None:
    """Make each skill's document its only step; the arrays stay where they are."""
    for change in _COLUMNS:
        connection.exec_driver_sql(f"ALTER TABLE {change}")
    connection.exec_driver_sql("UPDATE skills SET present = CAST(updated * 1000000 AS BIGINT)")
    steps.create(connection)
    connection.exec_driver_sql(
        "INSERT INTO steps (code, stamp, name, document) SELECT code, present, '', document FROM skills"
    )
    connection.exec_driver_sql("ALTER TABLE skills DROP COLUMN document")
    # A table cannot be given another primary key in SQLite.
    connection.exec_driver_sql("CREATE TABLE former_uses AS SELECT code, hash FROM uses")
    connection.exec_driver_sql("DROP TABLE uses")
    uses.create(connection)
    connection.exec_driver_sql(
        "INSERT INTO uses (code, stamp, hash) SELECT skills.code, skills.present, former_uses.hash "
        "FROM former_uses JOIN skills ON skills.code = former_uses.code"
    )
    connection.exec_driver_sql("DROP TABLE former_uses")
