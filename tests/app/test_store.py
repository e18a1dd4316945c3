"""The laws of undo, over any sequence of edits."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app import edits
from app.document import Document
from app.edits import EditError, rename_skill
from app.history import DEEPEST, Version, begin
from app.library import UnreadableSkillError
from app.store import MERGE_WITHIN, Store
from tests.app.makers import taught

STEPS = st.lists(
    st.one_of(
        st.builds(lambda n: ("stations", partial(edits.set_stations, stations=n)), st.integers(20, 24)),
        st.builds(
            lambda k: ("section", partial(edits.set_section, section=k)),
            st.sampled_from(["circle", "ellipse"]),
        ),
        st.builds(
            lambda x: ("start", partial(edits.move_start, index=0, position=np.array([x, 0.0, 0.3]))),
            st.sampled_from([0.1, 0.2, 0.3]),
        ),
        st.builds(lambda m: ("mute", partial(edits.mute_demonstration, index=0, muted=m)), st.booleans()),
    ),
    max_size=12,
)
MERGING = st.lists(st.tuples(st.integers(20, 30), st.booleans(), st.floats(0.0, 2.0)), max_size=15)


@given(steps=STEPS)
def test_undoing_all_brings_every_former_document_back_and_redo_every_later_one(steps: list) -> None:
    store = Store(taught())
    history = [store.document]
    for at, (name, change) in enumerate(steps):
        if store.edit(change, name, now=float(at)):
            history.append(store.document)

    for former in reversed(history[:-1]):
        assert store.undo() is not None
        assert store.document is former
    assert store.undo() is None
    for later in history[1:]:
        assert store.redo() is not None
        assert store.document is later
    assert store.redo() is None


@given(changes=MERGING)
def test_edits_of_one_key_within_a_second_are_one_step(changes: list[tuple[int, bool, float]]) -> None:
    store, now, steps, last = Store(taught()), 0.0, 0, (None, -9.0)
    for stations, keyed, pause in changes:
        now += pause
        key = "stations" if keyed else None
        if store.edit(partial(edits.set_stations, stations=stations), "stations", now=now, key=key):
            merged = key is not None and key == last[0] and now - last[1] <= MERGE_WITHIN
            steps += not merged
            last = (key, now)

    undone = 0
    while store.undo() is not None:
        undone += 1
    assert undone == steps


def test_a_merged_step_is_undone_to_before_its_first_edit() -> None:
    store = Store(taught())
    before = store.document
    for at, stations in enumerate((30, 40, 50)):
        store.edit(partial(edits.set_stations, stations=stations), "stations", now=0.4 * at, key="stations")

    store.undo()

    assert store.document is before


def test_edits_of_different_keys_are_two_steps() -> None:
    store = Store(taught())
    store.edit(partial(edits.set_stations, stations=30), "stations", now=0.0, key="stations")
    between = store.document
    store.edit(partial(edits.rename_skill, title="Pour"), "rename", now=0.1, key="title")

    store.undo()

    assert store.document is between


def test_an_edit_clears_what_could_be_done_again() -> None:
    store = Store(taught())
    store.edit(partial(edits.set_stations, stations=30), "stations", now=0.0)
    store.undo()

    store.edit(partial(edits.set_stations, stations=40), "stations", now=5.0)

    assert (store.redo_name, store.redo(), store.document.settings.stations) == (None, None, 40)


def test_an_edit_that_changes_nothing_keeps_what_could_be_done_again() -> None:
    store = Store(taught())
    store.edit(partial(edits.set_stations, stations=30), "stations", now=0.0)
    store.undo()

    changed = store.edit(lambda document: document, "nothing", now=5.0)

    assert (changed, store.redo_name) == (False, "stations")


def test_an_edit_that_fails_changes_neither_document_nor_history() -> None:
    store = Store(taught())
    before = store.document

    with pytest.raises(EditError):
        store.edit(partial(edits.set_stations, stations=1), "stations", now=0.0)

    assert (store.document, store.undo_name) == (before, None)


def test_opening_another_skill_is_a_step() -> None:
    store = Store(taught())
    before, other = store.document, taught(2)
    store.replace(other, "open another")

    assert (store.document, store.undo_name) == (other, "open another")
    store.undo()
    assert store.document is before


def test_undo_and_redo_say_what_they_would_do() -> None:
    store = Store(taught())
    store.edit(partial(edits.set_stations, stations=30), "stations", now=0.0)
    store.edit(partial(edits.rename_skill, title="Pour"), "rename", now=1.0)

    names = (store.undo_name, store.undo(), store.undo_name, store.redo_name)

    assert names == ("rename", "rename", "stations", "rename")


def test_the_history_has_an_end() -> None:
    store = Store(taught())
    for at in range(DEEPEST + 20):
        store.edit(partial(edits.set_stations, stations=20 + at % 2), "stations", now=10.0 * at)

    undone = 0
    while store.undo() is not None:
        undone += 1
    assert undone == DEEPEST


def test_a_version_that_cannot_be_read_is_not_gone_back_to() -> None:
    def damaged() -> Document:
        raise UnreadableSkillError("the numbers are damaged")

    whole = begin(taught(), 1.0).after(rename_skill(taught(), "Later"), "rename", 2.0)
    store = Store(replace(whole, versions=(Version(1, "", damaged), whole.present)))

    with pytest.raises(UnreadableSkillError):
        store.undo()

    assert store.document.title == "Later"
