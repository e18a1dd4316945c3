"""Obstacles and a locked tool: kept off, kept, and named when they stop the hand."""

from __future__ import annotations

import numpy as np
import pytest

from app.arm import FREE, HERE, ArmClosedError, ArmInputError, Conditions, FloatArray, Jaco, urdf
from app.arm.physics_words import length_in_words, thing_in_words
from app.arm.programs import SAFE_DISTANCE
from app.arm.shapes import Box, Cylinder, Ring, Shape, Sphere, primitives
from app.arm.verdict import judge

BOX = Box("the box", (0.0, -0.5, 0.1), (0.12, 0.12, 0.2))
AROUND = [
    BOX,
    Sphere("the ball", (-0.2, -0.5, 0.3), 0.08),
    Cylinder("the post", (0.2, -0.45, 0.2), 0.04, 0.4),
    Ring("the ring", (0.25, -0.4, 0.3), 0.1, 0.015),
]
RIGHT = np.array([0.4, -0.3, 0.45])


def tip(arm: Jaco, joints: FloatArray) -> FloatArray:
    return arm.tool_pose(joints)[:3, 3]


def pull(arm: Jaco, joints: FloatArray, target: FloatArray, ticks: int = 350) -> FloatArray:
    """Joints (T, 6) of a pull at 0.5 m/s, then held."""
    begin = tip(arm, joints)
    n_ticks = int(np.linalg.norm(target - begin) / 0.5 * 100) + 1
    way = [joints]
    for share in np.minimum(np.arange(1, n_ticks + ticks) / n_ticks, 1.0):
        way.append(arm.step(way[-1], begin + share * (target - begin), 0.01))
    return np.array(way)


@pytest.fixture(scope="module")
def right(jaco: Jaco) -> FloatArray:
    """Joints beside all obstacles."""
    return jaco.follow(RIGHT[None]).joints[0]


@pytest.mark.parametrize("shape", AROUND[:3], ids=lambda shape: shape.name)
def test_a_hand_pulled_into_an_obstacle_stops_before_it_and_is_told(
    jaco: Jaco, right: FloatArray, shape: Shape
) -> None:
    arm = jaco.under(Conditions((shape,)))
    inside = np.array(shape.position)
    way = pull(arm, right, inside)
    shortfall = arm.shortfall(way[-1], inside)

    assert arm.clearance(way).obstacles.min() > 0.5 * SAFE_DISTANCE
    assert np.abs(np.diff(way, axis=0)).max() <= 0.03 + 1e-9
    assert np.abs(np.diff(way[-50:], axis=0)).max() < 1e-3
    assert shortfall is not None
    assert shortfall.reason == f"{thing_in_words(shape.name)} is in the way"


def test_open_fingers_stand_round_a_thin_ring_without_touching_it(jaco: Jaco, right: FloatArray) -> None:
    ring = AROUND[3]
    arm = jaco.under(Conditions((ring,)))
    wall = np.array(ring.position) + primitives(ring)[0].pose[:3, 3]
    way = pull(arm, right, wall)

    assert np.linalg.norm(tip(arm, way[-1]) - wall) < HERE
    assert arm.clearance(way).obstacles.min() > 0.5 * SAFE_DISTANCE


def test_without_the_obstacle_the_same_pull_arrives(jaco: Jaco, right: FloatArray) -> None:
    target = np.array(BOX.position) + np.array([0.0, 0.0, 0.05])

    assert np.linalg.norm(tip(jaco, pull(jaco, right, target)[-1]) - target) < 1e-3


@pytest.mark.parametrize("x", [0.3, -0.3])
def test_a_sphere_s_distance_is_that_to_the_nearest_link(jaco: Jaco, x: float) -> None:
    radius, centre = 0.05, np.array([x, -0.5, 0.25])
    arm = jaco.under(Conditions((Sphere("ball", (x, -0.5, 0.25), radius),)))
    larger = jaco.under(Conditions((Sphere("ball", (x, -0.5, 0.25), 2 * radius),)))
    found = arm.clearance(jaco.home[None])

    assert found.names == ("ball",)
    assert found.obstacles[0] < np.linalg.norm(tip(jaco, jaco.home) - centre)
    np.testing.assert_allclose(
        larger.clearance(jaco.home[None]).obstacles, found.obstacles - radius, atol=1e-6
    )


def test_an_obstacle_far_away_changes_nothing(jaco: Jaco) -> None:
    far = jaco.under(Conditions((Box("a wall", (5.0, 0.0, 0.0), (0.1, 5.0, 5.0)),)))
    target = tip(jaco, jaco.home) + np.array([0.1, 0.05, 0.1])

    np.testing.assert_array_equal(far.step(jaco.home, target), jaco.step(jaco.home, target))


