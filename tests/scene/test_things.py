"""Things in the scene: bodies with edges that are pulled along the table, and handles to size them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app import edits
from app.arm.shapes import rotation_of
from app.document import THING_KINDS, Document, FloatArray, Place
from app.measures import depth, handles
from app.model import learn
from app.scene.things import body, edges
from app.store import State
from app.surroundings import post
from tests.scene.conftest import Stage, document, state
from tests.scene.test_geometry import volume

FOOT = (0.25, -0.35, 0.0)
kinds = pytest.mark.parametrize("kind", THING_KINDS)


def with_thing(kind: str) -> Document:
    return edits.add_thing(document(), kind, FOOT)


def state_of(changed: Document, *, thing: str = "", **changes: object) -> State:
    model = learn(changed, state().model)
    return replace(state(), document=changed, model=model, view=replace(state().view, thing=thing), **changes)


def vertices(stage: Stage, node: str) -> FloatArray:
    """Corners of a mesh in the world (n, 3) [m]."""
    shown = stage.client.node(node)
    return stage.client.world_position(node) + shown.array("vertices")


@kinds
def test_a_thing_is_there_pulled_and_gone_when_it_is_removed(stage: Stage, kind: str) -> None:
    node, changed = f"/obstacles/{kind} 1", with_thing(kind)
    stage.draw(state_of(changed))
    stage.client.drag(node, [(0.1, -0.3, 0.1)])
    stage.actions.wait(drags=3)
    place = stage.client.world_position(node)
    stage.draw(state())

    np.testing.assert_allclose(place, changed.things[0].position, atol=1e-6)
    assert {drag.node for drag in stage.actions.drags} == {node}
    assert not stage.client.node(node).visible


def test_a_thing_is_pulled_along_the_table_and_with_shift_as_the_pointer_goes(stage: Stage) -> None:
    stage.draw(state_of(with_thing("box")))
    for modifier in (None, "shift"):
        stage.client.drag("/obstacles/box 1", [(0.3, -0.3, 0.4)], modifier)
    stage.actions.wait(drags=6)
    flat, up = stage.actions.drags[1], stage.actions.drags[4]

    assert flat.pointer[2] == pytest.approx(flat.grabbed[2], abs=1e-9)
    assert up.pointer[2] == pytest.approx(0.4)


@kinds
def test_the_body_that_is_drawn_is_the_one_that_stands_on_the_table(kind: str) -> None:
    upright = with_thing(kind)
    for thing in (*upright.things, *edits.turn_thing(upright, f"{kind} 1", (0.4, 0.5, 0.6)).things):
        corners, _ = body(thing)
        lowest = (corners @ rotation_of(thing.wxyz).T)[:, 2].min()

        assert -lowest == pytest.approx(depth(thing), abs=2e-3)
        assert np.abs(edges(thing)).max() == pytest.approx(np.abs(corners).max(), abs=1e-6)


def test_bodies_of_things_look_outward() -> None:
    sizes = {
        "box": 0.12 * 0.12 * 0.20,
        "ball": 4.0 / 3.0 * np.pi * 0.06**3,
        "cylinder": np.pi * 0.05**2 * 0.25,
        "ring": 2.0 * np.pi**2 * 0.10 * 0.01**2,
    }

    for kind, size in sizes.items():
        assert volume(*body(with_thing(kind).things[0])) == pytest.approx(size, rel=0.04), kind


@kinds
def test_only_the_thing_that_is_worked_on_has_handles(stage: Stage, kind: str) -> None:
    changed = edits.add_thing(with_thing(kind), "box", (-0.3, -0.5, 0.0))
    stage.draw(state_of(changed, thing=f"{kind} 1"))
    count = len(handles(changed.things[0]))
    nodes = [f"/sizes/{kind} 1/{number}" for number in range(count)]
    there = [stage.client.node(node).visible for node in nodes]
    others = [name for name in stage.client.nodes if name.startswith("/sizes/") and name.count("/") == 3]
    stage.draw(state_of(changed))

    assert there == [True] * count
    assert set(others) == set(nodes)
    assert not any(stage.client.node(node).visible for node in nodes)


def test_while_a_thing_is_pulled_only_its_pose_is_sent(stage: Stage) -> None:
    for x in (0.28, 0.30):
        stage.client.log.clear()
        moved = edits.move_thing(with_thing("box"), "box 1", (x, -0.4, 0.1))
        stage.draw(state_of(moved, thing="box 1", dragging="/obstacles/box 1"))

    names = {message["name"] for message in stage.sent()}
    assert names == {"/obstacles/box 1", *(f"/sizes/box 1/{number}" for number in range(3))}
    assert not any("vertices" in str(message) for message in stage.sent())


def test_a_raised_thing_shows_how_high_it_is(stage: Stage) -> None:
    raised = edits.move_thing(with_thing("box"), "box 1", (0.25, -0.35, 0.4))
    stage.draw(state_of(raised, dragging="/obstacles/box 1"))

    assert stage.client.node("/drop/height").visible
    assert stage.client.world_position("/drop/line") == pytest.approx([0.0, 0.0, 0.0])


def test_what_can_be_carried_has_another_tone(stage: Stage) -> None:
    stage.draw(state_of(with_thing("box")))
    fixed = stage.client.node("/obstacles/box 1").props["color"]
    stage.draw(state_of(edits.weigh_thing(with_thing("box"), "box 1", 0.1)))

    assert stage.client.node("/obstacles/box 1").props["color"] != fixed


@pytest.mark.parametrize("height", [0.0, 0.03, 0.2])
def test_the_post_that_is_drawn_is_the_cylinder_that_the_arm_heeds(stage: Stage, height: float) -> None:
    place = Place("", taught=np.array([0.25, -0.35, height]))
    changed = state_of(edits.add_landmark(document(), "obstacle", place))
    stage.draw(changed)
    drawn = vertices(stage, "/landmarks/obstacle 1")
    heeded = post(changed.model.anchors[-1])

    half = [heeded.radius, heeded.radius, 0.5 * heeded.length]
    np.testing.assert_allclose(drawn.min(axis=0), np.array(heeded.position) - half, atol=1e-3)
    np.testing.assert_allclose(drawn.max(axis=0), np.array(heeded.position) + half, atol=1e-3)


@kinds
def test_a_click_on_the_table_puts_a_thing_there(stage: Stage, kind: str) -> None:
    waiting = replace(state(), view=replace(state().view, placing=kind))
    stage.draw(waiting)
    stage.client.click_scene(np.array([0.3, 0.1, 0.0]))
    stage.actions.wait(edits=1, looks=1)

    (thing,) = stage.actions.edits[0](document()).things
    np.testing.assert_allclose(thing.position, (0.3, 0.1, depth(thing)), atol=1e-6)
    assert stage.actions.looks == [{"placing": None, "thing": f"{kind} 1"}]
