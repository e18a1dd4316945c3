"""What every arm promises, whichever it is."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.arm import HERE, Arm, ArmClosedError, ArmInputError, FloatArray, Jaco, PlanarArm

FASTEST = 3.0  # rad/s, the bound of both arms
FAR = st.floats(-3.0, 3.0)
shared_arm = settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=25, deadline=None
)


def tip(arm: Arm, joints: FloatArray) -> FloatArray:
    return arm.tool_pose(joints)[:3, 3]


def drag(arm: Arm, joints: FloatArray, target: FloatArray, ticks: int) -> list[FloatArray]:
    way = [joints]
    for _ in range(ticks):
        way.append(arm.step(way[-1], target, 0.01))
    return way


def circle(arm: Arm, n_points: int) -> FloatArray:
    angle = np.linspace(0.0, 2.0 * math.pi, n_points)
    offsets = 0.08 * np.stack([np.cos(angle) - 1.0, np.sin(angle), 0.5 * np.sin(angle)], axis=1)
    return tip(arm, arm.home) + offsets


def test_home_is_within_the_limits(arm: Arm) -> None:
    assert np.all((arm.lower <= arm.home) & (arm.home <= arm.upper))


def test_every_joint_has_a_name_and_a_speed(arm: Arm) -> None:
    assert len(arm.joint_names) == len(arm.home) == len(arm.velocity_limits)
    assert np.all(arm.velocity_limits > 0.0)


def test_every_mesh_hangs_on_a_link_that_has_a_pose(arm: Arm) -> None:
    assert {mesh.link for mesh in arm.link_meshes} == set(arm.link_poses(arm.home, 0.0))


def test_faces_name_existing_corners(arm: Arm) -> None:
    assert all(mesh.faces.max() < len(mesh.vertices) for mesh in arm.link_meshes)


def test_meshes_are_what_a_browser_draws(arm: Arm) -> None:
    kinds = {(mesh.vertices.dtype.name, mesh.faces.dtype.name) for mesh in arm.link_meshes}

    assert kinds == {("float32", "uint32")}


def test_closing_the_gripper_brings_the_fingers_together_and_moves_nothing_else(arm: Arm) -> None:
    opened, closed = arm.link_poses(arm.home, 0.0), arm.link_poses(arm.home, 1.0)
    moved = {link for link, pose in opened.items() if not np.array_equal(pose, closed[link])}

    def spread(poses: dict[str, FloatArray]) -> float:
        corners = np.concatenate(
            [
                m.vertices @ poses[m.link][:3, :3].T + poses[m.link][:3, 3]
                for m in arm.link_meshes
                if m.link in moved
            ]
        )
        return float(np.ptp(corners, axis=0).max())

    assert spread(dict(closed)) < spread(dict(opened))
    assert all("finger" in link or "jaw" in link for link in moved)


@shared_arm
@given(shift=st.tuples(FAR, FAR, FAR))
def test_poses_are_rigid(arm: Arm, shift: tuple[float, float, float]) -> None:
    joints = arm.home + 0.2 * np.resize(shift, len(arm.home))
    poses = np.stack([arm.tool_pose(joints), *arm.link_poses(joints, 0.5).values()])
    rotations = poses[:, :3, :3]

    np.testing.assert_allclose(
        rotations @ rotations.swapaxes(1, 2), np.broadcast_to(np.eye(3), rotations.shape), atol=1e-6
    )
    np.testing.assert_allclose(np.linalg.det(rotations), 1.0, atol=1e-6)


@shared_arm
@given(x=FAR, y=FAR, z=FAR, dt=st.sampled_from([0.005, 0.01, 0.02, 0.05]))
def test_a_step_is_bounded_and_within_the_limits_wherever_the_hand_is_pulled(
    arm: Arm, x: float, y: float, z: float, dt: float
) -> None:
    joints = arm.home
    for _ in range(30):
        after = arm.step(joints, np.array([x, y, z]), dt)
        assert np.abs(after - joints).max() <= FASTEST * dt + 1e-9
        assert np.all((arm.lower - 1e-9 <= after) & (after <= arm.upper + 1e-9))
        joints = after


@shared_arm
@given(x=st.floats(-0.25, 0.25), y=st.floats(-0.2, 0.2), z=st.floats(-0.15, 0.3))
def test_the_hand_arrives_where_it_is_pulled(arm: Arm, x: float, y: float, z: float) -> None:
    target = tip(arm, arm.home) + np.array([x, y, z])
    joints = drag(arm, arm.home, target, 150)[-1]

    assert np.linalg.norm(tip(arm, joints) - target) < 1e-3
    assert arm.shortfall(joints, target) is None


def test_calls_in_between_do_not_change_an_answer(arm: Arm) -> None:
    target = tip(arm, arm.home) + np.array([0.1, 0.05, 0.02])
    before = arm.step(arm.home, target, 0.01)
    arm.follow(circle(arm, 20))
    arm.step(before, -target, 0.02)
    arm.tool_pose(before)

    np.testing.assert_array_equal(arm.step(arm.home, target, 0.01), before)


def test_two_arms_do_not_disturb_each_other(arm: Arm) -> None:
    other = type(arm)()
    target = tip(arm, arm.home) + np.array([0.1, 0.05, 0.02])
    alone = drag(arm, arm.home, target, 20)[-1]
    joints = arm.home
    for _ in range(20):
        joints = arm.step(joints, target, 0.01)
        other.step(other.home, -target, 0.01)
    other.close()

    np.testing.assert_array_equal(joints, alone)


def test_arguments_are_left_as_they_were(arm: Arm) -> None:
    joints, target = arm.home + 0.1, tip(arm, arm.home) - np.array([0.0, 0.0, 5.0])
    kept = joints.copy(), target.copy()
    arm.step(joints, target, 0.01)
    arm.follow(target[None], joints)
    arm.shortfall(joints, target)

    np.testing.assert_array_equal(joints, kept[0])
    np.testing.assert_array_equal(target, kept[1])


def test_a_path_is_followed_without_jumps(arm: Arm) -> None:
    path = arm.follow(circle(arm, 300))

    assert path.errors.max() < 1e-3
    assert np.abs(np.diff(path.joints, axis=0)).max() < 0.05


def test_a_path_s_errors_are_the_distances_to_the_wanted_positions(arm: Arm) -> None:
    positions = circle(arm, 30) + np.linspace([0.0, 0.0, 0.0], [0.0, -1.5, 0.0], 30)
    path = arm.follow(positions)
    tips = np.array([tip(arm, joints) for joints in path.joints])

    np.testing.assert_allclose(path.errors, np.linalg.norm(tips - positions, axis=1), atol=1e-9)


def test_a_path_begins_near_the_given_joints(arm: Arm) -> None:
    positions = circle(arm, 50)
    start = arm.follow(positions).joints[0]
    start[0] += 2.0 * math.pi

    assert np.abs(arm.follow(positions, start).joints[0] - start).max() < 0.1


def test_one_position_is_a_path(arm: Arm) -> None:
    path = arm.follow(tip(arm, arm.home)[None])

    assert path.joints.shape == (1, len(arm.home))
    assert path.errors[0] < 1e-3


@pytest.mark.parametrize(
    ("target", "words"),
    [
        ((0.0, -2.0, 0.3), "beyond reach"),
        ((0.1, -0.5, -0.3), "below the table"),
        ((0.005, 0.0, 0.28), "own base"),
    ],
)
def test_what_cannot_be_reached_gets_a_reason(
    arm: Arm, target: tuple[float, float, float], words: str
) -> None:
    joints = drag(arm, arm.home, np.array(target), 300)[-1]
    shortfall = arm.shortfall(joints, np.array(target))

    assert shortfall is not None
    assert words in shortfall.reason
    assert shortfall.distance == pytest.approx(np.linalg.norm(tip(arm, joints) - target))
    assert shortfall.distance > HERE


def test_what_a_path_wants_beyond_reach_is_said_of_its_worst_place(arm: Arm) -> None:
    near = circle(arm, 20)
    away = np.array([[0.0, -5.0, 0.3], [0.0, -9.0, 0.3]])

    assert arm.unreachable(near) is None
    assert arm.unreachable(np.vstack([near, away])) == arm.unreachable(away[1:])
    assert "beyond reach" in arm.unreachable(away)


def test_an_arm_that_still_moves_says_so(arm: Arm) -> None:
    shortfall = arm.shortfall(arm.home, tip(arm, arm.home) + np.array([0.1, 0.05, 0.1]))

    assert shortfall is not None
    assert shortfall.reason == "still on its way"


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_numbers_that_are_none_are_refused(arm: Arm, bad: float) -> None:
    with pytest.raises(ArmInputError, match="finite"):
        arm.step(arm.home, np.array([0.1, bad, 0.2]), 0.01)
    with pytest.raises(ArmInputError, match="finite"):
        arm.follow(np.array([[0.1, bad, 0.2]]))
    with pytest.raises(ArmInputError, match="finite"):
        arm.tool_pose(np.full_like(arm.home, bad))
    with pytest.raises(ArmInputError, match="gripper"):
        arm.link_poses(arm.home, bad)
    with pytest.raises(ArmInputError, match="seconds"):
        arm.step(arm.home, np.zeros(3), bad)


def test_wrong_shapes_are_refused(arm: Arm) -> None:
    with pytest.raises(ArmInputError, match="shape"):
        arm.step(arm.home[:2], np.zeros(3), 0.01)
    with pytest.raises(ArmInputError, match="shape"):
        arm.shortfall(arm.home, np.zeros(2))
    with pytest.raises(ArmInputError, match="K >= 1"):
        arm.follow(np.empty((0, 3)))


@pytest.mark.parametrize("kind", [Jaco, PlanarArm])
def test_a_closed_arm_refuses_to_work(kind: type[Jaco] | type[PlanarArm]) -> None:
    arm = kind()
    arm.close()
    arm.close()

    with pytest.raises(ArmClosedError, match="Open a new one"):
        arm.step(arm.home, np.zeros(3), 0.01)
