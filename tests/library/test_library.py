"""Skills in a real database of each kind: kept, shared between threads, never half written."""

import os
import subprocess
import sys
import textwrap
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.document import Document, Shown
from app.edits import add_start, mute_demonstration
from app.history import begin, opening
from app.library import (
    KEPT_DELETED,
    ArrayNames,
    BadCodeError,
    Library,
    LibraryError,
    UnreadableSkillError,
)
from app.library.packing import row_of
from app.library.tables import arrays, steps
from gc_core import same_content
from tests.library.makers import demonstration, document

ROOT = Path(__file__).parents[2]


def ask(library: Library, query: str) -> list[tuple[Any, ...]]:
    with library._engine.connect() as connection:
        return [tuple(row) for row in connection.exec_driver_sql(query)]


def count(library: Library, table: str) -> int:
    ((number,),) = ask(library, f"SELECT count(*) FROM {table}")
    return int(number)


def test_a_saved_skill_is_loaded_with_every_field(library: Library) -> None:
    library.save("abc", document())

    assert same_content(library.load("abc"), document())


def test_what_was_never_saved_is_none(library: Library) -> None:
    assert library.load("abc") is None


def test_saving_again_replaces(library: Library) -> None:
    library.save("abc", document())
    changed = mute_demonstration(document(), 0, False)
    library.save("abc", changed)

    assert same_content(library.load("abc"), changed)
    assert count(library, "skills") == 1


def test_a_loaded_array_cannot_be_written_to(library: Library) -> None:
    library.save("abc", document())
    loaded = library.load("abc")

    assert loaded is not None
    assert not loaded.starts[0].flags.writeable


def test_arrays_are_stored_once_for_all_skills(library: Library) -> None:
    library.save("abc", document())
    before = count(library, "arrays")
    library.save("def", replace(document(), title="The same again"))

    assert count(library, "arrays") == before


def test_undo_brings_an_array_back_that_was_dropped(library: Library) -> None:
    library.save("abc", document())
    library.save("abc", document(demonstrations=1))
    library.save("abc", document())

    assert same_content(library.load("abc"), document())


def test_arrays_that_no_skill_needs_are_gone(library: Library) -> None:
    library.save("abc", document())
    library.save("def", document(demonstrations=1))
    library.save("abc", Document("Empty"))
    library.forget("def")

    assert count(library, "arrays") == count(library, "uses") == 0


def test_an_array_that_another_skill_needs_stays(library: Library) -> None:
    library.save("abc", document())
    library.save("def", document())

    assert library.forget("abc")
    assert library.load("abc") is None
    assert same_content(library.load("def"), document())


def test_a_deleted_skill_is_listed_apart_until_it_is_brought_back(library: Library) -> None:
    library.save("abc", document())

    assert [library.delete("abc"), library.delete("abc")] == [True, False]
    assert [s.code for s in library.recent()] == []
    assert [s.code for s in library.deleted()] == ["abc"]
    assert [library.restore("abc"), library.restore("abc")] == [True, False]
    assert [s.code for s in library.recent()] == ["abc"]
    assert same_content(library.load("abc"), document())


def test_work_on_a_deleted_skill_brings_it_back(library: Library) -> None:
    library.save("abc", document())
    library.delete("abc")
    library.save("abc", document())

    assert [s.code for s in library.recent()] == ["abc"]


def test_a_skill_that_was_deleted_a_month_ago_is_gone_and_one_of_yesterday_is_not(
    library: Library, url: str
) -> None:
    now = 1e9
    other = Library(url, clock=lambda: now)
    other.save("old", document())
    other.delete("old")
    now += KEPT_DELETED - 86400.0
    other.save("new", document())
    other.delete("new")
    other.close()

    now += 2 * 86400.0
    later = Library(url, clock=lambda: now)

    assert [s.code for s in later.deleted()] == ["new"]
    assert later.load("old") is None
    later.close()


