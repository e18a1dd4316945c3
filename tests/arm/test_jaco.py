"""The Jaco: facts of its model, random drags, the authors' demonstrations."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
import scipy.io

from app.arm import STUCK, FloatArray, Jaco, urdf
from app.arm.cache import prepared_folder
from app.arm.jaco import SHELL
from app.arm.programs import SAFE_DISTANCE

DATA = Path(os.environ.get("GC_TEACH_DATA", Path(__file__).parents[2] / ".." / "shared" / "data"))
ALPHA = DATA / "tlgc" / "alpha.mat"
STEP_BOUND = 3.0 * 0.01
STILL = 0.6e-3  # rad a tick: the joints creep at most
FINGER_TIPS = tuple(f"{urdf.PREFIX}link_finger_tip_{finger}" for finger in urdf.FINGERS)


def tip(jaco: Jaco, joints: FloatArray) -> FloatArray:
    return jaco.tool_pose(joints)[:3, 3]


def random_goal(rng: np.random.Generator, *, anywhere: bool) -> FloatArray:
    """A point in the shell, or any point up to 2.5 m from the shoulder."""
    direction = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    radius = rng.uniform(0.0, 2.5) if anywhere else rng.uniform(0.3, 0.9)
    point = np.asarray(SHELL.shoulder) + radius * direction
    return point if anywhere else SHELL.project(point)


def drag_and_hold(jaco: Jaco, goal: FloatArray, speed: float, hold: int) -> FloatArray:
    """Joints (T, 6) of a drag from home at a speed [m/s], then held for some ticks."""
    begin = tip(jaco, jaco.home)
    n_ticks = int(np.linalg.norm(goal - begin) / speed * 100) + 1
    joints = [jaco.home]
    for share in np.minimum(np.arange(1, n_ticks + hold + 1) / n_ticks, 1.0):
        joints.append(jaco.step(joints[-1], begin + share * (goal - begin), 0.01))
    return np.array(joints)


@pytest.fixture(scope="module")
def drags(jaco: Jaco) -> list[tuple[FloatArray, FloatArray]]:
    """Goal and joints of thirty random drags, each held for 3.5 s."""
    rng = np.random.default_rng(2002)
    goals = [random_goal(rng, anywhere=number % 2 == 1) for number in range(30)]
    speeds = (0.3, 0.8, 2.5)
    return [(goal, drag_and_hold(jaco, goal, speeds[i % 3], hold=320)) for i, goal in enumerate(goals)]


def test_the_tool_points_straight_down_in_front_at_home(jaco: Jaco) -> None:
    pose = jaco.tool_pose(jaco.home)

    np.testing.assert_allclose(pose[:3, 3], [0.010, -0.500, 0.250], atol=5e-4)
    np.testing.assert_allclose(pose[:3, 2], [0.0, 0.0, -1.0], atol=1e-3)


def test_endless_joints_count_their_turns(jaco: Jaco) -> None:
    turned = jaco.home + 2.0 * np.pi * np.array([3, 0, 0, -2, 0, 5])

    np.testing.assert_allclose(jaco.tool_pose(turned), jaco.tool_pose(jaco.home), atol=1e-9)
    np.testing.assert_allclose(
        jaco.step(turned, tip(jaco, turned), 0.01) - turned,
        jaco.step(jaco.home, tip(jaco, jaco.home), 0.01) - jaco.home,
        atol=1e-6,
    )


def test_the_first_joint_turns_the_arm_about_the_world_s_vertical(jaco: Jaco) -> None:
    x, y, z = tip(jaco, jaco.home)
    quarter = jaco.home + np.array([np.pi / 2, 0, 0, 0, 0, 0])

    np.testing.assert_allclose(abs(tip(jaco, quarter)), [abs(y), abs(x), z], atol=1e-6)


def test_kinova_s_limits_are_kept(jaco: Jaco) -> None:
    np.testing.assert_allclose(np.degrees(jaco.lower)[[1, 2, 4]], [47, 19, 30], atol=0.01)
    np.testing.assert_allclose(np.degrees(jaco.upper)[[1, 2, 4]], [313, 341, 330], atol=0.01)
    np.testing.assert_allclose(np.degrees(jaco.velocity_limits), [36, 36, 36, 48, 48, 48], atol=0.01)


def test_the_arm_is_light_enough_for_a_browser(jaco: Jaco) -> None:
    assert 10_000 < sum(len(mesh.faces) for mesh in jaco.link_meshes) < 17_000


def test_the_colours_are_upstream_s(jaco: Jaco) -> None:
    assert {(46, 46, 46), (160, 160, 160)} <= {mesh.color for mesh in jaco.link_meshes}


def test_the_drawn_arm_is_as_long_as_the_real_one(jaco: Jaco) -> None:
    poses = jaco.link_poses(jaco.home, 0.0)
    corners = [m.vertices @ poses[m.link][:3, :3].T + poses[m.link][:3, 3] for m in jaco.link_meshes]
    low, high = np.concatenate(corners).min(axis=0), np.concatenate(corners).max(axis=0)

    np.testing.assert_allclose(low[2], 0.0, atol=4e-3)
    assert low[1] < tip(jaco, jaco.home)[1] < high[1]


def test_finger_tips_meet_when_the_gripper_is_closed(jaco: Jaco) -> None:
    poses = jaco.link_poses(jaco.home, 1.0)
    one, two = (
        np.concatenate(
            [
                m.vertices @ poses[link][:3, :3].T + poses[link][:3, 3]
                for m in jaco.link_meshes
                if m.link == link
            ]
        )
        for link in FINGER_TIPS
    )
    gap = np.linalg.norm(one[:, None] - two[None], axis=2).min()

    assert gap < 5e-3


def test_no_drag_moves_a_joint_faster_than_allowed(drags: list[tuple[FloatArray, FloatArray]]) -> None:
    assert all(np.abs(np.diff(joints, axis=0)).max() <= STEP_BOUND + 1e-9 for _, joints in drags)


def test_no_drag_leaves_the_limits(jaco: Jaco, drags: list[tuple[FloatArray, FloatArray]]) -> None:
    assert all(np.all((jaco.lower <= joints) & (joints <= jaco.upper)) for _, joints in drags)


def test_no_drag_swings_on_after_three_seconds(drags: list[tuple[FloatArray, FloatArray]]) -> None:
    swings = [np.abs(np.diff(joints[-50:], axis=0)).max() for _, joints in drags]

    assert max(swings) < STILL


def test_a_drag_to_a_reachable_place_arrives(jaco: Jaco, drags: list[tuple[FloatArray, FloatArray]]) -> None:
    missed = [np.linalg.norm(tip(jaco, joints[-1]) - goal) for goal, joints in drags[::2]]

    assert max(missed) < 5e-3


def test_every_drag_that_does_not_arrive_has_a_reason(
    jaco: Jaco, drags: list[tuple[FloatArray, FloatArray]]
) -> None:
    fell_short = [
        (goal, joints[-1]) for goal, joints in drags if np.linalg.norm(tip(jaco, joints[-1]) - goal) > 5e-3
    ]
    reasons = [shortfall.reason for goal, last in fell_short if (shortfall := jaco.shortfall(last, goal))]

    assert len(fell_short) > 5
    assert len(reasons) == len(fell_short)
    assert all(reasons)


def test_the_arm_keeps_off_itself_while_it_is_dragged(
    jaco: Jaco, drags: list[tuple[FloatArray, FloatArray]]
) -> None:
    assert min(jaco.clearance(joints[::50]).itself.min() for _, joints in drags) > 0.8 * SAFE_DISTANCE


def test_a_hand_stopped_by_a_joint_s_limit_is_told_which(jaco: Jaco) -> None:
    opposite = np.array([0.068, -0.91, 0.05])
    joints = np.array([1.463, 5.463, 0.895, -0.022, 3.363, -0.984])
    for _ in range(100):
        joints = jaco.step(joints, opposite, 0.01)
    shortfall = jaco.shortfall(joints, opposite)

    assert shortfall is not None
    assert shortfall.stuck
    assert shortfall.reason == STUCK == "stuck: reposition the arm"
    assert shortfall.cause == "joint 2 at its limit"


@pytest.mark.skipif(
    not ALPHA.exists(), reason="the authors' alpha.mat is not in ../shared/data (or GC_TEACH_DATA)"
)
def test_the_authors_demonstrations_are_reached_within_a_millimetre(jaco: Jaco) -> None:
    for positions in scipy.io.loadmat(ALPHA)["smoothData"][0]:
        path = jaco.follow(positions[::5])

        assert path.errors.max() < 1e-3
        assert np.abs(np.diff(path.joints, axis=0)).max() < 0.1
        assert np.all((jaco.lower <= path.joints) & (path.joints <= jaco.upper))


def test_a_path_out_of_reach_is_followed_as_far_as_the_arm_goes(jaco: Jaco) -> None:
    positions = np.linspace([0.0, -0.5, 0.3], [0.0, -1.4, 0.3], 80)
    path = jaco.follow(positions)
    beyond = np.linalg.norm(positions - np.asarray(SHELL.shoulder), axis=1) - SHELL.outer

    np.testing.assert_allclose(path.errors, np.maximum(beyond, 0.0), atol=2e-3)
    assert np.abs(np.diff(path.joints, axis=0)).max() < 0.3


def test_random_paths_are_reached_without_touching_the_arm_itself(jaco: Jaco) -> None:
    rng = np.random.default_rng(4242)
    for _ in range(5):
        corners = np.array([random_goal(rng, anywhere=False) for _ in range(3)])
        corners = SHELL.project(np.abs(corners) * [1.0, -1.0, 1.0])
        share = np.linspace(0.0, 1.0, 150)[:, None]
        positions = (
            (1 - share) ** 2 * corners[0] + 2 * share * (1 - share) * corners[1] + share**2 * corners[2]
        )
        path = jaco.follow(SHELL.project(positions))

        assert path.errors.max() < 1e-3
        assert jaco.clearance(path.joints).itself.min() > 0.0


def test_the_cleaned_description_collides_as_boxes_and_draws_nothing() -> None:
    root = ET.parse(prepared_folder() / urdf.ROBOT_FILE).getroot()

    assert len(root.findall("link/collision/geometry/box")) == 11
    assert not root.findall(".//mesh")
    assert {joint.get("type") for joint in root.findall("joint")} == {"fixed", "revolute"}


def test_no_pair_of_neighbours_is_checked_for_collision() -> None:
    neighbours = {(f"{urdf.PREFIX}link_{n}", f"{urdf.PREFIX}link_{n + 1}") for n in range(1, 6)}

    assert len(urdf.self_collision_pairs()) == 26
    assert not neighbours & set(urdf.self_collision_pairs())
