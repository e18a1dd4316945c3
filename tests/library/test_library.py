"""Skills in a real SQLite file: kept, shared between threads, never half written."""

import os
import sqlite3
import subprocess
import sys
import textwrap
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.document import Document, Shown
from app.edits import add_start, mute_demonstration
from app.library import (
    ArrayNames,
    BadCodeError,
    ForeignDatabaseError,
    Library,
    LibraryError,
    UnreadableSkillError,
    default_url,
)
from gc_core import same_content
from tests.library.makers import demonstration, document

ROOT = Path(__file__).parents[2]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "data" / "library.db"


@pytest.fixture
def library(path: Path) -> Iterator[Library]:
    ticks = iter(range(1_000_000))
    opened = Library(f"sqlite:///{path}", clock=lambda: float(next(ticks)))
    yield opened
    opened.close()


def ask(path: Path, query: str) -> list[tuple[object, ...]]:
    connection = sqlite3.connect(path)
    try:
        return connection.execute(query).fetchall()
    finally:
        connection.close()


def count(path: Path, table: str) -> int:
    ((number,),) = ask(path, f"SELECT count(*) FROM {table}")
    assert isinstance(number, int)
    return number


def test_a_saved_skill_is_loaded_with_every_field(library: Library) -> None:
    library.save("abc", document())

    assert same_content(library.load("abc"), document())


def test_what_was_never_saved_is_none(library: Library) -> None:
    assert library.load("abc") is None


def test_saving_again_replaces(library: Library, path: Path) -> None:
    library.save("abc", document())
    changed = mute_demonstration(document(), 0, False)
    library.save("abc", changed)

    assert same_content(library.load("abc"), changed)
    assert count(path, "skills") == 1


def test_a_loaded_array_cannot_be_written_to(library: Library) -> None:
    library.save("abc", document())
    loaded = library.load("abc")

    assert loaded is not None
    assert not loaded.starts[0].flags.writeable


def test_arrays_are_stored_once_for_all_skills(library: Library, path: Path) -> None:
    library.save("abc", document())
    before = count(path, "arrays")
    library.save("def", replace(document(), title="The same again"))

    assert count(path, "arrays") == before


def test_arrays_that_no_skill_needs_are_gone(library: Library, path: Path) -> None:
    library.save("abc", document())
    library.save("def", document(demonstrations=1))
    library.save("abc", Document("Empty"))
    library.delete("def")

    assert count(path, "arrays") == count(path, "uses") == 0


def test_an_array_that_another_skill_needs_stays(library: Library) -> None:
    library.save("abc", document())
    library.save("def", document())
    library.delete("abc")

    assert library.load("abc") is None
    assert same_content(library.load("def"), document())


def test_undo_brings_an_array_back_that_was_dropped(library: Library) -> None:
    library.save("abc", document())
    library.save("abc", document(demonstrations=1))
    library.save("abc", document())

    assert same_content(library.load("abc"), document())


def test_deleting_says_whether_there_was_something(library: Library) -> None:
    library.save("abc", document())

    assert library.delete("abc")
    assert not library.delete("abc")


def test_recent_lists_the_last_saved_first(library: Library) -> None:
    for code in ("first", "second", "third"):
        library.save(code, Document(code.title()))
    library.save("first", Document("First again"))

    assert [(s.code, s.title) for s in library.recent(2)] == [("first", "First again"), ("third", "Third")]
    assert library.recent(1)[0].updated.timestamp() == 3.0


@pytest.mark.parametrize("code", ["", "a" * 65, "../etc", "a b", "ä"])
def test_a_code_fits_into_an_address(library: Library, code: str) -> None:
    with pytest.raises(BadCodeError):
        library.save(code, document())


def test_a_second_library_on_the_same_file_sees_what_was_saved(library: Library, path: Path) -> None:
    library.save("abc", document())
    other = Library(f"sqlite:///{path}")
    other.save("def", document())
    other.close()

    assert same_content(library.load("def"), document())


@pytest.mark.parametrize("memory", [True, False])
def test_many_threads_may_save_and_load_at_once(library: Library, memory: bool) -> None:
    shared = Library("sqlite://") if memory else library

    def work(worker: int) -> bool:
        for step in range(8):
            wanted = document(n=20 + step, demonstrations=1 + worker % 3)
            shared.save(f"worker-{worker}", wanted)
            if not same_content(shared.load(f"worker-{worker}"), wanted):
                return False
        return True

    with ThreadPoolExecutor(6) as pool:
        assert all(pool.map(work, range(6)))


def test_two_processes_may_save_at_once(library: Library, path: Path) -> None:
    script = """
        import sys
        from app.library import Library
        from tests.library.makers import document
        library = Library(sys.argv[1])
        for step in range(15):
            library.save("other", document(n=20 + step))
    """
    other = start(script, f"sqlite:///{path}")
    for step in range(15):
        library.save("mine", document(n=20 + step))

    assert other.wait(30) == 0
    assert same_content(library.load("mine"), library.load("other"))


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
    assert ask(path, "PRAGMA integrity_check") == [("ok",)]
    assert ask(path, "PRAGMA foreign_key_check") == []


