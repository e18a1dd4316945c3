"""How a map of space turns things: the rotation in its Jacobian, applied to orientations."""

from __future__ import annotations

import numpy as np

from gc_core.arrays import FloatArray
from gc_core.demonstration import sign_continuous


def nearest_rotations(jacobian: FloatArray) -> FloatArray:
    """Find the rotations nearest to Jacobians: their polar factors.

    Parameters
    ----------
    jacobian : (N, 3, 3) array
        Of a map [-].

    Returns
    -------
    (N, 3, 3) array
        Proper rotations, also where the map turns space inside out [-].
    """
    left, _, right = np.linalg.svd(jacobian)
    left[:, :, 2] *= np.linalg.det(left @ right)[:, None]
    return np.asarray(left @ right, dtype=np.float64)


def turned(quaternions: FloatArray, jacobian: FloatArray) -> FloatArray:
    """Turn orientations by the rotations nearest to Jacobians.

    Parameters
    ----------
    quaternions : (N, 4) array
        Orientations w, x, y, z [-].
    jacobian : (N, 3, 3) array
        Of a map, where they are [-].

    Returns
    -------
    (N, 4) array
        Unit quaternions, each in the half-space of the one before [-].
    """
    turn = _matrix_quaternions(nearest_rotations(jacobian))
    w, x, y, z = turn.T
    a, b, c, d = quaternions.T
    product = np.stack(
        (
            w * a - x * b - y * c - z * d,
            w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b,
            w * d + x * c - y * b + z * a,
        ),
        axis=1,
    )
    return sign_continuous(product / np.linalg.norm(product, axis=1, keepdims=True))


def _matrix_quaternions(matrices: FloatArray) -> FloatArray:
    """Unit quaternions (N, 4) w, x, y, z of rotation matrices (N, 3, 3), by the largest component."""
    m = matrices
    xx, yy, zz = m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]
    x, y, z = m[:, 2, 1] - m[:, 1, 2], m[:, 0, 2] - m[:, 2, 0], m[:, 1, 0] - m[:, 0, 1]
    xy, xz, yz = m[:, 0, 1] + m[:, 1, 0], m[:, 0, 2] + m[:, 2, 0], m[:, 1, 2] + m[:, 2, 1]
    candidates = np.stack(
        (
            np.stack((1 + xx + yy + zz, x, y, z), axis=1),
            np.stack((x, 1 + xx - yy - zz, xy, xz), axis=1),
            np.stack((y, xy, 1 - xx + yy - zz, yz), axis=1),
            np.stack((z, xz, yz, 1 - xx - yy + zz), axis=1),
        ),
        axis=1,
    )
    largest = np.argmax(np.einsum("nii->ni", candidates), axis=1)
    chosen = candidates[np.arange(len(m)), largest]
    return chosen / np.linalg.norm(chosen, axis=1, keepdims=True)
