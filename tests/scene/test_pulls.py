"""Laws of the pointer's projection."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.scene.pulls import checked_point, depth_ratio

CAMERA, LOOK_AT = np.array([1.0, -1.4, 0.9]), np.array([0.0, -0.4, 0.2])


@given(share=st.floats(0.6, 1.0), aside=st.floats(-0.2, 0.2))
def test_a_scaled_pointer_lies_in_the_plane_of_the_origin_and_on_the_same_ray(
    share: float, aside: float
) -> None:
    origin = np.array([0.1, -0.3, 0.3])
    hit = CAMERA + share * (origin - CAMERA)
    pointer = hit + aside * np.cross(LOOK_AT - CAMERA, [0.0, 0.0, 1.0])
    scaled = CAMERA + depth_ratio(CAMERA, LOOK_AT, hit, origin) * (pointer - CAMERA)

    assert abs((scaled - origin) @ (LOOK_AT - CAMERA)) < 1e-9
    np.testing.assert_allclose(np.cross(scaled - CAMERA, pointer - CAMERA), 0.0, atol=1e-9)


def test_a_hit_behind_the_camera_changes_nothing() -> None:
    assert depth_ratio(CAMERA, LOOK_AT, 2.0 * CAMERA - LOOK_AT, LOOK_AT) == 1.0


def test_a_camera_without_a_direction_changes_nothing() -> None:
    assert depth_ratio(CAMERA, CAMERA, np.zeros(3), LOOK_AT) == 1.0


@given(value=st.floats(allow_nan=True, allow_infinity=True))
def test_only_points_near_the_robot_pass(value: float) -> None:
    passed = checked_point((0.0, value, 0.0)) is not None

    assert passed == (-10.0 <= value <= 10.0)


def test_what_is_not_a_point_does_not_pass() -> None:
    assert checked_point((0.0, 0.0)) is None
