"""Every step of a skill is saved, in as little room as can be, and comes back in its place."""

import random
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.document import Document
from app.edits import add_start, delete_demonstration, mute_demonstration, rename_skill, replace_demonstration
from app.history import DEEPEST, History, begin, deleted_demonstrations
from app.library import Kept, Library, encode_document
from gc_core import same_content
from tests.library.makers import demonstration, document
from tests.library.test_library import count

MOST_BYTES = 10_000_000
"""100 steps of a skill of five demonstrations of 1500 samples take less."""


def opened(library: Library, code: str = "abc") -> Kept:
    kept = library.open(code)
    assert kept is not None
    return kept


def same(one: History, other: History) -> bool:
    """Whether two histories have the same versions and the same place."""

    def content(history: History) -> list[tuple[object, ...]]:
        parts = [(version, encode_document(version.document)) for version in history.versions]
        return [(v.stamp, v.name, encoded.text, encoded.arrays.keys()) for v, encoded in parts]

    return one.place == other.place and content(one) == content(other)


def step(history: History, dice: random.Random) -> History:
    """What a person may do next."""
    kind = dice.randrange(6)
    if kind == 0:
        return history.back()
    if kind == 1:
        return history.forth()
    now = history.present.document
    index = dice.randrange(len(now.demonstrations))
    if kind == 2:
        return history.after(
            rename_skill(now, f"Skill {dice.random()}"), "rename", 5.0, instead=dice.random() < 0.5
        )
    if kind == 3:
        return history.after(
            replace_demonstration(now, index, demonstration(20, dice.randrange(9))), "correct", 6.0
        )
    if kind == 4:
        return history.after(add_start(now, np.array([dice.random(), 0.1, 0.2])), "add start", 7.0)
    return history.after(mute_demonstration(now, index, dice.random() < 0.5), "mute", 8.0)


@pytest.mark.parametrize("seed", range(4))
def test_whatever_is_done_and_undone_between_saves_comes_back(library: Library, seed: int) -> None:
    dice = random.Random(seed)
    history = begin(document(n=20), 1.0)
    for _ in range(8):
        for _ in range(dice.randrange(6)):
            history = step(history, dice)
        library.keep("abc", history)

        assert same(opened(library).history, history)


def test_what_no_step_needs_any_more_is_gone(library: Library) -> None:
    history = begin(Document("Empty"), 1.0)
    library.keep("abc", history)
    library.keep("abc", history.after(document(), "add", 2.0))
    library.keep("abc", history.after(Document("Other"), "rename", 3.0))

    assert count(library, "arrays") == count(library, "uses") == 0
    assert count(library, "steps") == 2


def test_two_servers_on_one_skill_leave_the_history_of_the_last_to_save(library: Library, url: str) -> None:
    begun = begin(document(n=20), 1.0)
    library.keep("abc", begun)
    one = begun.after(rename_skill(begun.present.document, "One"), "rename", 2.0)
    other = begun.after(rename_skill(begun.present.document, "Other"), "rename", 2.5)
    library.keep("abc", one)
    second = Library(url)
    second.keep("abc", other)
    second.close()

    assert same(opened(library).history, other)


def test_versions_share_the_demonstrations_that_did_not_change(library: Library) -> None:
    begun = begin(document(), 1.0)
    library.keep("abc", begun.after(mute_demonstration(begun.present.document, 0, False), "unmute", 2.0))

    history = opened(library).history
    before, after = (version.document for version in history.versions)

    assert before.demonstrations[0].demonstration is after.demonstrations[0].demonstration
    assert before.rules[0].constraint is after.rules[0].constraint


def test_the_history_has_an_end_on_disk_too(library: Library) -> None:
    history = begin(Document("Skill"), 1.0)
    for number in range(DEEPEST + 5):
        history = history.after(Document(f"Skill {number}"), "rename", 2.0)
    library.keep("abc", history)

    assert count(library, "steps") == DEEPEST + 1
    assert opened(library).history.place == DEEPEST


def test_what_was_tried_is_kept(library: Library) -> None:
    library.keep("abc", begin(Document("Skill"), 1.0), tried={"undo", "goal"})

    assert opened(library).tried == {"undo", "goal"}


def test_a_hundred_steps_of_a_large_skill_take_little_room(path: Path) -> None:
    dice = np.random.default_rng(0)
    library = Library(f"sqlite:///{path}")
    history = begin(document(n=1500, demonstrations=5), 1.0)
    for number in range(100):
        now, index = history.present.document, number % 5
        former = now.demonstrations[index].demonstration
        shaken = former.positions + np.cumsum(dice.normal(0.0, 1e-4, former.positions.shape), axis=0)
        turned = former.orientations + dice.normal(0.0, 1e-3, former.orientations.shape)
        corrected = replace(former, positions=shaken, orientations=turned)
        history = history.after(replace_demonstration(now, index, corrected), "correct", 2.0)
        library.keep("abc", history)

    assert sum(file.stat().st_size for file in path.parent.iterdir()) < MOST_BYTES
    assert len(opened(library).history.versions) == 101
    library.close()


def test_a_deleted_demonstration_is_found_until_it_is_back(library: Library) -> None:
    begun = begin(document(), 1.0)
    gone = begun.present.document.demonstrations[0]
    deleted = begun.after(delete_demonstration(begun.present.document, 0), "delete it", 2.0)
    library.keep("abc", deleted)

    (found,) = deleted_demonstrations(opened(library).history)
    assert same_content(found, gone)
    assert deleted_demonstrations(deleted) == (gone,)
    assert deleted_demonstrations(deleted.back()) == ()
    assert deleted_demonstrations(deleted.after(begun.present.document, "bring it back", 3.0)) == ()


def test_a_correction_or_another_name_is_no_deletion() -> None:
    begun = begin(document(), 1.0)
    corrected = replace_demonstration(begun.present.document, 0, demonstration(20, 7))

    assert deleted_demonstrations(begun.after(corrected, "delete nothing", 2.0)) == ()
