"""The laws of the edits: a new object, the same one when nothing changes, a sentence on nonsense."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from app import edits
from app.document import Document, Place, Shown
from app.edits import EditError
from app.measures import measures, turn_of
from gc_core import GcError, same_content
from tests.app.makers import demonstration, furnished, rule, taught

Edit = Callable[[Document], Document]
ELSEWHERE = np.array([0.4, -0.2, 0.3])

CHANGES: dict[str, Edit] = {
    "rename_skill": lambda d: edits.rename_skill(d, "Pouring"),
    "set_section": lambda d: edits.set_section(d, "circle"),
    "set_align_by": lambda d: edits.set_align_by(d, "time"),
    "set_stations": lambda d: edits.set_stations(d, 100),
    "add_demonstrations": lambda d: edits.add_demonstrations(d, [demonstration(7)]),
    "replace_demonstration": lambda d: edits.replace_demonstration(d, 1, demonstration(7)),
    "rename_demonstration": lambda d: edits.rename_demonstration(d, 1, "slow one"),
    "mute_demonstration": lambda d: edits.mute_demonstration(d, 1, True),
    "duplicate_demonstration": lambda d: edits.duplicate_demonstration(d, 1),
    "delete_demonstration": lambda d: edits.delete_demonstration(d, 1),
    "bring_back_demonstration": lambda d: edits.bring_back_demonstration(d, Shown(demonstration(7))),
    "trim_demonstration": lambda d: edits.trim_demonstration(d, 1, 0.5, 2.0),
    "add_start": lambda d: edits.add_start(d, ELSEWHERE),
    "move_start": lambda d: edits.move_start(d, 0, ELSEWHERE),
    "remove_start": lambda d: edits.remove_start(d, 0),
    "move_landmark": lambda d: edits.move_landmark(d, "start", ELSEWHERE),
    "put_landmark_back": lambda d: edits.put_landmark_back(d, "goal"),
    "put_landmarks_back": edits.put_landmarks_back,
    "add_landmark": lambda d: edits.add_landmark(d, "via", Place("", taught=ELSEWHERE)),
    "remove_landmark": lambda d: edits.remove_landmark(d, "cup"),
    "rename_landmark": lambda d: edits.rename_landmark(d, 1, "red ball"),
    "turn_landmark": lambda d: edits.turn_landmark(d, "cup", (0.0, 0.0, 1.0)),
    "set_smoothing": lambda d: edits.set_smoothing(d, 0.25),
    "add_rule": lambda d: edits.add_rule(d, rule().constraint),
    "enable_rule": lambda d: edits.enable_rule(d, 0, False),
    "rename_rule": lambda d: edits.rename_rule(d, 0, "Low ceiling"),
    "delete_rule": lambda d: edits.delete_rule(d, 0),
    "add_thing": lambda d: edits.add_thing(d, "ring", ELSEWHERE),
    "move_thing": lambda d: edits.move_thing(d, "crate", ELSEWHERE),
    "turn_thing": lambda d: edits.turn_thing(d, "crate", (0.0, 0.0, 1.0)),
    "resize_thing": lambda d: edits.resize_thing(d, "crate", (0.1, 0.2, 0.3)),
    "pull_thing_side": lambda d: edits.pull_thing_side(d, "crate", 1, 0.02),
    "weigh_thing": lambda d: edits.weigh_thing(d, "crate", 0.2),
    "rename_thing": lambda d: edits.rename_thing(d, 0, "red box"),
    "remove_thing": lambda d: edits.remove_thing(d, "crate"),
}
"""One real change by every public edit."""

MAKERS = {"edit", "new_thing_name", "point", "skill_of"}
"""Public functions that are no edits."""

SAME: dict[str, Edit] = {
    "rename_skill": lambda d: edits.rename_skill(d, f" {d.title} "),
    "set_section": lambda d: edits.set_section(d, d.settings.section),
    "set_align_by": lambda d: edits.set_align_by(d, d.settings.align_by),
    "set_stations": lambda d: edits.set_stations(d, d.settings.stations),
    "add_demonstrations": lambda d: edits.add_demonstrations(d, []),
    "replace_demonstration": lambda d: edits.replace_demonstration(d, 1, d.demonstrations[1].demonstration),
    "rename_demonstration": lambda d: edits.rename_demonstration(
        d, 1, d.demonstrations[1].demonstration.name
    ),
    "mute_demonstration": lambda d: edits.mute_demonstration(d, 1, False),
    "bring_back_demonstration": lambda d: edits.bring_back_demonstration(d, d.demonstrations[1]),
    "trim_demonstration": lambda d: edits.trim_demonstration(d, 1, 0.0, 99.0),
    "move_start": lambda d: edits.move_start(d, 0, d.starts[0].copy()),
    "move_landmark": lambda d: edits.move_landmark(d, "goal", d.landmarks[1].now),
    "put_landmark_back": lambda d: edits.put_landmark_back(d, "start"),
    "rename_landmark": lambda d: edits.rename_landmark(d, 1, " goal "),
    "turn_landmark": lambda d: edits.turn_landmark(d, "cup", d.landmarks[2].turn.copy()),
    "set_smoothing": lambda d: edits.set_smoothing(d, d.smoothing),
    "enable_rule": lambda d: edits.enable_rule(d, 0, True),
    "rename_rule": lambda d: edits.rename_rule(d, 0, f" {d.rules[0].name} "),
    "move_thing": lambda d: edits.move_thing(d, "crate", d.things[0].position),
    "turn_thing": lambda d: edits.turn_thing(d, "crate", turn_of(d.things[0].wxyz)),
    "resize_thing": lambda d: edits.resize_thing(d, "crate", measures(d.things[0])),
    "pull_thing_side": lambda d: edits.pull_thing_side(d, "crate", 1, 0.0),
    "weigh_thing": lambda d: edits.weigh_thing(d, "crate", 0.0),
    "rename_thing": lambda d: edits.rename_thing(d, 0, " crate "),
}
"""Edits that ask for what is already so."""

NONSENSE: dict[str, Edit] = {
    "an empty name": lambda d: edits.rename_skill(d, "   "),
    "an unknown section": lambda d: edits.set_section(d, "star"),
    "an unknown alignment": lambda d: edits.set_align_by(d, "magic"),
    "too few stations": lambda d: edits.set_stations(d, 3),
    "stations that are no number": lambda d: edits.set_stations(d, float("nan")),
    "a demonstration that is not there": lambda d: edits.mute_demonstration(d, 9, True),
    "a negative index": lambda d: edits.delete_demonstration(d, -1),
    "a trim that leaves nothing": lambda d: edits.trim_demonstration(d, 0, 2.0, 1.0),
    "a start that is not a number": lambda d: edits.move_start(d, 0, np.full(3, np.nan)),
    "a start beyond all reach": lambda d: edits.add_start(d, np.array([1e9, 0.0, 0.0])),
    "a start of two numbers": lambda d: edits.add_start(d, np.zeros(2)),
    "a start of words": lambda d: edits.add_start(d, ["a", "b", "c"]),
    "a ragged start": lambda d: edits.add_start(d, [0.0, [1.0, 2.0], 3.0]),
    "a start that is not there": lambda d: edits.remove_start(d, 4),
    "an unknown landmark": lambda d: edits.move_landmark(d, "moon", ELSEWHERE),
    "a landmark without a place": lambda d: edits.add_landmark(d, "via"),
    "a second goal": lambda d: edits.add_landmark(d, "goal"),
    "an unknown kind of landmark": lambda d: edits.add_landmark(d, "cloud", Place("", taught=ELSEWHERE)),
    "a landmark beyond all reach": lambda d: edits.add_landmark(d, "via", Place("", taught=100 * ELSEWHERE)),
    "removing an unknown landmark": lambda d: edits.remove_landmark(d, "moon"),
    "a name that another landmark has": lambda d: edits.rename_landmark(d, 2, "goal"),
    "a name for no landmark": lambda d: edits.rename_landmark(d, 7, "cup"),
    "a name with a stroke": lambda d: edits.rename_landmark(d, 2, "cup/2"),
    "a turn of a point": lambda d: edits.turn_landmark(d, "goal", (0.0, 0.0, 1.0)),
    "a turn of two angles": lambda d: edits.turn_landmark(d, "cup", (0.0, 1.0)),
    "a turn that is not a number": lambda d: edits.turn_landmark(d, "cup", (0.0, 0.0, float("nan"))),
    "too much smoothing": lambda d: edits.set_smoothing(d, 7.0),
    "a rule that is not there": lambda d: edits.enable_rule(d, 3, False),
    "an unknown kind of thing": lambda d: edits.add_thing(d, "cloud", ELSEWHERE),
    "a thing beyond all reach": lambda d: edits.add_thing(d, "box", 100 * ELSEWHERE),
    "moving an unknown thing": lambda d: edits.move_thing(d, "moon", ELSEWHERE),
    "removing an unknown thing": lambda d: edits.remove_thing(d, "moon"),
    "a place that is not a number": lambda d: edits.move_thing(d, "crate", np.full(3, np.nan)),
    "a thing that is turned by two angles": lambda d: edits.turn_thing(d, "crate", (0.0, 1.0)),
    "a thing turned by no number": lambda d: edits.turn_thing(d, "crate", (0.0, 0.0, float("nan"))),
    "a box of two measures": lambda d: edits.resize_thing(d, "crate", (0.1, 0.1)),
    "a box as thin as nothing": lambda d: edits.resize_thing(d, "crate", (0.1, 0.0, 0.1)),
    "a box as large as a house": lambda d: edits.resize_thing(d, "crate", (0.1, 9.0, 0.1)),
    "a measure that is not a number": lambda d: edits.resize_thing(d, "crate", (0.1, float("nan"), 0.1)),
    "a fourth side of a box": lambda d: edits.pull_thing_side(d, "crate", 3, 0.1),
    "a thing that weighs less than nothing": lambda d: edits.weigh_thing(d, "crate", -0.1),
    "a thing of no weight at all": lambda d: edits.weigh_thing(d, "crate", float("nan")),
    "a thing with a stroke in its name": lambda d: edits.rename_thing(d, 0, "a/b"),
    "a name that another thing has": lambda d: edits.rename_thing(d, 0, "can"),
    "the name of the table": lambda d: edits.rename_thing(d, 0, "table"),
    "a name for no thing": lambda d: edits.rename_thing(d, 7, "box"),
}


def public_edits() -> set[str]:
    return {
        name
        for name, value in vars(edits).items()
        if callable(value)
        and getattr(value, "__module__", "").startswith(edits.__name__)
        and not name.startswith("_")
        and not isinstance(value, type)
    } - MAKERS


def test_every_public_edit_is_tested_here() -> None:
    assert public_edits() == set(CHANGES)


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_an_edit_makes_another_document_and_leaves_its_own_untouched(change: Edit) -> None:
    document = furnished()
    before = pickle.dumps(document)

    changed = change(document)

    assert not same_content(changed, document)
    assert pickle.dumps(document) == before


@pytest.mark.parametrize("change", SAME.values(), ids=SAME)
def test_an_edit_that_changes_nothing_returns_the_same_document(change: Edit) -> None:
    document = furnished()

    assert change(document) is document


@pytest.mark.parametrize("change", NONSENSE.values(), ids=NONSENSE)
def test_nonsense_is_answered_with_a_sentence(change: Edit) -> None:
    with pytest.raises(EditError, match=r"\w+ \w+.*\.$"):
        change(furnished())


def test_a_trim_keeps_the_samples_between_two_times_and_starts_the_clock_again() -> None:
    document = edits.trim_demonstration(taught(), 0, 0.5, 2.0)

    original, part = taught().demonstrations[0].demonstration, document.demonstrations[0].demonstration
    kept = (original.times >= 0.5) & (original.times <= 2.0)
    np.testing.assert_array_equal(part.positions, original.positions[kept])
    np.testing.assert_array_equal(part.gripper, original.gripper[kept])
    np.testing.assert_allclose(part.times, original.times[kept] - original.times[kept][0])


def test_demonstrations_without_a_name_are_numbered_on() -> None:
    nameless = [replace(demonstration(i), name="") for i in (4, 5)]

    document = edits.add_demonstrations(taught(3), nameless)

    names = [shown.demonstration.name for shown in document.demonstrations[3:]]
    assert names == ["Demonstration 4", "Demonstration 5"]


def test_moving_the_start_that_every_skill_has_makes_it_ones_own() -> None:
    document = replace(taught(), starts=())

    moved = edits.move_start(document, 0, ELSEWHERE)

    np.testing.assert_array_equal(moved.starts, [ELSEWHERE])


def test_there_can_be_twelve_starts_and_no_more() -> None:
    document = taught()
    for _ in range(11):
        document = edits.add_start(document, ELSEWHERE)

    with pytest.raises(EditError, match="twelve"):
        edits.add_start(document, ELSEWHERE)


def test_a_landmark_that_moves_before_anything_is_taught_is_placed_there() -> None:
    empty = Document("My skill", landmarks=(Place("start"), Place("goal", taught=np.zeros(3))))

    goal = edits.move_landmark(empty, "goal", ELSEWHERE).landmarks[1]

    np.testing.assert_array_equal(goal.taught, ELSEWHERE)
    assert goal.now is None


def test_a_moved_landmark_goes_back_to_where_it_was_taught() -> None:
    document = taught()

    back = edits.put_landmark_back(edits.move_landmark(document, "goal", ELSEWHERE), "goal")

    assert same_content(back, document)


def test_landmarks_that_stand_where_they_were_taught_are_not_put_back_once_more() -> None:
    document = edits.put_landmarks_back(furnished())

    assert edits.put_landmarks_back(document) is document


def test_a_landmark_keeps_its_kind_under_another_name() -> None:
    document = edits.rename_landmark(taught(), 1, "red ball")

    assert (document.landmarks[1].name, document.landmarks[1].kind) == ("red ball", "goal")


@pytest.mark.parametrize("name", ["start", "goal"])
def test_only_the_ends_of_the_motion_are_called_so(name: str) -> None:
    document = edits.remove_landmark(furnished(), name)

    with pytest.raises(EditError, match=f"Only the {name}"):
        edits.rename_landmark(document, 1, name)


@pytest.mark.parametrize("name", ["start", "goal"])
def test_an_end_that_was_removed_can_be_added_again_without_a_place(name: str) -> None:
    document = edits.add_landmark(edits.remove_landmark(taught(), name), name)

    assert {place.kind for place in document.landmarks} == {"start", "goal"}


def test_landmarks_are_numbered_by_kind_and_no_name_is_given_twice() -> None:
    document, place = taught(), Place("", taught=ELSEWHERE)
    for kind in ("via", "object", "via", "obstacle", "via"):
        document = edits.add_landmark(document, kind, place)
    document = edits.add_landmark(edits.remove_landmark(document, "way point 1"), "via", place)

    names = [place.name for place in document.landmarks]
    assert len(set(names)) == len(names)
    assert names[2:] == ["object 1", "way point 2", "obstacle 1", "way point 3", "way point 4"]


def test_there_can_be_twelve_landmarks_and_no_more() -> None:
    document, place = taught(), Place("", taught=ELSEWHERE)
    for _ in range(10):
        document = edits.add_landmark(document, "via", place)

    with pytest.raises(EditError, match="twelve"):
        edits.add_landmark(document, "via", place)


@pytest.mark.parametrize("turns", [-3, -1, 1, 2])
def test_a_whole_turn_more_is_the_same_turn(turns: int) -> None:
    angles = np.array([0.3, -0.2, 2.9])

    turned = edits.turn_landmark(furnished(), "cup", angles + 2.0 * np.pi * turns).landmarks[2].turn

    np.testing.assert_allclose(turned, angles, atol=1e-9)


def test_an_object_that_is_turned_to_nothing_was_not_turned() -> None:
    document = edits.turn_landmark(furnished(), "cup", np.zeros(3))

    assert document.landmarks[2].turn is None


def test_a_checked_point_is_a_copy_that_nobody_can_write_to() -> None:
    mine = np.zeros(3)

    checked = edits.point(mine)
    mine[0] = 1.0

    np.testing.assert_array_equal(checked, 0.0)
    assert not checked.flags.writeable


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_the_first_edit_of_a_built_in_skill_makes_a_copy_of_ones_own(change: Edit) -> None:
    built_in = replace(furnished(), built_in=True)

    copy = edits.edit(built_in, change)

    assert not copy.built_in
    assert built_in.built_in
    assert copy.title == ("Pouring" if change is CHANGES["rename_skill"] else "My reaching")


@pytest.mark.parametrize("change", SAME.values(), ids=SAME)
def test_an_edit_that_changes_nothing_leaves_a_built_in_skill_built_in(change: Edit) -> None:
    built_in = replace(furnished(), built_in=True)

    assert edits.edit(built_in, change) is built_in


def test_a_skill_of_recordings_holds_them_all_under_its_title() -> None:
    document = edits.skill_of("  alpha  ", [demonstration(0), demonstration(1)])

    assert (document.title, len(document.demonstrations), document.built_in) == ("alpha", 2, False)


def test_an_edit_error_is_an_error_of_the_input() -> None:
    assert issubclass(EditError, GcError)


def test_a_number_is_given_to_one_demonstration_only() -> None:
    nameless = replace(demonstration(), name="")
    document = edits.add_demonstrations(Document("Mine"), [nameless] * 3)

    document = edits.delete_demonstration(document, 0)
    document = edits.add_demonstrations(document, [nameless])

    names = [shown.demonstration.name for shown in document.demonstrations]
    assert len(set(names)) == len(names)


def test_a_number_is_given_to_one_rule_only() -> None:
    document = Document("Mine")
    for _ in range(3):
        document = edits.add_rule(document, rule().constraint)

    document = edits.add_rule(edits.delete_rule(document, 0), rule().constraint)

    names = [kept.name for kept in document.rules]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize(
    "rename",
    [
        edits.rename_skill,
        lambda d, name: edits.rename_demonstration(d, 0, name),
        lambda d, name: edits.rename_rule(d, 0, name),
        lambda d, name: edits.rename_landmark(d, 2, name),
    ],
)
def test_a_name_keeps_no_sign_that_could_not_be_saved(rename: Callable[[Document, str], Document]) -> None:
    renamed = rename(furnished(), " a\0\ud800 \x1bb\N{ZERO WIDTH JOINER}é")

    found = [renamed.title, renamed.rules[0].name, renamed.landmarks[2].name]
    assert "a b\N{ZERO WIDTH JOINER}é" in [*found, renamed.demonstrations[0].demonstration.name]
