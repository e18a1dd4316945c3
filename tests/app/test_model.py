"""Learning is a pure function of the document, and does no stage twice."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from app import edits
from app.document import Document, Place, Settings, Shown
from app.model import COARSE_ANGLES, learn
from gc_core import Constraint, Demonstration, GcError, same_content
from tests.app.makers import demonstration, furnished, rule, taught
from tests.app.test_edits import CHANGES

ELSEWHERE = np.array([0.42, 0.25, 0.50])


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_what_is_reused_has_the_content_of_what_is_learned_afresh(change) -> None:
    former = learn(furnished())
    document = change(former.source)

    assert same_content(learn(document, former), learn(document))


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_the_way_back_has_the_content_of_what_is_learned_afresh(change) -> None:
    document = furnished()
    former = learn(change(document))

    assert same_content(learn(document, former), learn(document))


def test_learning_a_document_again_is_the_same_model() -> None:
    model = learn(taught())

    assert learn(model.source, model) is model


def test_moving_a_start_reuses_the_cylinder() -> None:
    former = learn(taught())

    model = learn(edits.move_start(former.source, 0, ELSEWHERE), former)

    assert model.cylinder is former.cylinder
    assert model.runs[0] is not former.runs[0]


def test_moving_one_start_reuses_the_runs_of_the_others() -> None:
    former = learn(edits.add_start(taught(), ELSEWHERE))

    model = learn(edits.move_start(former.source, 1, ELSEWHERE + 0.02), former)

    assert model.runs[0] is former.runs[0]


def test_moving_a_landmark_reuses_what_was_taught() -> None:
    former = learn(taught())

    model = learn(edits.move_landmark(former.source, "goal", np.array([0.6, -0.2, 0.3])), former)

    assert model.taught is former.taught
    assert model.cylinder is not former.cylinder


def test_a_landmark_that_is_not_moved_is_the_same_object_as_before() -> None:
    former = learn(taught())

    model = learn(edits.move_landmark(former.source, "goal", np.array([0.6, -0.2, 0.3])), former)

    kept = {anchor.name: anchor for anchor in former.anchors}
    assert [anchor.name for anchor in model.anchors if anchor is not kept[anchor.name]] == ["goal"]


def test_the_preview_of_a_moved_landmark_runs_within_a_millimetre_of_what_is_learned() -> None:
    former = learn(taught())
    document = edits.move_landmark(
        former.source, "goal", former.anchors[-1].now + np.array([0.05, -0.1, 0.05])
    )

    preview, learned = learn(document, former, coarse=True), learn(document, former)

    assert len(preview.cylinder.angles) == COARSE_ANGLES
    for rough, run in zip(preview.runs, learned.runs, strict=True):
        away = rough.reproduction.positions - run.reproduction.positions
        assert np.linalg.norm(away, axis=1).max() < 0.001


def test_switching_a_rule_reuses_the_free_run() -> None:
    former = learn(furnished())

    model = learn(edits.enable_rule(former.source, 0, False), former)

    assert model.cylinder is former.cylinder
    assert model.runs[0].free is former.runs[0].free


@pytest.mark.parametrize("change", ["rename_skill", "add_rule", "add_start"])
def test_what_the_cylinder_does_not_depend_on_does_not_make_another(change: str) -> None:
    former = learn(furnished())

    assert learn(CHANGES[change](former.source), former).cylinder is former.cylinder


def test_a_muted_demonstration_is_not_learned_from() -> None:
    odd = replace(demonstration(9), positions=demonstration(9).positions + 0.2)
    document = edits.add_demonstrations(taught(), [odd])

    muted = learn(edits.mute_demonstration(document, 3, True))

    assert same_content(muted.cylinder, learn(taught()).cylinder)


def test_nothing_taught_is_nothing_learned_and_no_problem() -> None:
    model = learn(Document("empty"))

    assert (model.cylinder, model.runs, model.anchors, model.problem) == (None, (), (), None)


def test_a_placed_landmark_stands_there_before_anything_is_taught() -> None:
    model = learn(Document("empty", landmarks=(Place("start"), Place("goal", taught=ELSEWHERE))))

    assert [anchor.name for anchor in model.anchors] == ["goal"]


def test_one_demonstration_has_a_tube_and_a_run() -> None:
    model = learn(taught(1))

    assert model.cylinder is not None
    assert len(model.runs) == 1


def test_landmarks_stand_at_the_ends_of_the_directrix_where_nothing_else_is_said() -> None:
    model = learn(taught())

    assert model.taught is not None
    np.testing.assert_array_equal(model.anchors[0].now, model.taught.directrix[0])
    np.testing.assert_array_equal(model.anchors[1].now, model.taught.directrix[-1])


def test_landmarks_that_stand_where_they_were_taught_bend_nothing() -> None:
    model = learn(taught())

    assert model.cylinder is model.taught
    assert model.registration is None


def test_the_cylinder_ends_where_the_goal_was_moved() -> None:
    goal = np.array([0.6, -0.2, 0.3])

    model = learn(edits.move_landmark(taught(), "goal", goal))

    assert model.cylinder is not None
    np.testing.assert_allclose(model.cylinder.directrix[-1], goal, atol=1e-6)


def test_every_start_has_its_run_and_each_begins_there() -> None:
    document = edits.add_start(taught(), ELSEWHERE)

    runs = learn(document).runs

    np.testing.assert_allclose([run.reproduction.positions[0] for run in runs], document.starts)


def test_a_skill_without_starts_of_its_own_still_has_a_run() -> None:
    model = learn(replace(taught(), starts=()))

    assert len(model.runs) == 1
    assert model.runs[0].reproduction.start_inside


def test_demonstrations_that_cancel_each_other_out_are_explained_and_can_be_repaired() -> None:
    there = np.linspace((0.4, -0.2, 0.3), (0.4, 0.2, 0.3), 50)
    paths = (Demonstration(np.linspace(0.0, 2.0, 50), path) for path in (there, there[::-1]))
    document = Document("Odd", demonstrations=tuple(map(Shown, paths)), settings=Settings(stations=60))

    model = learn(document)
    repaired = learn(edits.delete_demonstration(document, 1), model)

    assert model.problem is not None
    assert (model.cylinder, model.runs) == (None, ())
    assert (repaired.problem, repaired.cylinder is None) == (None, False)


@pytest.mark.parametrize(
    "change",
    [
        partial(edits.set_section, section="circle"),
        partial(edits.set_align_by, align_by="time"),
        partial(edits.set_stations, stations=80),
    ],
)
def test_a_setting_encodes_again(change) -> None:
    former = learn(taught())

    assert learn(change(former.source), former).taught is not former.taught


def test_a_rule_holds_only_where_a_run_would_pass_it() -> None:
    far = rule()
    document = edits.add_rule(edits.move_start(taught(), 0, ELSEWHERE), far.constraint)

    run = learn(document).runs[0]

    touched = np.any(run.reproduction.positions != run.free.positions, axis=1)
    assert np.any(touched)
    assert not np.all(touched)


def test_a_start_near_the_end_of_the_tube_still_runs_the_whole_skill() -> None:
    document = taught()
    model = learn(document)
    assert model.cylinder is not None
    near_the_end = model.cylinder.directrix[-2]

    moved = learn(edits.move_start(document, 0, near_the_end), model).runs[0].reproduction

    assert len(moved.times) == len(model.cylinder.directrix)
    np.testing.assert_array_equal(moved.positions[0], near_the_end)


def test_changing_the_number_of_stations_keeps_a_rule_where_it_was_made() -> None:
    document = edits.add_rule(taught(), rule().constraint)
    before = learn(document).runs[0].reproduction
    after = learn(edits.set_stations(document, 173)).runs[0].reproduction

    parts = [run.stations / run.stations[-1] for run in (before, after)]
    expected = np.stack([np.interp(parts[1], parts[0], column) for column in before.positions.T], axis=1)
    # A plane begins where the correction is one millimetre.
    np.testing.assert_allclose(after.positions, expected, atol=2e-3)


def test_a_rule_moves_with_the_landmarks() -> None:
    goal = np.array([0.60, -0.25, 0.35])
    moved = learn(edits.move_landmark(edits.add_rule(taught(), rule().constraint), "goal", goal))

    (kept,) = moved.constraints
    assert moved.registration is not None
    np.testing.assert_allclose(kept.points, moved.registration(rule().constraint.points))
    assert moved.runs[0].reproduction is not moved.runs[0].free


def test_a_rule_made_while_a_landmark_is_moved_is_kept_as_taught_and_holds_where_it_was_made() -> None:
    model = learn(edits.move_landmark(taught(), "goal", np.array([0.60, -0.25, 0.35])))
    run = model.runs[0].reproduction
    lower = run.positions - np.outer(np.sin(np.pi * run.stations / run.stations[-1]), [0.0, 0.0, 0.06])
    made = Constraint.from_correction(run, lower)

    (held,) = learn(edits.add_rule(model.source, model.rule_taken_back(made)), model).constraints
    np.testing.assert_allclose(held.points, made.points, atol=1e-6)
    np.testing.assert_allclose(held.normals[made.active], made.normals[made.active], atol=1e-5)


def test_moving_a_landmark_there_and_back_leaves_ruled_runs_as_they_were() -> None:
    document = edits.add_rule(taught(), rule().constraint)
    before = learn(document)
    there = learn(edits.move_landmark(document, "goal", np.array([0.60, -0.25, 0.35])), before)

    back = learn(edits.put_landmark_back(there.source, "goal"), there)
    assert same_content(back.runs, before.runs)


def test_a_rule_where_landmarks_leave_no_room_is_refused_in_words() -> None:
    start = learn(taught()).cylinder.directrix[0]
    model = learn(edits.move_landmark(taught(), "goal", start + 1e-4))
    run = model.runs[0].reproduction
    made = Constraint.from_correction(run, run.positions + np.array([0.5, 0.5, 2.0]))

    with pytest.raises(GcError, match="space folds where you correct this run"):
        model.rule_taken_back(made)


def test_rules_that_contradict_each_other_are_named() -> None:
    down = rule("Lid").constraint
    up = Constraint.from_correction(down.points, down.points + np.array([0.0, 0.0, 0.1]))
    document = edits.add_rule(edits.add_rule(taught(), down), up)

    (found,) = learn(document).contradictions
    assert found.names == ("Rule 1", "Rule 2")
    assert learn(edits.enable_rule(document, 0, False)).contradictions == ()
