"""The arm under many random drags and paths: no jumps, no swings, no lies."""

from __future__ import annotations

import secrets
from pathlib import Path

import numpy as np
import pytest

from app.arm import HERE, STUCK, FloatArray, Jaco
from app.arm.postures import reaching
from app.arm.programs import SAFE_DISTANCE
from app.arm.timing import retime, too_fast
from app.files import read
from app.servo import FASTEST, reposition
from tests.arm.campaign import SHOULDER, TICK, Drag, drags, random_path, somewhere
from tests.helpers_data import DATA

SEED = 51
SWING = 1e-4
"""Nobody sees a joint go to and fro by this in a tick [rad]."""
SKILLS = sorted((Path(__file__).parents[2] / "static" / "skills").glob("*.csv"))
ALPHA = DATA / "tlgc" / "alpha.mat"


@pytest.fixture(scope="module")
def campaign(jaco: Jaco) -> list[Drag]:
    """100 random drags at 0.3 to 2.5 m/s, half of them to any place up to 2.5 m away."""
    return drags(jaco, SEED, 100)


def check_drags(jaco: Jaco, found: list[Drag]) -> None:
    """What holds for every campaign, whatever its seed."""
    assert max(each.largest_step for each in found) <= FASTEST * TICK + 1e-9
    assert max(each.swings for each in found) < SWING
    assert np.mean([each.settled <= 1.0 for each in found]) >= 0.97
    for each in found:
        check_reason(jaco, each)


def check_reason(jaco: Jaco, drag: Drag) -> None:
    """A hand that is not there has a reason, and none that another posture belies."""
    shortfall = jaco.shortfall(drag.joints, drag.goal)
    if drag.distance <= HERE:
        assert shortfall is None
        return
    assert shortfall is not None
    assert shortfall.reason not in ("", "still on its way"), drag.goal
    reached = any(not touched for _, touched in reaching(jaco._use(), drag.goal, jaco.home))
    if shortfall.reason != "below the table":
        assert shortfall.stuck == reached, (drag.goal, shortfall)


def test_no_joint_is_faster_than_the_bound(campaign: list[Drag]) -> None:
    assert max(each.largest_step for each in campaign) <= FASTEST * TICK + 1e-9


def test_nothing_swings_three_seconds_after_the_pointer_rests(campaign: list[Drag]) -> None:
    assert max(each.swings for each in campaign) < SWING


def test_the_arm_settles_within_a_second(campaign: list[Drag]) -> None:
    assert np.mean([each.settled <= 1.0 for each in campaign]) >= 0.97


def test_every_place_within_reach_is_reached(campaign: list[Drag]) -> None:
    assert max(each.distance for each in campaign[::2]) < HERE


def test_every_hand_that_is_not_there_has_an_honest_reason(jaco: Jaco, campaign: list[Drag]) -> None:
    assert sum(each.distance > HERE for each in campaign) > 20
    for each in campaign:
        check_reason(jaco, each)


def check_repositioned(jaco: Jaco, joints: FloatArray, target: FloatArray) -> None:
    motion = reposition(jaco, joints, target)

    assert motion is not None, target
    steps = np.abs(np.diff(np.vstack([joints, motion.joints]), axis=0))
    assert np.linalg.norm(motion.positions[-1] - target) <= HERE
    assert steps.max() <= FASTEST * TICK + 1e-9
    at_first = jaco.clearance(joints[None]).itself[0]
    assert jaco.clearance(motion.joints[::4]).itself.min() >= min(0.3 * SAFE_DISTANCE, at_first - 1e-3)


def test_a_stuck_hand_is_brought_there_by_one_call(jaco: Jaco) -> None:
    opposite = np.array([0.068, -0.91, 0.05])
    joints = np.array([1.463, 5.463, 0.895, -0.022, 3.363, -0.984])
    for _ in range(100):
        joints = jaco.step(joints, opposite, TICK)
    shortfall = jaco.shortfall(joints, opposite)

    assert shortfall is not None
    assert shortfall.reason == STUCK
    check_repositioned(jaco, joints, opposite)


def test_the_arm_is_repositioned_from_anywhere_to_anywhere(jaco: Jaco) -> None:
    rng = np.random.default_rng(SEED)
    for _ in range(8):
        check_repositioned(jaco, jaco.follow(somewhere(rng)[None]).joints[0], somewhere(rng))


def test_nobody_is_repositioned_to_where_no_posture_reaches(jaco: Jaco) -> None:
    inside = SHOULDER + np.array([0.0, 0.0, 0.01])

    assert reposition(jaco, jaco.home, inside) is None


def check_path(jaco: Jaco, positions: FloatArray, largest_step: float) -> None:
    """Reached, continuous, clear of itself, within limits once it is timed."""
    path = jaco.follow(positions)
    timed = retime(path.joints, jaco.velocity_limits, jaco.acceleration_limits)

    assert path.errors.max() <= 1e-3
    assert np.abs(np.diff(path.joints, axis=0)).max() < largest_step
    assert jaco.clearance(path.joints).itself.min() > 0.0
    assert np.all((jaco.lower <= path.joints) & (path.joints <= jaco.upper))
    assert too_fast(timed, jaco.velocity_limits, jaco.acceleration_limits) <= 1.0


@pytest.mark.parametrize("file", SKILLS, ids=lambda file: file.stem)
def test_every_motion_of_a_built_in_skill_is_followed(jaco: Jaco, file: Path) -> None:
    for motion in read(file, units="m"):
        check_path(jaco, motion.positions, largest_step=0.1)


@pytest.mark.skipif(not ALPHA.exists(), reason="alpha.mat is not in ../shared/data; set GC_TEACH_DATA")
def test_the_authors_demonstrations_are_followed(jaco: Jaco) -> None:
    for motion in read(ALPHA):
        check_path(jaco, motion.positions, largest_step=0.05)


def test_random_paths_are_followed_without_touching_the_arm_itself(jaco: Jaco) -> None:
    rng = np.random.default_rng(4242)
    for _ in range(6):
        check_path(jaco, random_path(rng), largest_step=1.5)


@pytest.mark.soak
@pytest.mark.timeout(1800)
def test_fresh_drags_keep_the_laws(jaco: Jaco) -> None:
    check_drags(jaco, drags(jaco, secrets.randbits(32), 600))


@pytest.mark.soak
@pytest.mark.timeout(900)
def test_sixty_random_paths_are_all_followed(jaco: Jaco) -> None:
    rng = np.random.default_rng(secrets.randbits(32))
    for _ in range(60):
        check_path(jaco, random_path(rng), largest_step=1.5)
