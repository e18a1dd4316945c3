"""Things around the arm: taken apart into bodies that stay where the shape is."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.arm.errors import ArmInputError
from app.arm.shapes import Box, Cylinder, Ring, Shape, Sphere, pose_of, primitives

TURNED = (math.cos(0.4), 0.0, math.sin(0.4), 0.0)


@pytest.mark.parametrize(
    "shape",
    [
        Box("b", (0.1, 0.2, 0.3), (0.1, 0.2, 0.3), wxyz=TURNED),
        Sphere("s", (0.1, 0.2, 0.3), 0.1),
        Cylinder("c", (0.1, 0.2, 0.3), 0.1, 0.2, wxyz=TURNED),
    ],
)
def test_a_convex_shape_is_one_body_at_its_own_place(shape: Shape) -> None:
    (body,) = primitives(shape)

    np.testing.assert_array_equal(body.pose, np.eye(4))


def test_the_pose_of_a_shape_is_a_rotation_at_its_position() -> None:
    pose = pose_of(Box("b", (0.1, 0.2, 0.3), (0.1, 0.1, 0.1), wxyz=(2.0, 0.0, 2.0, 0.0)))

    np.testing.assert_allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(pose[:3, :3] @ [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_array_equal(pose[:3, 3], [0.1, 0.2, 0.3])


def test_the_pieces_of_a_ring_join_and_keep_to_its_circle() -> None:
    bodies = primitives(Ring("r", (0.0, 0.0, 0.0), 0.1, 0.01))
    ends = np.array(
        [[b.pose[:3, 3] + sign * 0.5 * b.size[1] * b.pose[:3, 2] for sign in (-1, 1)] for b in bodies]
    )
    middles = np.array([b.pose[:3, 3] for b in bodies])

    np.testing.assert_allclose(ends[:, 1], np.roll(ends[:, 0], -1, axis=0), atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(ends, axis=2), 0.1, rtol=0.011)
    np.testing.assert_allclose(np.linalg.norm(middles, axis=1), 0.1, rtol=0.011)


@pytest.mark.parametrize("size", [(0.0, 1.0, 1.0), (1.0, -1.0, 1.0), (1.0, math.nan, 1.0)])
def test_a_size_that_is_none_is_refused(size: tuple[float, float, float]) -> None:
    with pytest.raises(ArmInputError, match="the size of 'b'"):
        Box("b", (0.0, 0.0, 0.0), size)


def test_a_ring_without_an_opening_is_refused() -> None:
    with pytest.raises(ArmInputError, match="less than its radius"):
        Ring("r", (0.0, 0.0, 0.0), 0.05, 0.05)


def test_a_place_or_a_turn_that_is_none_is_refused() -> None:
    with pytest.raises(ArmInputError, match="position"):
        Sphere("s", (0.0, math.inf, 0.0), 0.1)
    with pytest.raises(ArmInputError, match="orientation"):
        Sphere("s", (0.0, 0.0, 0.0), 0.1, wxyz=(0.0, 0.0, 0.0, 0.0))
    with pytest.raises(ArmInputError, match="mass"):
        Sphere("s", (0.0, 0.0, 0.0), 0.1, mass=-1.0)
