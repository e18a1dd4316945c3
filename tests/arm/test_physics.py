"""Physics: distances that agree with the kinematic ones, playback, contact, pick and place."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from app.arm import ArmClosedError, ArmInputError, ArmModelError, FloatArray, Jaco
from app.arm.conditions import Conditions
from app.arm.physics import World
from app.arm.physics_engine import engine
from app.arm.physics_playback import GRASP_REACH, StartsInsideError, play
from app.arm.physics_report import Distances, encounters
from app.arm.shapes import Box, Cylinder, Ring, Shape, Sphere
from tests.arm.physical import kinematic_distances, swing

pytest.importorskip("pybullet", reason="pybullet is not installed (the extra `physics`)")

AGREED = 0.005
TURNED = (math.cos(0.3), math.sin(0.3), 0.0, 0.0)
SHAPES = [
    Sphere("ball", (0.1, -0.45, 0.3), 0.06),
    Box("box", (-0.1, -0.4, 0.3), (0.12, 0.1, 0.2), wxyz=TURNED),
    Cylinder("can", (0.0, -0.5, 0.2), 0.05, 0.25, wxyz=TURNED),
    Ring("ring", (0.1, -0.45, 0.35), 0.1, 0.01, wxyz=TURNED),
]


def path_of(jaco: Jaco) -> tuple[FloatArray, FloatArray, FloatArray]:
    times, places, middle = swing()
    return times, jaco.follow(places, jaco.home).joints, middle


def pick_and_place(jaco: Jaco, height: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Times, joints, gripper and the goal of: down, close, up, over, down, open, up."""
    above, goal = np.array([-0.1, -0.5, 0.25]), np.array([0.15, -0.45, height])
    corners = [above, [-0.1, -0.5, height], above, [0.15, -0.45, 0.25], goal, [0.15, -0.45, 0.25]]
    share = np.linspace(0.0, 1.0, 100)[:, None]
    legs = [(1 - share) * np.asarray(a) + share * np.asarray(b) for a, b in pairwise(corners)]
    joints = jaco.follow(np.concatenate(legs), jaco.home).joints
    gripper = np.repeat([0.0, 1.0, 1.0, 1.0, 0.0], len(share))
    return 0.02 * np.arange(len(joints)), joints, gripper, goal


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.name)
def test_physics_and_kinematics_measure_the_same_distances(jaco: Jaco, shape: Shape) -> None:
    rng = np.random.default_rng(5)
    postures = np.clip(jaco.home + 0.4 * rng.normal(size=(40, 6)), jaco.lower, jaco.upper)
    with World([shape]) as world:
        measured = world.clearance(postures)
    expected = [kinematic_distances(jaco, posture, shape) for posture in postures]

    assert measured.distances.min() < 0.0 < measured.distances.max()
    for distances, known in zip(measured.distances[:, :, 0], expected, strict=True):
        np.testing.assert_allclose(distances, [known[link] for link in measured.links], atol=AGREED)


def test_the_arm_s_own_clearance_is_the_one_of_physics(jaco: Jaco) -> None:
    _, joints, _ = path_of(jaco)
    with World(SHAPES) as world:
        measured = world.clearance(joints[::5])
    own = jaco.under(Conditions(obstacles=tuple(SHAPES))).clearance(joints[::5])

    np.testing.assert_allclose(measured.distances.min(axis=(1, 2)), own.obstacles, atol=AGREED)


def test_a_path_led_through_an_obstacle_is_told_with_link_time_and_depth(jaco: Jaco) -> None:
    times, joints, middle = path_of(jaco)
    ball = Sphere("ball", (float(middle[0]), float(middle[1]), float(middle[2])), 0.03)
    with World([ball]) as world:
        found = encounters(world.clearance(joints), times)
    known = [kinematic_distances(jaco, posture, ball) for posture in joints]

    assert found
    for encounter in found:
        at = int(np.searchsorted(times, encounter.deepest))
        assert encounter.begins <= encounter.deepest <= encounter.ends
        assert abs(known[at][encounter.link] + encounter.depth) < AGREED
    assert {link for row in known for link, distance in row.items() if distance < -AGREED} <= {
        encounter.link for encounter in found
    }


def test_a_path_that_keeps_clear_meets_nothing(jaco: Jaco) -> None:
    times, joints, _ = path_of(jaco)
    with World([Box("box", (0.0, 0.6, 0.2), (0.2, 0.2, 0.4))]) as world:
        clearance = world.clearance(joints)

    assert encounters(clearance, times) == ()
    assert clearance.nearest is not None
    assert clearance.nearest.distance == clearance.distances.min() > 0.0


def test_one_stay_ends_where_the_link_comes_out_and_a_second_one_is_told_again() -> None:
    along = np.array([0.1, -0.01, -0.03, 0.02, -0.02, 0.1])
    found = encounters(Distances(("hand",), ("box",), along[:, None, None]), np.arange(6.0))

    assert [(stay.begins, stay.deepest, stay.ends) for stay in found] == [(1.0, 2.0, 2.0), (4.0, 4.0, 4.0)]
    np.testing.assert_allclose([stay.depth for stay in found], [0.03, 0.02])


def test_within_its_limits_the_arm_follows_to_a_tenth_of_a_millimetre(jaco: Jaco) -> None:
    times, joints, _ = path_of(jaco)
    with World() as world:
        slow = play(world, 2.0 * times, joints)

    assert slow.errors.max() < 1e-4
    assert slow.speed_shares.max() <= 1.0
    assert slow.torque_shares.max() < 1.0
    assert slow.contacts == ()


