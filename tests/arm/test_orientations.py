"""Paths with a turned tool, and ways from posture to posture."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.arm import ArmInputError, Conditions, FloatArray, Jaco
from app.arm.shapes import Box

LINE = np.linspace([0.3, -0.5, 0.25], [-0.3, -0.45, 0.3], 100)
DOWN = Rotation.from_matrix(np.diag([1.0, -1.0, -1.0]))


def turning(degrees: tuple[float, float, float]) -> FloatArray:
    """(100, 4) from straight down to a turn about x, y, z."""
    angles = np.linspace([0.0, 0.0, 0.0], degrees, len(LINE))
    return (Rotation.from_euler("xyz", angles, degrees=True) * DOWN).as_quat(scalar_first=True)


def test_the_tool_turns_along_a_path_as_it_was_shown(jaco: Jaco) -> None:
    path = jaco.follow(LINE, jaco.home, turning((40.0, 20.0, 60.0)))

    assert path.turns is not None
    assert path.turns.max() < np.radians(2.0)
    assert path.errors.max() < 1e-3
    assert np.abs(np.diff(path.joints, axis=0)).max() < 0.1


def test_the_sign_of_a_quaternion_does_not_matter(jaco: Jaco) -> None:
    turns = turning((40.0, 20.0, 60.0))

    np.testing.assert_allclose(
        jaco.follow(LINE, jaco.home, turns).joints, jaco.follow(LINE, jaco.home, -2.0 * turns).joints
    )


def test_where_the_tool_cannot_be_turned_so_the_places_come_first(jaco: Jaco) -> None:
    path = jaco.follow(LINE, jaco.home, np.tile(turning((180.0, 0.0, 0.0))[-1], (len(LINE), 1)))

    assert path.turns is not None
    assert path.turns.max() > np.radians(5.0)
    assert path.errors.max() < 1e-3


def test_without_orientations_nothing_is_said_about_turns(jaco: Jaco) -> None:
    assert jaco.follow(LINE, jaco.home).turns is None


@pytest.mark.parametrize("bad", [np.zeros((100, 4)), np.ones((99, 4)), np.full((100, 4), np.nan)])
def test_orientations_that_are_none_are_refused(jaco: Jaco, bad: FloatArray) -> None:
    with pytest.raises(ArmInputError, match="orientations"):
        jaco.follow(LINE, jaco.home, bad)


def swept(way: FloatArray) -> FloatArray:
    """Joints (K, 6) along the straight lines of a way."""
    shares = np.linspace(0.0, 1.0, 60)[:, None]
    return np.concatenate([a + shares * (b - a) for a, b in itertools.pairwise(way)])


def test_a_way_with_nothing_on_it_is_straight(jaco: Jaco) -> None:
    ends = jaco.follow(LINE).joints[[0, -1]]

    np.testing.assert_array_equal(jaco.way(*ends), ends)


def test_a_way_leads_round_what_stands_on_the_straight_one(jaco: Jaco) -> None:
    ends = jaco.follow(LINE).joints[[0, -1]]
    arm = jaco.under(Conditions((Box("a pillar", (0.0, -0.5, 0.25), (0.08, 0.2, 0.5)),)))
    way = arm.way(*ends)

    assert arm.clearance(swept(ends)).obstacles.min() < 0.0
    assert way is not None
    np.testing.assert_array_equal(way[[0, -1]], ends)
    assert arm.clearance(swept(way)).obstacles.min() > 0.0
    assert min(arm.tool_pose(joints)[2, 3] for joints in swept(way)) > 0.0


def test_out_of_a_box_there_is_no_way(jaco: Jaco) -> None:
    ends = jaco.follow(LINE).joints[[0, -1]]
    walls = [
        Box("right", (0.15, 0.0, 0.9), (0.02, 3.0, 1.8)),
        Box("left", (-0.15, 0.0, 0.9), (0.02, 3.0, 1.8)),
    ]

    assert jaco.under(Conditions(tuple(walls))).way(*ends) is None
