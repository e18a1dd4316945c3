"""Checks at the arm's door: what comes in is finite and has the right shape."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import (  # pyright: ignore[reportMissingTypeStubs] - SciPy has none
    Rotation,
)

from app.arm.errors import ArmInputError
from app.arm.protocol import FloatArray


def joints_of(value: npt.ArrayLike, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Give joints as a new (J,) array within the limits [rad]."""
    joints = _array(value, "joints", (len(lower),))
    return np.clip(joints, lower, upper)


def position_of(value: npt.ArrayLike) -> FloatArray:
    """Give one position as a new (3,) array [m]."""
    return _array(value, "a position", (3,))


def path_of(value: npt.ArrayLike) -> FloatArray:
    """Give a path as a new (K, 3) array [m], K >= 1."""
    path = np.array(value, dtype=np.float64)
    if path.ndim != 2 or len(path) == 0:
        raise ArmInputError("a path", "(K, 3) positions with K >= 1", f"shape {path.shape}")
    return _array(path, "a path", (len(path), 3))


def rotations_of(value: npt.ArrayLike, count: int) -> FloatArray:
    """Give orientations w, x, y, z of any length but zero as (K, 3, 3) rotations."""
    quaternions = _array(value, "orientations", (count, 4))
    if not np.linalg.norm(quaternions, axis=1).all():
        raise ArmInputError("orientations", "w, x, y and z, not all zero", "zeros among them")
    return np.asarray(Rotation.from_quat(quaternions, scalar_first=True).as_matrix(), dtype=np.float64)


def configurations_of(value: npt.ArrayLike, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Give several configurations as a new (K, J) array within the limits [rad], K >= 1."""
    joints = np.array(value, dtype=np.float64)
    if joints.ndim != 2 or len(joints) == 0:
        raise ArmInputError("configurations", "(K, J) joints with K >= 1", f"shape {joints.shape}")
    return np.clip(_array(joints, "configurations", (len(joints), len(lower))), lower, upper)


def duration_of(value: float) -> float:
    """Give a length of time that is positive and finite [s]."""
    if not (math.isfinite(value) and value > 0.0):
        raise ArmInputError("a time step", "a positive number of seconds", repr(value))
    return float(value)


def gripper_of(value: float) -> float:
    """Give how far the gripper is closed, between 0 and 1."""
    if not math.isfinite(value):
        raise ArmInputError("the gripper", "a number from 0 (open) to 1 (closed)", repr(value))
    return min(max(float(value), 0.0), 1.0)


def _array(value: npt.ArrayLike, what: str, shape: tuple[int, ...]) -> FloatArray:
    array = np.array(value, dtype=np.float64)
    if array.shape != shape:
        raise ArmInputError(what, f"an array of shape {shape}", f"shape {array.shape}")
    if not np.isfinite(array).all():
        raise ArmInputError(what, "finite numbers", f"{array[~np.isfinite(array)][0]} among them")
    return array