def test_recent_lists_the_last_saved_first(library: Library) -> None:
    for code in ("first", "second", "third"):
        library.save(code, Document(code.title()))
    library.save("first", Document("First again"))

    listed = library.recent(2)
    assert [(s.code, s.title) for s in listed] == [("first", "First again"), ("third", "Third")]
    assert listed[0].updated > listed[1].updated
    assert [s.code for s in library.recent(2, among={"second", "unknown"})] == ["second"]


def test_a_skill_that_was_only_begun_is_not_listed(library: Library) -> None:
    begun = begin(document(), 1.0).after(Document("My skill"), opening(Document("My skill")), 2.0)
    library.keep("begun", begun)
    library.keep("named", begun.after(Document("Pouring"), "rename skill", 3.0))

    assert [summary.title for summary in library.recent()] == ["Pouring"]
    assert library.open("begun") is not None


def test_a_second_library_on_the_same_database_sees_what_was_saved(library: Library, url: str) -> None:
    library.save("abc", document())
    other = Library(url)
    other.save("def", document())
    other.close()

    assert same_content(library.load("def"), document())


def save_and_load(library: Library, worker: int) -> bool:
    """Whether a thread always gets back what it saved."""
    for step in range(6):
        wanted = document(n=20 + step, demonstrations=1 + worker % 3)
        library.save(f"worker-{worker}", wanted)
        if not same_content(library.load(f"worker-{worker}"), wanted):
            return False
    return True


def test_many_threads_may_save_and_load_at_once(library: Library) -> None:
    with ThreadPoolExecutor(6) as pool:
        assert all(pool.map(partial(save_and_load, library), range(6)))


def test_many_threads_may_use_a_library_in_memory() -> None:
    library = Library("sqlite://")
    with ThreadPoolExecutor(6) as pool:
        assert all(pool.map(partial(save_and_load, library), range(6)))


def test_two_processes_may_save_at_once(library: Library, url: str) -> None:
    script = """
        import sys
        from app.library import Library
        from tests.library.makers import document
        library = Library(sys.argv[1])
        for step in range(15):
            library.save("other", document(n=20 + step))
    """
    other = start(script, url)
    for step in range(15):
        library.save("mine", document(n=20 + step))

    assert other.wait(30) == 0
    assert same_content(library.load("mine"), library.load("other"))


def test_a_save_that_fails_leaves_the_former_state(library: Library, monkeypatch: pytest.MonkeyPatch) -> None:
    library.save("abc", document())
    with monkeypatch.context() as broken:
        broken.setattr(
            "app.library.library.row_of", lambda name, array: row_of(name, array) | {"bytes": None}
        )
        with pytest.raises(LibraryError, match="could not be saved"):
            library.save("abc", document(n=77))

    assert same_content(library.load("abc"), document())


def test_a_skill_of_a_newer_version_is_refused_and_the_others_stay(library: Library) -> None:
    library.save("abc", document())
    library.save("new", document())
    with library._engine.begin() as connection:
        newer = steps.update().where(steps.c.code == "new")
        connection.execute(newer.values(document='{"format": 99, "document": 0}'))

    with pytest.raises(UnreadableSkillError, match="format 99"):
        library.load("new")
    with pytest.raises(UnreadableSkillError, match="format 99"):
        library.open("new")
    assert same_content(library.load("abc"), document())


def test_numbers_that_do_not_fit_to_their_shape_are_refused_with_a_sentence(library: Library) -> None:
    library.save("abc", document())
    with library._engine.begin() as connection:
        connection.execute(arrays.update().values(shape="[1000000000, 1000000000]"))

    with pytest.raises(UnreadableSkillError, match="are damaged"):
        library.load("abc")


@pytest.mark.parametrize("code", ["", "a" * 65, "../etc", "a b", "ä"])
def test_a_code_fits_into_an_address(library: Library, code: str) -> None:
    with pytest.raises(BadCodeError):
        library.save(code, document())


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


def test_only_the_changed_array_is_written_after_a_gesture(library: Library) -> None:
    first = document(demonstrations=3)
    library.save("abc", first)
    before = {name for (name,) in ask(library, "SELECT hash FROM arrays")}
    library.save("abc", add_start(first, np.array([0.3, 0.3, 0.3])))
    after = {name for (name,) in ask(library, "SELECT hash FROM arrays")}

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
