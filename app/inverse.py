"""Where a place would be if nothing had been moved: the map of the landmarks, backwards."""

from typing import Final

import numpy as np
from scipy.spatial.distance import cdist

from app.document import FloatArray
from gc_core import ThinPlateSpline

EXACT: Final = 1e-7
"""A place is found when the map takes it this near to where it should go [m]."""
ROUNDS: Final = 40
LONGEST_STEP: Final = 0.1
"""[m]."""
STIFF: Final = 1e-9
"""Added to the squared Jacobian, which a fold makes singular [-]."""


def places_before(
    registration: ThinPlateSpline, points: FloatArray, near: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Find the places that a map takes to points.

    Newton's method with steps that are halved where they do not help, from the place of ``near`` whose
    image is nearest.

    Parameters
    ----------
    registration : ThinPlateSpline
        From taught to present places.
    points : (P, 3) array
        Present places [m].
    near : (N, 3) array
        Taught places that are not far off, for instance a directrix; N >= 1 [m].

    Returns
    -------
    places : (P, 3) array
        Taught places [m].
    misses : (P,) array
        How far their images are from the points; above `EXACT` where the map folds and none was found [m].
    """
    images = registration(near)
    places = np.array(near[np.argmin(cdist(points, images), axis=1)])
    off = points - registration(places)
    misses = np.linalg.norm(off, axis=1)
    share = np.ones(len(points))
    for _ in range(ROUNDS):
        left = np.flatnonzero((misses > EXACT) & (share > 1e-6))
        if not left.size:
            break
        step = _steps(registration.jacobian(places[left]), off[left]) * share[left, None]
        tried = places[left] + step
        still_off = points[left] - registration(tried)
        miss = np.linalg.norm(still_off, axis=1)
        better = miss < misses[left]
        taken = left[better]
        places[taken], off[taken], misses[taken] = tried[better], still_off[better], miss[better]
        share[left] = np.where(better, np.minimum(2.0 * share[left], 1.0), 0.5 * share[left])
    return places, misses


def _steps(jacobian: FloatArray, off: FloatArray) -> FloatArray:
    """Newton steps (k, 3) of bounded length for what is off (k, 3) [m]."""
    transposed = np.swapaxes(jacobian, 1, 2)
    square = transposed @ jacobian + STIFF * np.eye(3)
    steps = np.linalg.solve(square, transposed @ off[:, :, None])[..., 0]
    length = np.linalg.norm(steps, axis=1, keepdims=True)
    return np.asarray(steps * np.minimum(1.0, LONGEST_STEP / np.maximum(length, 1e-12)), dtype=np.float64)
