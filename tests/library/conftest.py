"""A library in each kind of database."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import create_engine

from app.library import Library
from app.library.tables import metadata
from tests.support import postgres


@pytest.fixture(scope="session")
def postgresql() -> Iterator[str]:
    """Address of a PostgreSQL that runs while the tests do."""
    programs = postgres.programs()
    if programs is None:
        pytest.skip("PostgreSQL is not installed: no initdb was found")
    with postgres.running(programs) as url:
        yield url


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """Of an SQLite library that is not there yet."""
    return tmp_path / "library.db"


@pytest.fixture(params=["sqlite", "postgresql"])
def url(request: pytest.FixtureRequest) -> str:
    """Address of an empty database, one of each kind."""
    if request.param == "sqlite":
        return f"sqlite:///{request.getfixturevalue('path')}"
    url: str = request.getfixturevalue("postgresql")
    engine = create_engine(url)
    metadata.drop_all(engine)
    engine.dispose()
    return url


@pytest.fixture
def library(url: str) -> Iterator[Library]:
    """An empty library whose clock goes on by a second whenever it is read."""
    ticks = iter(range(1, 1_000_000))
    opened = Library(url, clock=lambda: float(next(ticks)))
    yield opened
    opened.close()
