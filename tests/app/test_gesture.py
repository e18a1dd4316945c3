"""A pull as a displacement, and what the displacement means for each thing that can be pulled."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app import edits, gesture, linepull
from app.actions import Drag
from app.document import Document, FloatArray
from app.gesture import Pull
from app.linepull import LinePull
from app.model import Model, learn
from gc_core import same_content
from tests.app.makers import WIDTH, furnished, place_of, taught

WAYS = st.lists(st.tuples(*[st.floats(-0.3, 0.3)] * 3), min_size=1, max_size=6)
PARTS = st.lists(st.tuples(WAYS, st.booleans()), min_size=1, max_size=5)
GRAB = np.array([0.4, 0.1, 0.3])
BY = np.array([0.03, -0.04, 0.05])
NOTHING_THERE = (
    "/landmarks/moon",
    "/start/1",
    "/start/-1",
    "/start/x",
    "/start/²",
    "/demonstrations/3",
    "/reproductions/9",
    "/tube",
    "/directrix",
    "/landmarks/",
    "/turns/goal",
    "/turns/moon",
    "/landmarks/cup/stem",
    "/",
    "",
)


def drag(phase: str, pointer: FloatArray, *, vertical: bool = False) -> Drag:
    return Drag("/start/0", phase, GRAB, pointer, 0.0, vertical=vertical)


@given(parts=PARTS)
def test_a_displacement_is_the_sum_over_its_parts_and_shift_leaves_the_height(parts: list) -> None:
    pointer, expected, track = GRAB, np.zeros(3), None
    for ways, vertical in parts:
        start = drag("start", pointer, vertical=vertical)
        track = gesture.begin(start) if track is None else gesture.follow(track, start)
        for way in ways:
            pointer = pointer + way
            expected = expected + (np.array([0.0, 0.0, way[2]]) if vertical else way)
            track = gesture.follow(track, drag("update", pointer, vertical=vertical))
        track = gesture.follow(track, drag("end", pointer, vertical=vertical))

    assert track is not None
    np.testing.assert_allclose(track.displacement, expected, atol=1e-12)


def test_beginning_again_elsewhere_in_mid_pull_moves_nothing() -> None:
    track = gesture.follow(gesture.begin(drag("start", GRAB)), drag("update", GRAB + BY))

    again = gesture.follow(track, drag("start", GRAB - 0.2, vertical=True))

    np.testing.assert_allclose(again.displacement, BY, atol=1e-12)


def test_a_pull_begins_with_what_the_pointer_has_already_moved() -> None:
    track = gesture.begin(drag("start", GRAB + BY))

    np.testing.assert_allclose(track.displacement, BY)


def pulled(document: Document, node: str, by: FloatArray = BY) -> Document:
    model = learn(document)
    return grabbed(node, model).apply(document, by)


def grabbed(node: str, model: Model) -> Pull | LinePull:
    """Something that is held where one would grab it."""
    at = place_of(node, model, GRAB)
    pull = linepull.take(node, at, model, WIDTH, unreachable=lambda _: None) or gesture.pull_on(
        node, at, model
    )
    assert pull is not None
    return pull


@pytest.mark.parametrize(
    ("node", "field"),
    [
        ("/start/0", "starts"),
        ("/landmarks/goal", "landmarks"),
        ("/landmarks/start", "landmarks"),
        ("/demonstrations/1", "demonstrations"),
        ("/reproductions/0", "rules"),
    ],
)
def test_a_pull_changes_what_was_pulled_and_nothing_else(node: str, field: str) -> None:
    document = furnished()

    after = pulled(document, node)

    changed = [f.name for f in fields(Document) if getattr(after, f.name) is not getattr(document, f.name)]
    assert changed == [field]


@pytest.mark.parametrize("node", NOTHING_THERE)
def test_what_is_not_there_cannot_be_pulled(node: str) -> None:
    model = learn(furnished())

    assert gesture.pull_on(node, GRAB, model) is None
    assert linepull.take(node, GRAB, model, WIDTH, unreachable=lambda _: None) is None


def test_a_landmark_without_a_place_cannot_be_pulled() -> None:
    assert gesture.pull_on("/landmarks/goal", GRAB, learn(Document("empty"))) is None


def test_a_pulled_start_moves_by_the_displacement() -> None:
    document = taught()

    moved = pulled(document, "/start/0").starts[0]

    np.testing.assert_allclose(moved - document.starts[0], BY)


def test_a_pulled_landmark_moves_by_the_displacement() -> None:
    before, after = (learn(d).anchors[1] for d in (taught(), pulled(taught(), "/landmarks/goal")))

    np.testing.assert_allclose(after.now - before.now, BY)
    np.testing.assert_array_equal(after.taught, before.taught)


@cache
def with_a_cup() -> Model:
    """Learned once: that takes longer than an example may."""
    return learn(furnished())


@given(angle=st.floats(-3.1, 3.1), height=st.floats(-0.2, 0.2), stretch=st.floats(0.3, 3.0))
def test_the_handle_of_an_object_turns_it_as_far_as_the_pointer_goes_around_it(
    angle: float, height: float, stretch: float
) -> None:
    model = with_a_cup()
    document, cup = model.source, model.source.landmarks[2]
    arm = np.array([0.08, 0.02, 0.0])
    pull = gesture.pull_on("/turns/cup", cup.taught + arm, model)
    cos, sin = np.cos(angle), np.sin(angle)
    there = stretch * np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]) @ arm

    turned = pull.apply(document, there + np.array([0.0, 0.0, height]) - arm).landmarks[2]

    wanted = cup.turn + np.array([0.0, 0.0, angle])
    np.testing.assert_allclose(np.exp(1j * turned.turn), np.exp(1j * wanted), atol=1e-9)
    np.testing.assert_array_equal(turned.taught, cup.taught)


def test_without_a_start_landmark_a_start_follows_the_pointer_though_the_map_carries_it() -> None:
    shifted = pulled(edits.remove_landmark(taught(), "start"), "/landmarks/goal")

    before, after = (learn(d).runs[0] for d in (shifted, pulled(shifted, "/start/0")))

    np.testing.assert_allclose(before.start - learn(taught()).runs[0].start, BY, atol=1e-9)
    np.testing.assert_allclose(after.start - before.start, BY, atol=1e-6)


def test_pulling_the_start_landmark_takes_the_starts_along() -> None:
    before, after = (learn(d).runs[0] for d in (taught(), pulled(taught(), "/landmarks/start")))

    np.testing.assert_allclose(after.start - before.start, BY, atol=1e-12)


def test_a_start_follows_the_pointer_also_where_its_landmark_was_moved() -> None:
    shifted = pulled(taught(), "/landmarks/start")

    before, after = (learn(d).runs[0] for d in (shifted, pulled(shifted, "/start/0")))

    np.testing.assert_allclose(after.start - before.start, BY, atol=1e-12)


def test_the_start_that_every_skill_has_follows_the_pointer_where_its_landmark_was_moved() -> None:
    shifted = pulled(replace(taught(), starts=()), "/landmarks/start")

    before, after = (learn(d).runs[0] for d in (shifted, pulled(shifted, "/start/0")))

    np.testing.assert_allclose(after.start - before.start, BY, atol=1e-12)


def test_a_corrected_demonstration_passes_through_the_pointer_and_keeps_all_but_its_path() -> None:
    document = taught()
    before = document.demonstrations[1].demonstration

    after = pulled(document, "/demonstrations/1").demonstrations[1].demonstration

    middle = len(before.positions) // 2
    np.testing.assert_allclose(after.positions[middle] - before.positions[middle], BY, atol=1e-9)
    np.testing.assert_array_equal(after.positions[[0, -1]], before.positions[[0, -1]])
    assert same_content(replace(after, positions=before.positions), before)


def test_correcting_one_demonstration_leaves_the_others_the_same_objects() -> None:
    document = taught()

    after = pulled(document, "/demonstrations/1")

    assert after.demonstrations[0] is document.demonstrations[0]
    assert after.demonstrations[2] is document.demonstrations[2]


def test_the_rule_of_a_pulled_run_moves_that_run_to_the_pointer() -> None:
    document = taught()
    before = learn(document).runs[0].reproduction.positions
    middle = len(before) // 2

    run = learn(pulled(document, "/reproductions/0")).runs[0]

    np.testing.assert_allclose(run.reproduction.positions[middle] - before[middle], BY, atol=1e-6)
    np.testing.assert_array_equal(run.free.positions, before)


def test_a_rule_that_is_switched_off_gives_the_former_run_back() -> None:
    document = taught()
    ruled = pulled(document, "/reproductions/0")

    off = learn(edits.enable_rule(ruled, 0, False)).runs[0]

    assert off.reproduction is off.free
    np.testing.assert_array_equal(off.free.positions, learn(document).runs[0].reproduction.positions)


@pytest.mark.parametrize("node", ["/start/0", "/landmarks/goal", "/demonstrations/1", "/reproductions/0"])
def test_a_pull_is_measured_from_where_it_began_however_often_it_is_applied(node: str) -> None:
    document = taught()
    model = learn(document)
    pull = grabbed(node, model)

    pull.apply(document, 3.0 * BY)
    once, twice = pull.apply(document, BY), pull.apply(document, BY)

    assert same_content(once, twice)
