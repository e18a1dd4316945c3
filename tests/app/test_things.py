"""Things in the way: their measures, how they are pulled, and what the arm heeds of them."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app import edits
from app.anchors import quaternion
from app.arm import Jaco
from app.arm.shapes import pose_of, surface_distance
from app.desk import Desk
from app.document import THING_KINDS, Box, Cylinder, Document, Place, Ring, Shape, Sphere, View
from app.edits import EditError
from app.measures import NAMES, handles, kind_of, measured, measures, turn_of, underside
from app.model import learn
from app.surroundings import conditions_of, leads_through, post
from tests.app.makers import Mouse, desk_of, furnished, taught

FOOT = (0.3, -0.5, 0.0)
EVERY = (
    Box("box", (0.1, 0.2, 0.3), (0.1, 0.2, 0.3)),
    Sphere("ball", (0.1, 0.2, 0.3), 0.1),
    Cylinder("cylinder", (0.1, 0.2, 0.3), 0.05, 0.2),
    Ring("ring", (0.1, 0.2, 0.3), 0.1, 0.02),
)
NUMBERS = st.floats(-3.0, 3.0) | st.sampled_from([float("nan"), float("inf"), 0.0, 1e9])
kinds = pytest.mark.parametrize("kind", THING_KINDS)


def with_thing(kind: str, document: Document | None = None) -> Document:
    return edits.add_thing(document or taught(), kind, FOOT)


def name_of(kind: str) -> str:
    return f"{kind} 1"


# --- measures and edits -----------------------------------------------------------------------------------


@pytest.mark.parametrize("thing", EVERY, ids=kind_of)
def test_measures_that_are_read_can_be_given_back(thing: Shape) -> None:
    again = measured(thing, measures(thing))

    assert len(measures(thing)) == len(NAMES[kind_of(thing)])
    np.testing.assert_allclose(measures(again), measures(thing), atol=1e-12)


@pytest.mark.parametrize("thing", EVERY, ids=kind_of)
@given(angles=st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3))
def test_handles_are_on_the_surface_of_a_thing_however_it_is_turned(
    thing: Shape, angles: list[float]
) -> None:
    turned = replace(thing, wxyz=tuple(quaternion(np.array(angles))))
    pose = pose_of(turned)

    for handle in handles(turned):
        assert surface_distance(turned, pose, handle.place) == pytest.approx(0.0, abs=1e-9)
        assert surface_distance(turned, pose, handle.place + 0.01 * handle.along) > 0.009


@given(
    angles=st.tuples(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5) | st.just(np.pi / 2), st.floats(-3.1, 3.1))
)
def test_a_turn_that_is_read_turns_to_the_same_place(angles: tuple[float, float, float]) -> None:
    wxyz = tuple(quaternion(np.array(angles)))
    again = quaternion(turn_of(wxyz))

    assert abs(np.dot(again, wxyz)) == pytest.approx(1.0, abs=1e-9)


@kinds
def test_a_new_thing_stands_on_the_table_where_it_was_put(kind: str) -> None:
    thing = with_thing(kind).things[0]

    assert thing.position[:2] == FOOT[:2]
    assert underside(thing) == pytest.approx(0.0, abs=1e-12)
    assert thing.mass == 0.0


@kinds
@given(
    three=st.lists(NUMBERS, min_size=3, max_size=3),
    lengths=st.lists(NUMBERS, min_size=1, max_size=3),
    number=st.integers(-1, 3),
)
def test_whatever_is_done_to_a_thing_it_is_not_below_the_table_and_refusals_are_sentences(
    kind: str, three: list[float], lengths: list[float], number: int
) -> None:
    document, name = with_thing(kind), name_of(kind)
    for change in (
        lambda d: edits.move_thing(d, name, three),
        lambda d: edits.turn_thing(d, name, three),
        lambda d: edits.resize_thing(d, name, lengths),
        lambda d: edits.pull_thing_side(d, name, number, lengths[0]),
        lambda d: edits.weigh_thing(d, name, lengths[0]),
    ):
        with contextlib.suppress(EditError):
            document = change(document)

    assert underside(document.things[0]) >= -1e-9


@kinds
@settings(deadline=None)  # a busy machine
@given(turn=st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3), length=st.floats(0.01, 0.5))
def test_what_stands_on_the_table_stands_on_it_when_it_is_turned_and_sized(
    kind: str, turn: list[float], length: float
) -> None:
    document, name = edits.turn_thing(with_thing(kind), name_of(kind), turn), name_of(kind)
    sized = edits.resize_thing(document, name, (length,) * len(NAMES[kind]))

    assert underside(document.things[0]) == pytest.approx(0.0, abs=1e-9)
    assert underside(sized.things[0]) == pytest.approx(0.0, abs=1e-9)


def test_no_two_things_have_the_same_name() -> None:
    document = edits.rename_thing(with_thing("box"), 0, "ball 1")
    for kind in (*THING_KINDS, *THING_KINDS):
        document = edits.add_thing(document, kind, FOOT)

    assert len({thing.name for thing in document.things}) == 9


def test_there_are_twelve_things_at_most() -> None:
    document = taught()
    for _ in range(edits.MOST_THINGS):
        document = with_thing("box", document)

    with pytest.raises(EditError, match="Remove one"):
        with_thing("box", document)


# --- pulling ----------------------------------------------------------------------------------------------


@kinds
def test_a_thing_is_pulled_in_one_step_and_the_model_stays(kind: str) -> None:
    desk = desk_of(with_thing(kind))
    before, node = desk.state().model, f"/obstacles/{name_of(kind)}"
    there = np.add(before.source.things[0].position, (0.1, 0.05, 0.0))
    Mouse(desk).pull(node, (0.1, 0.05, 0.0))
    after = desk.state()

    np.testing.assert_allclose(after.document.things[0].position, there, atol=1e-9)
    assert (after.model.cylinder, after.model.runs) == (before.cylinder, before.runs)
    assert after.undo_name == f"move {name_of(kind)}"
    desk.undo(100.0)
    assert desk.state().document is before.source


@pytest.mark.parametrize(("lift", "height"), [(0.30, 0.30), (0.304, 0.304), (0.005, 0.0), (-0.4, 0.0)])
def test_shift_lifts_a_thing_and_near_the_table_it_is_put_down(lift: float, height: float) -> None:
    desk = desk_of(with_thing("box"))
    Mouse(desk).pull("/obstacles/box 1", (0.1, 0.2, lift), vertical=True)
    thing = desk.state().document.things[0]

    assert underside(thing) == pytest.approx(height, abs=1e-9)
    assert thing.position[:2] == FOOT[:2]


@pytest.mark.parametrize("number", range(3))
def test_pulling_a_side_of_a_box_leaves_the_other_side_where_it_is(number: int) -> None:
    desk = desk_of(edits.turn_thing(with_thing("box"), "box 1", (0.0, 0.0, 0.5)))
    before = desk.state().document.things[0]
    handle = handles(before)[number]
    Mouse(desk).pull(f"/sizes/box 1/{number}", 0.05 * handle.along)
    after = desk.state().document.things[0]

    assert measures(after)[number] == pytest.approx(measures(before)[number] + 0.05)
    opposite = np.array(before.position) - 0.5 * measures(before)[number] * handle.along
    np.testing.assert_allclose(
        np.array(after.position) - 0.5 * measures(after)[number] * handle.along, opposite, atol=1e-9
    )


@kinds
def test_a_thing_is_never_pulled_to_nothing(kind: str) -> None:
    desk = desk_of(with_thing(kind))
    for number, handle in enumerate(handles(desk.state().document.things[0])):
        Mouse(desk, 10.0 + 5.0 * number).pull(f"/sizes/{name_of(kind)}/{number}", -1.0 * handle.along)

    assert min(measures(desk.state().document.things[0])) == pytest.approx(0.005)


def test_what_is_grabbed_is_worked_on_until_something_else_is() -> None:
    desk = desk_of(with_thing("ball", with_thing("box")))
    mouse = Mouse(desk)
    chosen = []
    for node in ("/obstacles/box 1", "/obstacles/ball 1", "/sizes/ball 1/0", "/landmarks/goal"):
        mouse.pull(node, (0.02, 0.0, 0.0))
        chosen.append(desk.state().view.thing)

    assert chosen == ["box 1", "ball 1", "ball 1", ""]


# --- what the arm heeds -----------------------------------------------------------------------------------


def test_the_arm_keeps_off_what_stands_fixed_and_not_off_what_can_be_carried() -> None:
    document = furnished()
    heeded = conditions_of(learn(document), View()).obstacles

    assert [thing.name for thing in heeded] == ["crate"]


def test_while_a_thing_is_pulled_the_arm_heeds_it_where_it_is() -> None:
    desk = desk_of(with_thing("box"))
    mouse = Mouse(desk)
    mouse.press("/obstacles/box 1")
    mouse.move((0.2, 0.0, 0.0))

    assert desk.stage.arm.conditions.obstacles == desk.state().document.things


def test_the_post_of_an_obstacle_is_heeded() -> None:
    document = edits.add_landmark(taught(), "obstacle", Place("", taught=np.array([0.5, 0.1, 0.2])))
    model = learn(document)
    (heeded,) = conditions_of(model, View()).obstacles

    assert heeded == post(model.anchors[-1])
    assert underside(heeded) == pytest.approx(0.0)
    assert heeded.position[2] + 0.5 * heeded.length == pytest.approx(0.23)


def test_a_ring_is_heeded_unless_the_motion_leads_through_it() -> None:
    model = learn(taught())
    directrix = model.cylinder.directrix
    x, y, z = directrix[30]
    tangent = directrix[31] - directrix[29]
    yaw = float(np.arctan2(tangent[1], tangent[0]))
    around = Ring("ring", (x, y, z), 0.1, 0.01, wxyz=tuple(quaternion(np.array([0.0, np.pi / 2, yaw]))))
    aside = replace(around, position=(x, y + 0.5, z + 0.5))

    assert leads_through(directrix, around)
    assert not leads_through(directrix, aside)
    heeded = conditions_of(learn(replace(model.source, things=(around, aside))), View()).obstacles
    assert heeded == (aside,)


@pytest.fixture
def jaco() -> Iterator[Jaco]:
    arm = Jaco()
    yield arm
    arm.close()


def test_a_box_that_is_pulled_before_the_hand_stops_it_and_the_words_say_so(jaco: Jaco) -> None:
    desk = Desk(edits.add_thing(Document("Empty"), "box", (0.5, -0.5, 0.0)), jaco)
    document = edits.resize_thing(desk.store.document, "box 1", (0.1, 0.3, 0.5))
    desk = Desk(document, jaco)
    mouse = Mouse(desk)
    begin = desk.state().hand.position
    mouse.pull("/obstacles/box 1", (-0.25, 0.0, 0.0))
    mouse.press("/hand")
    for _ in range(10):
        mouse.move((0.025, 0.0, 0.0))
    for _ in range(8):
        mouse.wait(0.2)
        if (inquiry := desk.leading.inquiry) is not None:
            desk.leading.answered(inquiry, inquiry.answer(jaco), mouse.now)
    mouse.wait(0.1)
    state = desk.state()

    assert "box 1 is in the way" in state.message
    assert begin[0] + 0.02 < state.hand.position[0] < 0.2
    assert desk.stage.arm.clearance(state.hand.joints[None]).obstacles[0] > 0.0