def test_obstacles_of_one_view_are_not_those_of_another(jaco: Jaco) -> None:
    boxed = jaco.under(Conditions((BOX,)))
    boxed.clearance(jaco.home[None])

    assert jaco.clearance(jaco.home[None]).obstacles[0] == np.inf
    assert boxed.clearance(jaco.home[None]).obstacles[0] < 1.0
    assert jaco.conditions is FREE


def test_without_obstacles_there_are_no_names(jaco: Jaco) -> None:
    found = jaco.clearance(np.stack([jaco.home, jaco.home]))

    assert found.names == found.links == ("", "")


def test_a_path_goes_round_an_obstacle_with_the_whole_arm(jaco: Jaco) -> None:
    positions = np.linspace([0.3, -0.55, 0.25], [-0.3, -0.55, 0.25], 150)
    elbow = jaco.link_poses(jaco.follow(positions).joints[75], 0.0)[f"{urdf.PREFIX}link_3"][:3, 3]
    x, y, z = elbow.tolist()
    arm = jaco.under(Conditions((Sphere("a lamp", (x, y, z), 0.04),)))
    path = arm.follow(positions)

    assert path.errors.max() < 1e-3
    assert arm.clearance(path.joints).obstacles.min() > 0.0
    assert arm.clearance(jaco.follow(positions).joints).obstacles.min() < 0.0


def test_a_path_through_an_obstacle_is_a_problem_with_name_place_and_depth(jaco: Jaco) -> None:
    positions = np.linspace([0.3, -0.5, 0.1], [-0.3, -0.5, 0.1], 150)
    verdict = judge(jaco.under(Conditions((BOX,))), positions, np.linspace(0.0, 20.0, 150))
    (problem,) = [each for each in verdict.problems if each.kind == "thing"]

    assert verdict.clearance < 0.0
    assert 0 < problem.first < 75 < problem.last < 149
    assert verdict.nearest is not None
    assert (problem.worst, problem.first <= problem.worst <= problem.last) == (verdict.nearest.index, True)
    assert problem.what.endswith(f"would be up to {length_in_words(-verdict.clearance)} deep in the box")


def test_a_locked_tool_keeps_its_orientation_while_the_hand_is_pulled(jaco: Jaco) -> None:
    upright = (0.0, 1.0, 0.0, 0.0)
    arm = jaco.under(Conditions(orientation=upright))
    target = tip(jaco, jaco.home) + np.array([0.15, 0.05, 0.1])
    pose = arm.tool_pose(pull(arm, jaco.home, target)[-1])

    np.testing.assert_allclose(pose[:3, 3], target, atol=1e-3)
    np.testing.assert_allclose(pose[:3, :3], np.diag([1.0, -1.0, -1.0]), atol=0.01)


def test_a_locked_tool_can_be_turned_by_another_lock(jaco: Jaco) -> None:
    target = tip(jaco, jaco.home)
    half = np.radians(20.0)
    arm = jaco.under(Conditions(orientation=(0.0, float(np.cos(half)), float(np.sin(half)), 0.0)))
    turned = arm.tool_pose(pull(arm, jaco.home, target + np.array([0.0, 0.0, 0.01]), 500)[-1])

    np.testing.assert_allclose(turned[:3, 0], [np.cos(2 * half), np.sin(2 * half), 0.0], atol=0.02)


def test_a_hand_that_only_the_lock_keeps_away_is_told_so(jaco: Jaco) -> None:
    arm = jaco.under(Conditions(orientation=(0.0, 1.0, 0.0, 0.0)))
    high = np.array([0.0, -0.3, 1.1])
    shortfall = arm.shortfall(pull(arm, jaco.home, high, 600)[-1], high)

    assert shortfall is not None
    assert shortfall.reason == "the tool is held: let it turn freely"


def test_a_view_is_closed_with_its_arm() -> None:
    arm = Jaco()
    view = arm.under(Conditions((BOX,)))
    arm.close()

    with pytest.raises(ArmClosedError):
        view.step(view.home, np.zeros(3))


@pytest.mark.parametrize("bad", [(0.0, 0.0, 0.0, 0.0), (np.nan, 0.0, 0.0, 1.0)])
def test_an_orientation_that_is_none_is_refused(bad: tuple[float, float, float, float]) -> None:
    with pytest.raises(ArmInputError, match="orientation"):
        Conditions(orientation=bad)


@pytest.mark.parametrize("bad", [np.zeros(6), np.empty((0, 6)), np.full((2, 6), np.nan), np.zeros((2, 5))])
def test_configurations_of_the_wrong_shape_are_refused(jaco: Jaco, bad: FloatArray) -> None:
    with pytest.raises(ArmInputError):
        jaco.clearance(bad)