def test_too_fast_a_path_is_left_behind_at_the_speed_limit(jaco: Jaco) -> None:
    times, joints, _ = path_of(jaco)
    with World() as world:
        fast = play(world, times / 3.0, joints)

    assert fast.errors.max() > 0.05
    assert 0.99 < fast.speed_shares.max() < 1.05


def test_with_too_little_torque_the_arm_sags(jaco: Jaco) -> None:
    times, joints, _ = path_of(jaco)
    with World() as world:
        weak = play(world, 2.0 * times, joints, effort=0.1)

    assert weak.errors.max() > 0.05
    assert weak.torque_shares.max() <= 0.1 + 1e-6


def test_the_arm_is_stopped_by_what_stands_in_its_way(jaco: Jaco) -> None:
    times, joints, middle = path_of(jaco)
    ball = Sphere("ball", (float(middle[0]), float(middle[1]), float(middle[2])), 0.06)
    with World([ball]) as world:
        led = encounters(world.clearance(joints), 2.0 * times)
        played = play(world, 2.0 * times, joints)

    assert {contact.object for contact in played.contacts} == {"ball"}
    assert played.contacts[0].link == led[0].link
    assert abs(played.contacts[0].begins - led[0].begins) < 0.05
    assert played.contacts[0].force > 1.0
    assert max(contact.depth for contact in played.contacts) < AGREED
    assert played.errors.max() > 0.02


@pytest.mark.parametrize(
    ("thing", "height"),
    [
        (Box("brick", (-0.1, -0.5, 0.03), (0.04, 0.04, 0.06), mass=0.2), 0.05),
        (Sphere("ball", (-0.1, -0.5, 0.03), 0.03, mass=0.2), 0.05),
        (Cylinder("can", (-0.1, -0.5, 0.05), 0.03, 0.1, mass=0.3), 0.08),
    ],
    ids=["brick", "ball", "can"],
)
def test_a_thing_is_picked_where_the_gripper_closes_and_placed_where_it_opens(
    jaco: Jaco, thing: Shape, height: float
) -> None:
    times, joints, gripper, goal = pick_and_place(jaco, height)
    with World([thing], table=0.0) as world:
        played = play(world, times, joints, gripper)
    way = played.objects[thing.name][:, :3, 3]

    assert [held.object for held in played.carried] == [thing.name]
    assert played.carried[0].released is not None
    assert way[:, 2].max() > thing.position[2] + 0.15
    np.testing.assert_allclose(way[-1, :2], goal[:2], atol=0.005)
    np.testing.assert_allclose(way[-1, 2], thing.position[2], atol=0.005)


def test_a_thing_too_far_from_the_grip_stays_where_it_is(jaco: Jaco) -> None:
    times, joints, gripper, _ = pick_and_place(jaco, 0.05)
    aside = Sphere("ball", (-0.1, -0.5 + 0.03 + 2.0 * GRASP_REACH, 0.03), 0.03, mass=0.2)
    with World([aside], table=0.0) as world:
        played = play(world, times, joints, gripper)

    assert played.carried == ()
    assert np.ptp(played.objects["ball"][:, 2, 3]) < 0.005


def test_what_is_held_at_the_end_is_told_so(jaco: Jaco) -> None:
    times, joints, gripper, _ = pick_and_place(jaco, 0.05)
    half = len(times) // 2
    with World([Sphere("ball", (-0.1, -0.5, 0.03), 0.03, mass=0.2)], table=0.0) as world:
        played = play(world, times[:half], joints[:half], gripper[:half])

    assert [held.released for held in played.carried] == [None]


def test_a_path_that_begins_in_a_thing_is_not_played(jaco: Jaco) -> None:
    times, joints, _ = path_of(jaco)
    x, y, z = jaco.tool_pose(joints[0])[:3, 3].tolist()
    with World([Box("box", (x, y, z), (0.1, 0.1, 0.1))]) as world, pytest.raises(StartsInsideError) as caught:
        play(world, times, joints)

    assert caught.value.object == "box"
    assert caught.value.depth > 0.01


def test_an_error_inside_closes_the_world() -> None:
    with pytest.raises(KeyError), World() as world:
        raise KeyError

    with pytest.raises(ArmClosedError):
        world.tool_position()


def free_client() -> int:
    """The number that the next world would get."""
    number = engine().connect(engine().DIRECT)
    engine().disconnect(number)
    return number


def test_a_world_leaves_no_client_behind_even_if_it_cannot_be_filled(tmp_path: Path) -> None:
    before = free_client()
    with World():
        assert free_client() != before
    with pytest.raises(ArmModelError), World(folder=tmp_path):
        pass

    assert free_client() == before


def test_a_closed_world_is_not_used_and_may_be_closed_again(jaco: Jaco) -> None:
    with World() as world:
        pass
    world.close()

    with pytest.raises(ArmClosedError):
        world.clearance(jaco.home[None])


def test_two_things_of_one_name_are_refused() -> None:
    with pytest.raises(ArmInputError, match="names"):
        World([Sphere("a", (0.0, 0.0, 1.0), 0.1), Sphere("a", (0.0, 0.0, 2.0), 0.1)])


@pytest.mark.parametrize("times", [[0.0, 0.0], [1.0, 0.0], [0.0], [0.0, math.nan]])
def test_times_that_do_not_increase_are_refused(jaco: Jaco, times: list[float]) -> None:
    with World() as world, pytest.raises(ArmInputError, match="times"):
        play(world, times, np.repeat(jaco.home[None], 2, axis=0))
