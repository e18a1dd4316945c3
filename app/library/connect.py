"""From an address to a database that is ours and ready.

SQLite is used in write-ahead mode: a save survives the end of the process at any
moment, and costs no wait for the disk. A cut of the power can lose the last few
saves, never an older one.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any, Final

from platformdirs import user_data_path
from sqlalchemy import URL, Connection, Engine, create_engine, event, make_url
from sqlalchemy.exc import ArgumentError, DatabaseError, NoSuchModuleError, SQLAlchemyError
from sqlalchemy.pool import ConnectionPoolEntry, StaticPool

from app.library.errors import ForeignDatabaseError, LibraryError, cause_of
from app.library.upgrade import prepare

VARIABLE: Final = "GC_TEACH_LIBRARY"
LOG_PAGES: Final = 200
"""The write-ahead log is moved into the file when it has so many pages [4 kB]."""
LOCK: Final = 0x6C_74_65_61
"""Number of the lock that libraries in PostgreSQL share."""


def default_url() -> str:
    """Say where skills are saved: ``GC_TEACH_LIBRARY``, else a file in the user's data folder."""
    return os.environ.get(VARIABLE, "") or _own_url()


def told(url: str) -> str:
    """Say where the skills of a library are kept, without its password; raises as `open_engine`."""
    address = _address(url)
    if address.get_backend_name() != "sqlite":
        return f"Skills are kept in {address.render_as_string(hide_password=True)}."
    if _in_memory(address):
        return "Nothing will be kept: this library is in memory only."
    return f"Skills are kept in {_path(address).absolute()}."


def open_engine(url: str) -> Engine:
    """Open a library and create its tables where there are none.

    Raises
    ------
    LibraryError
        If the address cannot be understood or opened, or leads to another
        program's data; that is left as it is.
    """
    address = _address(url)
    where = address.render_as_string(hide_password=True)
    backend = address.get_backend_name()
    if backend not in ("sqlite", "postgresql"):
        raise LibraryError(f"{where}: a library is kept in SQLite or PostgreSQL, not in {backend}.")
    try:
        engine = _sqlite(address, own=url == _own_url()) if backend == "sqlite" else _postgresql(address)
        _prepare(engine, where)
    except (ImportError, NoSuchModuleError) as error:
        raise LibraryError(
            f"{where}: the driver of this database is missing ({error}). "
            "Install it with: pip install 'gc-teach[postgres]'."
        ) from error
    except DatabaseError as error:
        if "not a database" in str(error.orig):
            raise ForeignDatabaseError(where, "is no database") from error
        raise _cannot_open(address, error) from error
    except (SQLAlchemyError, OSError) as error:
        raise _cannot_open(address, error) from error
    return engine


def _own_url() -> str:
    return f"sqlite:///{user_data_path('gc-teach') / 'library.db'}"


def _address(url: str) -> URL:
    """Take a file's path as the address of an SQLite library."""
    try:
        plain = "://" not in url and url.strip() and not re.match(r"\w\w+:", url)
        address = URL.create("sqlite", database=url) if plain else make_url(url)
    except ArgumentError as error:
        raise LibraryError(
            f"{url!r} is no address of a library. Write one like sqlite:///my-skills.db."
        ) from error
    if address.get_backend_name() == "sqlite" and address.host:
        file = f"{address.host}/{address.database}" if address.database else address.host
        raise LibraryError(f"{url!r} names no file. Write three slashes: sqlite:///{file}.")
    return address


def _in_memory(address: URL) -> bool:
    return address.database in (None, "", ":memory:")


def _path(address: URL) -> Path:
    return Path(address.database or "").expanduser()


def _prepare(engine: Engine, where: str) -> None:
    try:
        with engine.begin() as connection:
            prepare(connection, where)
        if engine.dialect.name == "sqlite":
            # Only now: it writes into the file, which may have been somebody else's.
            with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
                connection.exec_driver_sql("PRAGMA journal_mode = WAL")
    except BaseException:
        engine.dispose()
        raise


def _sqlite(address: URL, *, own: bool) -> Engine:
    """Open a file; only the folder of one's ``own`` is made, since another may be a slip of the pen."""
    if _in_memory(address):
        options = {"check_same_thread": False, "isolation_level": None}
        engine = create_engine("sqlite://", poolclass=StaticPool, connect_args=options)
    else:
        path = _path(address)
        if own:
            path.parent.mkdir(parents=True, exist_ok=True)
        elif not path.parent.is_dir():
            raise FileNotFoundError(f"there is no folder {path.parent}")
        engine = create_engine(f"sqlite:///{path}", connect_args={"isolation_level": None, "timeout": 10.0})
    event.listen(engine, "connect", _set_up_connection)
    event.listen(engine, "begin", _begin)
    return engine


def _postgresql(address: URL) -> Engine:
    if address.drivername == "postgresql":
        address = address.set(drivername="postgresql+pg8000")
    engine = create_engine(address)
    event.listen(engine, "begin", _wait_in_turn)
    return engine


def _wait_in_turn(connection: Connection) -> None:
    """One transaction at a time, as in SQLite: whoever drops an array that nobody needs must be alone."""
    connection.exec_driver_sql(f"SELECT pg_advisory_xact_lock({LOCK})")


def _set_up_connection(connection: Any, _entry: ConnectionPoolEntry) -> None:
    connection.execute("PRAGMA foreign_keys = ON")
    connection.execute("PRAGMA synchronous = NORMAL")
    connection.execute(f"PRAGMA wal_autocheckpoint = {LOG_PAGES}")


def _begin(connection: Connection) -> None:
    """Take the write lock at once: a reader that turns writer cannot wait for another."""
    if connection.get_execution_options().get("isolation_level") != "AUTOCOMMIT":
        connection.exec_driver_sql("BEGIN IMMEDIATE")


def _cannot_open(address: URL, error: Exception) -> LibraryError:
    remedy = "Check the address, the password, and whether the server runs"
    if address.get_backend_name() == "sqlite":
        remedy = "Check that its folder is there and who may write in it"
    return LibraryError(
        f"The library {address.render_as_string(hide_password=True)} cannot be opened: {cause_of(error)}. "
        f"{remedy}, or choose another place with --library."
    )
