"""How a map of space turns things: the rotation in its Jacobian, applied to orientations."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import (  # pyright: ignore[reportMissingTypeStubs] - SciPy has none
    Rotation,
)

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
    turn = Rotation.from_matrix(nearest_rotations(jacobian))
    product = turn * Rotation.from_quat(quaternions, scalar_first=True)
    return sign_continuous(np.asarray(product.as_quat(scalar_first=True), dtype=np.float64))
