"""What is at an address: ours of this version, ours of an older one, or not ours and left alone."""

import shutil
import sqlite3
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from sqlalchemy import create_engine

from app.document import Document
from app.library import (
    FORMAT,
    ForeignDatabaseError,
    Library,
    LibraryError,
    UnreadableSkillError,
    decode_document,
    default_url,
    told,
)
from app.library.tables import SCHEMA, metadata
from gc_core import same_content
from tests.library.makers import document
from tests.library.test_library import start
from tests.support.databases import change, sound

FIXTURES = Path(__file__).parent / "fixtures"


@pytest.fixture
def older(tmp_path: Path) -> Path:
    """A copy of a library that version 1 saved."""
    return Path(shutil.copy(FIXTURES / "library-1.db", tmp_path))


@pytest.fixture
def saved() -> Document:
    """The document that all fixtures hold, by the fixture that is no database."""
    numbers = dict(np.load(FIXTURES / "document-1.npz"))
    return decode_document((FIXTURES / "document-1.json").read_text(encoding="utf-8"), numbers)


def test_a_document_of_an_older_version_is_read(saved: Document) -> None:
    assert saved.title == "Über the top"
    assert [len(shown.demonstration.times) for shown in saved.demonstrations] == [30, 30]
    assert saved.demonstrations[0].demonstration.name == "Demonstration 0 à gauche"


def test_a_library_of_this_version_is_read_by_every_later_one(tmp_path: Path, saved: Document) -> None:
    library = Library(f"sqlite:///{shutil.copy(FIXTURES / 'library-2.db', tmp_path)}", clock=lambda: 1.7e9)
    kept = library.open("rich-skill")

    assert kept is not None
    assert [version.name for version in kept.history.versions] == [
        "",
        "delete a demonstration",
        "add a start",
    ]
    assert (kept.history.place, kept.tried) == (1, {"goal", "undo"})
    assert same_content(kept.history.back().present.document, saved)
    assert len(kept.history.forth().present.document.starts) == 3
    assert [summary.title for summary in library.deleted()] == ["Gone"]
    library.close()


def test_the_versions_that_are_written_now_have_their_fixtures() -> None:
    assert {p.name for p in FIXTURES.iterdir()} >= {f"library-{SCHEMA}.db", f"document-{FORMAT}.json"}
    assert sum(p.stat().st_size for p in FIXTURES.iterdir() if p.is_file()) < 200_000


def check_upgraded(library: Library, saved: Document) -> None:
    kept = library.open("rich-skill")
    assert kept is not None
    assert same_content(kept.history.present.document, saved)
    assert (kept.history.undo_name, kept.history.redo_name) == (None, None)
    assert same_content(library.load("empty-skill"), Document("Nothing yet"))
    assert {summary.code for summary in library.recent()} == {"rich-skill", "empty-skill", "half-skill"}
    library.keep("rich-skill", kept.history.after(Document("Emptied"), "empty it", 2e9))
    library.forget("rich-skill")
    half = library.load("half-skill")
    assert half is not None
    assert len(half.demonstrations) == 1


def test_a_library_of_version_1_is_brought_to_this_one(older: Path, saved: Document) -> None:
    library = Library(f"sqlite:///{older}")
    check_upgraded(library, saved)
    library.close()

    assert sound(older)
    again = Library(f"sqlite:///{older}")
    assert again.load("rich-skill") is None
    again.close()


def test_an_upgraded_library_has_the_tables_of_a_new_one(older: Path, path: Path) -> None:
    for file in (older, path):
        Library(f"sqlite:///{file}").close()

    assert columns(older) == columns(path)


def test_an_upgrade_that_fails_leaves_the_library_as_it_was(older: Path) -> None:
    change(older, "CREATE TABLE former_uses (is_in_the_way TEXT)")
    before = older.read_bytes()

    with pytest.raises(LibraryError, match="cannot be opened"):
        Library(f"sqlite:///{older}")

    assert older.read_bytes() == before


@pytest.fixture
def old_postgresql(postgresql: str) -> Iterator[str]:
    """A PostgreSQL with the tables and rows of version 1."""
    engine = create_engine(postgresql)
    metadata.drop_all(engine)
    source = sqlite3.connect(FIXTURES / "library-1.db")
    with engine.begin() as connection:
        for name in ("meta", "skills", "arrays", "uses"):
            ((text,),) = source.execute("SELECT sql FROM sqlite_master WHERE name = ?", (name,))
            connection.exec_driver_sql(text.replace("BLOB", "BYTEA"))
            cursor = source.execute(f"SELECT * FROM {name}")
            marks = ", ".join("%s" for _ in cursor.description)
            for row in cursor:
                connection.exec_driver_sql(f"INSERT INTO {name} VALUES ({marks})", tuple(row))
        connection.exec_driver_sql("CREATE INDEX uses_hash ON uses (hash)")
    source.close()
    yield postgresql
    metadata.drop_all(engine)
    engine.dispose()


