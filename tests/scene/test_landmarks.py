"""Landmarks in the scene: what each kind looks like, how it is placed, pulled and turned."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app import edits
from app.document import Document, FloatArray, Place
from app.model import learn
from app.placing import HALF_AN_OBJECT
from app.progress import Progress
from app.scene.bodies import ball, box, post
from app.scene.placing import NEAR, aimed_at
from app.scene.pulls import levelled
from app.store import State
from tests.scene.conftest import Stage, document, state
from tests.scene.test_geometry import volume

POINT = np.array([0.25, -0.35, 0.03])
KINDS = {"via": "way point 1", "obstacle": "obstacle 1", "object": "object 1"}
EYE = np.array([0.85, -1.45, 0.80])
"""Of the 3-D view [m]."""


def state_of(changed: Document, **changes: object) -> State:
    return replace(state(), document=changed, model=learn(changed, state().model), **changes)


def added(kind: str, at: FloatArray = POINT) -> Document:
    return edits.add_landmark(document(), kind, Place("", taught=at))


def shown(stage: Stage, name: str) -> bool:
    return name in stage.client.nodes and stage.client.node(name).visible


@pytest.mark.parametrize("kind", KINDS)
def test_a_landmark_of_every_kind_is_there_and_goes_when_it_is_removed(stage: Stage, kind: str) -> None:
    node = f"/landmarks/{KINDS[kind]}"
    stage.draw(state_of(added(kind)))
    there = shown(stage, node)
    place = stage.client.world_position(node)
    stage.draw(state())

    assert there
    np.testing.assert_allclose(place, POINT, atol=1e-6)
    assert not shown(stage, node)
    assert not shown(stage, f"/turns/{KINDS[kind]}")


@pytest.mark.parametrize("kind", KINDS)
def test_a_landmark_of_every_kind_can_be_pulled(stage: Stage, kind: str) -> None:
    stage.draw(state_of(added(kind)))
    stage.client.drag(f"/landmarks/{KINDS[kind]}", [(0.1, 0.2, 0.3)])
    stage.actions.wait(drags=3)

    assert {drag.node for drag in stage.actions.drags} == {f"/landmarks/{KINDS[kind]}"}


def test_a_name_that_another_kind_takes_over_looks_like_that_kind(stage: Stage) -> None:
    first, second = (
        edits.rename_landmark(added("via"), 2, "cup"),
        edits.rename_landmark(added("object"), 2, "cup"),
    )
    stage.draw(state_of(first))
    stage.draw(state_of(second))

    assert len(stage.client.node("/landmarks/cup").array("vertices")) == 24
    assert shown(stage, "/turns/cup")


@pytest.mark.parametrize("yaw", [0.0, 0.7, -2.5])
def test_the_knob_of_an_object_stands_where_it_was_turned_to(stage: Stage, yaw: float) -> None:
    turned = edits.turn_landmark(added("object"), "object 1", (0.2, 0.0, yaw))
    stage.draw(state_of(turned))

    away = stage.client.world_position("/turns/object 1") - POINT
    assert np.arctan2(away[1], away[0]) == pytest.approx(yaw, abs=1e-6)
    assert away[2] == pytest.approx(0.0, abs=1e-6)


def test_a_knob_is_pulled_at_its_own_height(stage: Stage) -> None:
    stage.draw(state_of(added("object")))
    stage.client.drag("/turns/object 1", [(0.30, -0.30, 0.10)])
    stage.actions.wait(drags=3)

    drag = stage.actions.drags[1]
    assert drag.node == "/turns/object 1"
    assert drag.pointer[2] == pytest.approx(drag.grabbed[2], abs=1e-9)


def test_the_former_tube_is_seen_while_something_is_moved(stage: Stage) -> None:
    goal = state().model.anchors[1].taught
    moved = edits.move_landmark(document(), "goal", goal + 0.05)
    stage.draw(state())
    before = shown(stage, "/former")
    stage.draw(state_of(moved, dragging="/landmarks/goal"))
    during = shown(stage, "/former")
    drawn = stage.client.node("/former").array("vertices")
    stage.draw(state())

    assert (before, during, shown(stage, "/former")) == (False, True, False)
    surface = state().model.taught.surface().reshape(-1, 3)
    assert np.linalg.norm(drawn[::30, None] - surface[None], axis=-1).min(axis=1).max() < 1e-6


def test_while_a_landmark_is_pulled_the_former_tube_is_not_sent_again(stage: Stage) -> None:
    goal = state().model.anchors[1].taught
    stage.draw(state())
    for step in (0.02, 0.04):
        stage.client.log.clear()
        moved = edits.move_landmark(document(), "goal", goal + step)
        stage.draw(state_of(moved, dragging="/landmarks/goal"))

    assert "/former" not in {message["name"] for message in stage.sent()}


# --- placing ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_a_click_on_the_table_places_a_landmark_there(stage: Stage, kind: str) -> None:
    stage.draw(state_of(document(), view=replace(state().view, placing=kind)))
    target = np.array([0.3, 0.1, 0.0 if kind == "via" else HALF_AN_OBJECT])
    stage.client.click_scene(target)
    stage.actions.wait(edits=1, looks=1)

    place = stage.actions.edits[0](document()).landmarks[-1]
    assert place.kind == kind
    np.testing.assert_allclose(place.taught, target, atol=1e-6)
    assert stage.actions.looks == [{"placing": None}]


def test_a_click_on_the_tube_places_a_way_point_on_its_middle_line(stage: Stage) -> None:
    stage.draw(state_of(document(), view=replace(state().view, placing="via")))
    middle = state().model.cylinder.directrix[100]
    stage.client.click_scene(middle + 0.5 * NEAR * np.array([0.0, 0.0, 1.0]))
    stage.actions.wait(edits=1)

    taught = stage.actions.edits[0](document()).landmarks[-1].taught
    gaps = np.linalg.norm(state().model.cylinder.directrix - taught, axis=1)
    assert gaps.min() == 0.0
    assert np.linalg.norm(taught - middle) < 2.0 * NEAR


def test_clicks_are_heard_only_while_a_landmark_waits_for_its_place(stage: Stage) -> None:
    stage.draw(state())
    before = stage.client.hears_clicks
    stage.draw(replace(state(), view=replace(state().view, placing="via")))
    during = stage.client.hears_clicks
    stage.draw(state())

    assert (before, during, stage.client.hears_clicks) == (False, True, False)


def test_a_click_beside_the_hand_of_a_replay_is_told_and_moves_no_playhead(stage: Stage) -> None:
    path = state().model.cylinder.directrix
    progress = Progress("Reach 1", path, path[:10], 0.5, 4.0, held=False)
    stage.draw(replace(state(), replay=progress))
    stage.client.click("/directrix/pick", at=path[100])
    stage.client.click_scene(path[100])
    stage.actions.wait(misses=1)
    stage.draw(state())

    assert not stage.actions.sought
    assert not stage.client.hears_clicks


@settings(deadline=None)  # the first example learns the skill
@given(st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6))
def test_whatever_one_clicks_on_the_place_is_finite_and_in_sight(numbers: list[float]) -> None:
    origin, direction = np.array(numbers[:3]), np.array(numbers[3:])
    if np.linalg.norm(direction) < 1e-3:
        direction = np.array([0.0, 0.0, -1.0])
    direction = direction / np.linalg.norm(direction)
    for kind in KINDS:
        point = aimed_at(state().model, kind, origin, direction)
        away = point - origin
        assert np.isfinite(point).all()
        assert np.linalg.norm(away - (away @ direction) * direction) <= NEAR + 1e-9


def test_without_a_tube_only_the_table_can_be_clicked() -> None:
    empty = learn(Document("empty"))
    down, up = np.array([0.0, 0.6, -0.8]), np.array([0.0, 0.6, 0.8])

    assert aimed_at(empty, "via", EYE, up) is None
    assert aimed_at(empty, "via", EYE, down)[2] == pytest.approx(0.0)


# --- shapes and pointers ----------------------------------------------------------------------------------


@given(aside=st.floats(-0.3, 0.3), up=st.floats(-0.3, 0.3))
def test_a_levelled_pointer_is_on_the_line_of_sight_and_at_the_height(aside: float, up: float) -> None:
    pointer = np.array([aside, -0.4, 0.2 + up])

    there = levelled(EYE, pointer, 0.2)

    np.testing.assert_allclose(np.cross(there - EYE, pointer - EYE), 0.0, atol=1e-9)
    assert there[2] == pytest.approx(0.2) or np.array_equal(there, pointer)


def test_a_pointer_that_is_seen_at_eye_height_stays() -> None:
    pointer = np.array([0.1, -0.4, 0.85])

    np.testing.assert_array_equal(levelled(EYE, pointer, 0.8), pointer)


def test_bodies_look_outward_and_are_as_large_as_they_say() -> None:
    turned = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])

    assert volume(*box(0.03, turned)) == pytest.approx(0.06**3, rel=1e-4)
    assert volume(*ball(0.03)) == pytest.approx(4.0 / 3.0 * np.pi * 0.03**3, rel=0.03)


@pytest.mark.parametrize("low", [-0.5, 0.0, 0.2])
def test_a_post_reaches_from_the_table_to_its_lid(low: float) -> None:
    vertices, faces = post(0.03, low, 0.03)

    assert vertices[:, 2].max() == pytest.approx(0.03)
    assert vertices[:, 2].min() == pytest.approx(min(low, 0.029), abs=1e-6)
    assert faces.max() == len(vertices) - 1