def test_a_save_that_fails_leaves_the_former_state(library: Library, path: Path) -> None:
    library.save("abc", document())
    connection = sqlite3.connect(path)
    connection.execute(
        "CREATE TRIGGER full BEFORE INSERT ON arrays BEGIN SELECT RAISE(ABORT, 'disk full'); END"
    )
    connection.commit()
    connection.close()

    with pytest.raises(LibraryError, match="disk full"):
        library.save("abc", document(n=77))

    assert same_content(library.load("abc"), document())


def test_a_database_of_another_version_is_refused_and_unharmed(library: Library, path: Path) -> None:
    library.save("abc", document())
    library.close()
    connection = sqlite3.connect(path)
    connection.execute("UPDATE meta SET value = '999' WHERE key = 'schema'")
    connection.commit()
    connection.execute("PRAGMA journal_mode = DELETE")
    connection.close()
    before = path.read_bytes()

    with pytest.raises(ForeignDatabaseError, match="version 999"):
        Library(f"sqlite:///{path}")

    assert path.read_bytes() == before


def test_a_database_of_another_program_is_refused_and_unharmed(tmp_path: Path) -> None:
    path = tmp_path / "other.db"
    connection = sqlite3.connect(path)
    connection.execute("CREATE TABLE skills (name TEXT)")
    connection.commit()
    connection.close()
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
        ("my-skills.db", "no address"),
        ("mysql://localhost/skills", "not in mysql"),
        ("sqlite:////proc/nowhere/library.db", "cannot be opened"),
    ],
)
def test_an_address_that_leads_nowhere_is_refused_with_a_sentence(url: str, words: str) -> None:
    with pytest.raises(LibraryError, match=words):
        Library(url)


def test_a_skill_of_a_newer_version_is_refused_and_the_others_stay(library: Library, path: Path) -> None:
    library.save("abc", document())
    library.save("new", document())
    connection = sqlite3.connect(path)
    connection.execute("""UPDATE skills SET document = '{"format": 99, "document": 0}' WHERE code = 'new'""")
    connection.commit()
    connection.close()

    with pytest.raises(UnreadableSkillError, match="format 99"):
        library.load("new")
    assert same_content(library.load("abc"), document())


def test_the_default_is_a_file_of_the_user_unless_the_environment_names_another(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("GC_TEACH_LIBRARY", raising=False)
    assert default_url().startswith("sqlite:///")
    assert "gc-teach" in default_url()

    monkeypatch.setenv("GC_TEACH_LIBRARY", "sqlite:///elsewhere.db")
    assert default_url() == "sqlite:///elsewhere.db"


def test_an_unchanged_array_is_not_hashed_again(monkeypatch: pytest.MonkeyPatch) -> None:
    hashed: list[int] = []
    monkeypatch.setattr("app.library.packing.content_hash", lambda array: hashed.append(array.size) or "name")
    names, array = ArrayNames(), demonstration().positions

    assert names(array) == names(array) == "name"
    assert len(hashed) == 1


def test_an_array_that_can_be_written_to_is_hashed_each_time() -> None:
    names, array = ArrayNames(), np.zeros(3)
    before = names(array)
    array[0] = 1.0

    assert names(array) != before


def test_a_name_is_forgotten_with_its_array() -> None:
    names = ArrayNames()
    for seed in range(50):
        names(demonstration(seed=seed).positions)

    assert len(names._known) <= 1


def test_only_the_changed_array_is_written_after_a_gesture(library: Library, path: Path) -> None:
    first = document(demonstrations=3)
    library.save("abc", first)
    before = {name for (name,) in ask(path, "SELECT hash FROM arrays")}
    library.save("abc", add_start(first, np.array([0.3, 0.3, 0.3])))
    after = {name for (name,) in ask(path, "SELECT hash FROM arrays")}

    assert before < after
    assert len(after - before) == 1


@pytest.mark.benchmark(group="library")
def test_time_of_a_save_after_one_gesture(benchmark: object, library: Library) -> None:
    versions = [document(n=1500, demonstrations=5)]
    for seed in range(20):
        shown = (Shown(demonstration(1500, 100 + seed)), *versions[0].demonstrations[1:])
        versions.append(replace(versions[0], demonstrations=shown))
    turn = iter(range(10**9))
    library.save("abc", versions[0])

    benchmark(lambda: library.save("abc", versions[next(turn) % len(versions)]))  # type: ignore[operator]  # a fixture

    assert library.load("abc") is not None


def start(script: str, *arguments: str) -> subprocess.Popen[bytes]:
    """Run Python in another process, from the project's folder."""
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    return subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(script), *arguments], cwd=ROOT, env=environment
    )