def test_version_1_in_postgresql_is_brought_to_this_one_too(old_postgresql: str, saved: Document) -> None:
    library = Library(old_postgresql)
    check_upgraded(library, saved)
    library.close()


def test_an_address_of_postgresql_without_a_driver_means_the_one_that_is_installed(postgresql: str) -> None:
    library = Library(postgresql.replace("+pg8000", ""))
    library.save("abc", document())

    assert same_content(library.load("abc"), document())
    library.close()


def test_a_postgresql_that_is_not_there_is_a_sentence() -> None:
    said = r"teacher:\*\*\*@127.0.0.1:1/skills cannot be opened: Connection refused. Check the address[^\n]*$"
    with pytest.raises(LibraryError, match=said):
        Library("postgresql+pg8000://teacher:secret@127.0.0.1:1/skills")


def columns(path: Path) -> dict[str, list[str]]:
    """The columns of all tables, by table."""
    connection = sqlite3.connect(path)
    names = [name for (name,) in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
    found = {
        name: sorted(row[1] for row in connection.execute(f"PRAGMA table_info({name})")) for name in names
    }
    connection.close()
    return found


def test_a_save_survives_the_sudden_end_of_the_process(path: Path) -> None:
    script = """
        import os, sys
        from app.library import Library
        from tests.library.makers import document
        library = Library(sys.argv[1])
        for step in range(5):
            library.save("abc", document(n=20 + step))
        os._exit(9)
    """
    assert start(script, f"sqlite:///{path}").wait(30) == 9

    survivor = Library(f"sqlite:///{path}")
    assert same_content(survivor.load("abc"), document(n=24))
    survivor.close()
    assert sound(path)


def test_a_database_of_another_version_is_refused_and_unharmed(path: Path) -> None:
    library = Library(f"sqlite:///{path}")
    library.save("abc", document())
    library.close()
    change(path, "UPDATE meta SET value = '999' WHERE key = 'schema'", "PRAGMA journal_mode = DELETE")
    before = path.read_bytes()

    with pytest.raises(ForeignDatabaseError, match="version 999"):
        Library(f"sqlite:///{path}")

    assert path.read_bytes() == before


def test_a_database_of_another_program_is_refused_and_unharmed(tmp_path: Path) -> None:
    path = tmp_path / "other.db"
    change(path, "CREATE TABLE skills (name TEXT)")
    before = path.read_bytes()

    with pytest.raises(ForeignDatabaseError, match="another program"):
        Library(f"sqlite:///{path}")

    assert path.read_bytes() == before


def test_a_file_that_is_no_database_is_refused_and_unharmed(tmp_path: Path) -> None:
    path = tmp_path / "letter.txt"
    path.write_text("Dear library, " * 100)
    before = path.read_bytes()

    with pytest.raises(ForeignDatabaseError, match="no database"):
        Library(f"sqlite:///{path}")

    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("sqlite:my-skills.db", "no address"),
        ("sqlite://my-skills.db", "sqlite:///my-skills.db"),
        ("mysql://localhost/skills", "not in mysql"),
        ("sqlite:////proc/nowhere/library.db", "there is no folder /proc/nowhere"),
        ("/proc/nowhere/library.db", "there is no folder /proc/nowhere"),
    ],
)
def test_an_address_that_leads_nowhere_is_refused_with_a_sentence(url: str, words: str) -> None:
    with pytest.raises(LibraryError, match=words):
        Library(url)


def test_a_plain_path_is_a_file_and_it_is_told_where_skills_are_kept(path: Path) -> None:
    Library(str(path)).close()

    assert path.exists()
    assert told(str(path)) == f"Skills are kept in {path}."
    assert "secret" not in told("postgresql://teacher:secret@127.0.0.1:1/skills")
    assert told("sqlite://").startswith("Nothing will be kept")


def test_the_folder_of_the_default_is_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("GC_TEACH_LIBRARY", raising=False)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "made"))

    Library(default_url()).close()

    assert list(tmp_path.rglob("library.db"))


def test_the_default_is_a_file_of_the_user_unless_the_environment_names_another(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("GC_TEACH_LIBRARY", raising=False)
    assert default_url().startswith("sqlite:///")
    assert "gc-teach" in default_url()

    monkeypatch.setenv("GC_TEACH_LIBRARY", "sqlite:///elsewhere.db")
    assert default_url() == "sqlite:///elsewhere.db"


def test_a_skill_whose_present_version_is_missing_is_a_sentence(path: Path) -> None:
    library = Library(f"sqlite:///{path}")
    library.save("abc", document())
    change(path, "UPDATE skills SET present = 1")

    with pytest.raises(UnreadableSkillError, match="present version is missing"):
        library.open("abc")
    library.close()
