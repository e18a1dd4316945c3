from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gc_core import DegenerateCurveError
from gc_core.arrays import FloatArray
from gc_core.frames import rotation_minimizing_frames, tangents
from tests.core.shapes import rotation, seeds

Z = np.array([0.0, 0.0, 1.0])


def helix(turns: float, pitch: float, points: int = 300) -> FloatArray:
    angle = np.linspace(0.0, 2.0 * np.pi * turns, points)
    return np.stack((np.cos(angle), np.sin(angle), pitch * angle), axis=1)


def framed(curve: FloatArray, first: FloatArray = Z) -> FloatArray:
    return rotation_minimizing_frames(curve, tangents(curve), first)


@given(turns=st.floats(0.1, 3.0), pitch=st.floats(-1.0, 1.0))
def test_frames_are_rotations(turns: float, pitch: float) -> None:
    frames = framed(helix(turns, pitch))

    gram = np.swapaxes(frames, 1, 2) @ frames
    np.testing.assert_allclose(gram, np.broadcast_to(np.eye(3), gram.shape), atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(frames), 1.0, atol=1e-9)


@given(turns=st.floats(0.1, 3.0))
def test_frames_do_not_spin_on_a_planar_curve(turns: float) -> None:
    frames = framed(helix(turns, 0.0))

    np.testing.assert_allclose(frames[:, :, 1], np.broadcast_to(Z, (300, 3)), atol=1e-9)


def test_frames_do_not_flip_where_a_curve_changes_its_side() -> None:
    u = np.linspace(-1.0, 1.0, 200)
    frames = framed(np.stack((u, u**3, 0.0 * u), axis=1))

    assert (np.einsum("ij,ij->i", frames[1:, :, 1], frames[:-1, :, 1]) > 0.99).all()


@given(turns=st.floats(0.2, 2.0), pitch=st.floats(-1.0, 1.0), seed=seeds)
def test_frames_turn_with_the_curve(turns: float, pitch: float, seed: int) -> None:
    curve, turn = helix(turns, pitch), rotation(seed)

    np.testing.assert_allclose(framed(curve @ turn.T, turn @ Z), turn @ framed(curve), atol=1e-9)


@given(turns=st.floats(0.2, 2.0), pitch=st.floats(0.1, 1.0))
def test_frames_turn_about_the_direction_by_the_helix_s_torsion_less_than_frenet(
    turns: float, pitch: float
) -> None:
    frames = framed(helix(turns, pitch, 2000), np.array([-1.0, 0.0, 0.0]))
    step = frames[1:, :, 1] - frames[:-1, :, 1]

    spin = np.abs(np.einsum("ij,ij->i", step, frames[:-1, :, 2])).sum()
    assert spin < 0.02 * 2.0 * np.pi * turns


def test_tangents_of_a_straight_line_are_its_direction() -> None:
    curve = np.outer(np.linspace(0.0, 1.0, 40), [0.0, 3.0, 4.0])

    np.testing.assert_allclose(tangents(curve), np.broadcast_to([0.0, 0.6, 0.8], (40, 3)), atol=1e-12)


def test_tangents_forgive_repeated_points() -> None:
    curve = np.repeat(np.outer(np.linspace(0.0, 1.0, 10), [1.0, 0.0, 0.0]), 12, axis=0)

    np.testing.assert_allclose(tangents(curve), np.broadcast_to([1.0, 0.0, 0.0], (120, 3)), atol=1e-12)


def test_a_point_is_no_curve() -> None:
    with pytest.raises(DegenerateCurveError):
        tangents(np.zeros((20, 3)))
