"""What a tab is sent for a state, and what its pulls and clicks become."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app import edits
from app.arm.protocol import Shortfall
from app.document import Place, Shown
from app.model import learn
from app.player import station_at
from app.scene.cylinder import AT_REST, WHILE_DRAGGING
from app.store import State
from gc_core import Constraint
from tests.scene.conftest import Stage, document, preview, state

NAMES = {
    "/hand": "IcosphereMessage",
    "/start/0": "IcosphereMessage",
    "/demonstrations/0": "MeshMessage",
    "/demonstrations/0/line": "LineSegmentsMessage",
    "/demonstrations/4": "MeshMessage",
    "/reproductions/0": "MeshMessage",
    "/reproductions/0/line": "LineSegmentsMessage",
    "/directrix": "LineSegmentsMessage",
    "/section": "LineSegmentsMessage",
    "/tube": "MeshMessage",
    "/landmarks/start": "MeshMessage",
    "/landmarks/goal": "MeshMessage",
    "/arm/upper": "FrameMessage",
    "/arm/lower/mesh": "MeshMessage",
    "/table": "BoxMessage",
}
PULLED = ("/hand", "/start/0", "/demonstrations/2", "/reproductions/0", "/landmarks/goal", "/landmarks/start")


def shown(stage: Stage, name: str) -> bool:
    return name in stage.client.nodes and stage.client.node(name).visible


def with_rule() -> State:
    """A run that rules have pushed down a little."""
    plain = state()
    run = plain.model.runs[0]
    lower = replace(run.free, positions=run.free.positions - [0.0, 0.0, 0.02])
    return replace(plain, model=replace(plain.model, runs=(replace(run, reproduction=lower),)))


@pytest.mark.parametrize("name", NAMES)
def test_every_name_is_there_with_its_type(stage: Stage, name: str) -> None:
    stage.draw(state())

    assert stage.client.node(name).kind == NAMES[name]


def test_lines_are_those_of_the_model(stage: Stage) -> None:
    stage.draw(state())
    drawn = {
        "/directrix": state().model.cylinder.directrix,
        "/reproductions/0/line": state().model.runs[0].reproduction.positions,
        "/demonstrations/3/line": state().document.demonstrations[3].demonstration.positions,
    }

    for name, points in drawn.items():
        segments = stage.client.node(name).array("points", -1, 2, 3)
        np.testing.assert_allclose(segments[:, 0], points[:-1], atol=1e-6)
        np.testing.assert_allclose(segments[:, 1], points[1:], atol=1e-6)


def test_the_tube_is_never_interactive(stage: Stage) -> None:
    stage.draw(state())
    tube = stage.client.node("/tube")

    assert not tube.drags
    assert not tube.clicks


def test_the_vertices_of_the_tube_lie_on_the_surface(stage: Stage) -> None:
    stage.draw(state())
    vertices = stage.client.node("/tube").array("vertices")
    surface = state().model.cylinder.surface().reshape(-1, 3)
    distance = np.linalg.norm(vertices[::40, None] - surface[None], axis=-1).min(axis=1)

    assert len(vertices) == AT_REST[0] * AT_REST[1]
    assert distance.max() < 1e-6


def test_a_state_drawn_twice_sends_nothing(stage: Stage) -> None:
    stage.draw(state())
    stage.client.log.clear()
    stage.draw(state())

    assert not stage.sent()


def test_a_preview_changes_the_tube_and_not_the_other_demonstrations(stage: Stage) -> None:
    stage.draw(state())
    tube = stage.client.node("/tube").props["vertices"]
    stage.client.log.clear()
    stage.draw(preview(state(), np.array([0.0, 0.0, 0.05])))

    assert stage.client.node("/tube").array("vertices").size != tube.size
    assert not {m["name"] for m in stage.sent() if "/demonstrations/" in m.get("name", "")} - {
        "/demonstrations/0",
        "/demonstrations/0/line",
    }


def test_while_dragging_the_tube_is_coarse_and_its_faces_are_sent_once(stage: Stage) -> None:
    stage.draw(state())
    stage.draw(preview(state(), np.array([0.0, 0.0, 0.01])))
    stage.client.log.clear()
    stage.draw(preview(state(), np.array([0.0, 0.0, 0.02])))
    updates = [m["updates"] for m in stage.sent() if m.get("name") == "/tube"]

    assert [list(u) for u in updates] == [["vertices"]]
    assert stage.client.node("/tube").array("vertices").shape[0] == WHILE_DRAGGING[0] * WHILE_DRAGGING[1]


def test_what_the_pointer_hits_of_a_pulled_line_follows_at_the_release(stage: Stage) -> None:
    stage.draw(state())
    pulled = preview(state(), np.array([0.0, 0.0, 0.05]))
    stage.client.log.clear()
    stage.draw(pulled)
    drawn = {m["name"] for m in stage.sent() if m.get("name", "").startswith("/demonstrations/")}
    stage.client.log.clear()
    stage.draw(replace(pulled, dragging=None))
    hit = {m["name"] for m in stage.sent() if m.get("name", "").startswith("/demonstrations/")}

    assert (drawn, hit) == ({"/demonstrations/0/line"}, {"/demonstrations/0"})


def test_nothing_is_added_or_removed_while_dragging(stage: Stage) -> None:
    stage.draw(state())
    stage.draw(preview(state(), np.array([0.0, 0.0, 0.01])))
    stage.client.log.clear()
    stage.draw(preview(state(), np.array([0.0, 0.0, 0.02])))

    assert not [m for m in stage.sent() if "props" in m or m["type"].startswith("Remove")]


def test_fewer_demonstrations_hide_the_surplus_and_more_bring_it_back(stage: Stage) -> None:
    stage.draw(state())
    stage.draw(state(3))
    assert [shown(stage, f"/demonstrations/{i}") for i in range(5)] == [True] * 3 + [False] * 2

    stage.draw(state())
    assert all(shown(stage, f"/demonstrations/{i}") for i in range(5))


def test_without_demonstrations_nothing_learned_is_shown(stage: Stage) -> None:
    stage.draw(state())
    empty = learn(replace(document(), demonstrations=()))
    stage.draw(replace(state(), document=empty.source, model=empty))

    hidden = ("/tube", "/directrix", "/section", "/reproductions/0", "/start/0", "/landmarks/goal")
    assert not [name for name in hidden if shown(stage, name)]


def test_a_muted_demonstration_stays_and_is_dashed(stage: Stage) -> None:
    first, *others = document().demonstrations
    muted = replace(document(), demonstrations=(Shown(first.demonstration, muted=True), *others))
    stage.draw(replace(state(), document=muted))
    dashes = stage.client.node("/demonstrations/0/line").array("points", -1, 2, 3)

    assert shown(stage, "/demonstrations/0")
    assert np.linalg.norm(dashes[1:, 0] - dashes[:-1, 1], axis=1).min() > 0.005


def test_the_planes_of_a_rule_are_solid_because_the_tube_hides_what_is_translucent(stage: Stage) -> None:
    run = state().model.runs[0].free
    pressed = run.positions - 0.03 * np.sin(np.linspace(0.0, np.pi, len(run.positions)))[:, None] * [0, 0, 1]
    rule = Constraint.from_correction(run, replace(run, positions=pressed))
    ruled = edits.add_rule(document(), rule)
    stage.draw(replace(state(), document=ruled, model=learn(ruled, state().model)))

    assert shown(stage, "/rules/planes")
    assert stage.client.node("/rules/planes").props["opacity"] is None


def test_a_run_changed_by_rules_is_twice_as_wide_with_dots_and_its_former_path(stage: Stage) -> None:
    stage.draw(state())
    before = stage.client.node("/reproductions/0/line").props["thickness"]
    stage.draw(with_rule())

    assert stage.client.node("/reproductions/0/line").props["thickness"] == 2.0 * before
    assert shown(stage, "/reproductions/0/free")
    assert shown(stage, "/reproductions/0/last")
    stage.draw(state())
    assert not shown(stage, "/reproductions/0/free")


def test_a_moved_goal_leaves_a_ghost_where_it_was_taught(stage: Stage) -> None:
    stage.draw(state())
    taught = state().model.anchors[1].taught
    now = taught + np.array([0.1, 0.0, 0.05])
    moved = replace(document(), landmarks=(Place("start"), Place("goal", now=now)))
    stage.draw(replace(state(), document=moved, model=learn(moved, state().model)))

    np.testing.assert_allclose(stage.client.world_position("/landmarks/goal"), now, atol=1e-6)
    np.testing.assert_allclose(stage.client.world_position("/taught/goal"), taught, atol=1e-6)
    stage.draw(state())
    assert not shown(stage, "/taught/goal")


def test_an_unreachable_place_is_tethered_and_explained(stage: Stage) -> None:
    stage.draw(state())
    hand = state().hand
    far = replace(
        hand, wanted=hand.position + np.array([0.5, 0.0, 0.0]), shortfall=Shortfall(0.5, "50 cm beyond reach")
    )
    stage.draw(replace(state(), hand=far))

    assert stage.client.node("/wanted/reason").props["text"] == "50 cm beyond reach"
    assert shown(stage, "/wanted/tether")
    stage.draw(state())
    assert not shown(stage, "/wanted/tether")


def test_what_is_dragged_shows_its_height(stage: Stage) -> None:
    stage.draw(replace(state(), dragging="/hand"))

    assert stage.client.node("/drop/height").props["text"] == "30 cm"
    np.testing.assert_allclose(stage.client.world_position("/drop/shadow")[:2], state().hand.position[:2])
    stage.draw(state())
    assert not shown(stage, "/drop/height")


def test_links_turn_with_the_joints(stage: Stage) -> None:
    stage.draw(state())
    stage.draw(replace(state(), hand=replace(state().hand, joints=np.array([0.0, np.pi / 2]))))

    np.testing.assert_allclose(stage.client.node("/arm/lower").wxyz, np.sqrt([0.5, 0.0, 0.0, 0.5]), atol=1e-9)
    assert stage.client.node("/arm/upper").wxyz == (1.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("name", PULLED)
def test_a_pull_reaches_the_actions_with_its_node_and_time(stage: Stage, name: str) -> None:
    stage.draw(state())
    stage.client.drag(name, [(0.1, 0.2, 0.3)])
    stage.actions.wait(drags=3)

    assert [d.phase for d in stage.actions.drags] == ["start", "update", "end"]
    assert {d.node for d in stage.actions.drags} == {name}
    assert {d.time for d in stage.actions.drags} == {stage.now}
    np.testing.assert_allclose(stage.actions.drags[1].pointer, [0.1, 0.2, 0.3], atol=1e-9)


def test_shift_pulls_up_and_down(stage: Stage) -> None:
    stage.draw(state())
    stage.client.drag("/landmarks/goal", [(0.1, 0.2, 0.3)], modifier="shift")
    stage.actions.wait(drags=3)

    assert all(drag.vertical for drag in stage.actions.drags)


def test_the_right_button_moves_the_hand_aside(stage: Stage) -> None:
    stage.draw(state())
    stage.client.drag("/hand", [(0.1, 0.2, 0.3)], button="right")
    stage.actions.wait(drags=3)

    assert all(drag.aside for drag in stage.actions.drags)


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), 1e6])
def test_a_pointer_that_makes_no_sense_is_dropped(stage: Stage, bad: float) -> None:
    stage.draw(state())
    stage.client.drag("/hand", [(bad, 0.0, 0.0), (0.1, 0.2, 0.3)])
    stage.actions.wait(drags=3)

    assert all(np.all(np.abs(drag.pointer) < 1.0) for drag in stage.actions.drags)


def test_a_pull_with_a_bad_end_ends_where_it_last_was(stage: Stage) -> None:
    stage.draw(state())
    stage.client.drag("/hand", [(0.1, 0.2, 0.3), (float("nan"), 0.0, 0.0)])
    stage.actions.wait(drags=3)

    assert stage.actions.drags[-1].phase == "end"
    np.testing.assert_allclose(stage.actions.drags[-1].pointer, [0.1, 0.2, 0.3], atol=1e-9)


def test_a_click_on_the_directrix_moves_the_playhead_there(stage: Stage) -> None:
    stage.draw(state())
    run = state().model.runs[0].reproduction
    stage.client.click("/directrix/pick", at=state().model.cylinder.directrix[90])
    stage.actions.wait(seeks=1)

    assert stage.actions.sought[0] == pytest.approx(run.times[90], abs=0.1)


def test_the_section_is_that_of_the_playhead(stage: Stage) -> None:
    late = replace(state(), playback=replace(state().playback, time=3.0))
    stage.draw(late)
    run = late.model.runs[0].reproduction
    station = station_at(run, 3.0)  # the same as in the panel with the slice
    ring = stage.client.node("/section").array("points", -1, 2, 3)[:, 0]

    np.testing.assert_allclose(ring, late.model.cylinder.surface()[station], atol=1e-6)


def test_the_grip_of_the_hand_points_at_the_camera(stage: Stage) -> None:
    camera = np.array([0.1, -0.4, 2.3])
    stage.scene.look_from(camera)
    stage.draw(state())
    w, x, y, z = stage.client.node("/hand/grip").wxyz
    ahead = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])

    np.testing.assert_allclose(ahead, [0.0, 0.0, 1.0], atol=1e-9)


@pytest.mark.parametrize(("beside", "wins"), [(0.04, "/start/0"), (0.0, "/hand")])
def test_a_start_seen_beside_a_hand_that_plays_is_what_a_press_on_it_takes(
    stage: Stage, beside: float, wins: str
) -> None:
    shown = state()
    start = shown.model.runs[0].start
    stage.scene.look_from(start + np.array([0.0, -2.0, 0.0]))
    hand = replace(shown.hand, position=start + np.array([beside, 0.0, 0.0]))
    stage.draw(replace(shown, hand=hand, playback=replace(shown.playback, playing=True)))
    reach = {}
    for node in ("/start/0", "/hand"):
        grip = stage.client.node(f"{node}/grip")
        reach[node] = grip.array("vertices", -1, 3)[:, 2].max() * grip.props["scale"][2]

    assert max(reach, key=lambda node: reach[node]) == wins


@pytest.mark.parametrize("near", [0.3, 0.8, 3.0])
def test_no_grip_reaches_the_camera(stage: Stage, near: float) -> None:
    shown = state()
    goal = next(anchor.now for anchor in shown.model.anchors if anchor.kind == "goal")
    stage.scene.look_from(goal + np.array([0.0, 0.0, near]))
    stage.draw(shown)
    grip = stage.client.node("/landmarks/goal/grip")
    length = grip.array("vertices", -1, 3)[:, 2].max() * grip.props["scale"][2]

    assert 0.0 < length < near


@pytest.mark.parametrize("nowhere", [np.full(3, np.nan), np.zeros(4), np.array(["a", "b", "c"])])
def test_a_camera_that_is_nowhere_turns_no_grip_and_keeps_the_scene_drawing(
    stage: Stage, nowhere: np.ndarray
) -> None:
    stage.draw(state())
    before = stage.client.node("/hand/grip").wxyz

    stage.scene.look_from(nowhere)
    stage.draw(state())

    assert stage.client.node("/hand/grip").wxyz == before
