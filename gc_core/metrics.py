"""Numbers that say how good a tube, a run or a map is.

Dynamic time warping is a library's. The Fréchet distance is our own: the permissive library that has it
in space (similaritymeasures 1.5) agrees to the last digit but takes five times as long.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.distance import cdist

from gc_core.arrays import FloatArray, finite
from gc_core.cylinder import GeneralizedCylinder
from gc_core.demonstration import check_times
from gc_core.errors import ShapeError, TooFewSamplesError
from gc_core.registration import ThinPlateSpline
from gc_core.warping import least_sum


def containment(cylinder: GeneralizedCylinder, points: FloatArray) -> float:
    """Tell how many of some points a cylinder holds.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
    points : (P, 3) array
        Any places [m].

    Returns
    -------
    float
        Share of those inside or on the boundary, from 0 to 1; 1 when there are none [-].

    Raises
    ------
    ShapeError, NotFiniteError
        If the points are not finite places.
    """
    inside = cylinder.contains(points)
    return float(inside.mean()) if inside.size else 1.0


def volume(cylinder: GeneralizedCylinder) -> float:
    """Volume of a cylinder.

    Parameters
    ----------
    cylinder : GeneralizedCylinder

    Returns
    -------
    float
        `GeneralizedCylinder.volume` [m^3].
    """
    return cylinder.volume


def frechet(a: FloatArray, b: FloatArray) -> float:
    """Discrete Fréchet distance: the shortest leash for two walks that never turn back.

    Parameters
    ----------
    a, b : (K, 3), (L, 3) array
        Paths [m].

    Returns
    -------
    float
        [m].

    Raises
    ------
    ShapeError, NotFiniteError, TooFewSamplesError
        If they are no paths.

    References
    ----------
    .. [1] T. Eiter, H. Mannila. Computing discrete Fréchet distance. CD-TR 94/64, TU Vienna, 1994.
    """
    return _least_maximum(np.asarray(cdist(_path(a, "a"), _path(b, "b")), dtype=np.float64))


def dtw(a: FloatArray, b: FloatArray) -> float:
    """Dynamic time warping: least sum of distances over a monotone matching of all samples.

    Parameters
    ----------
    a, b : (K, 3), (L, 3) array
        Paths [m].

    Returns
    -------
    float
        [m].

    Raises
    ------
    ShapeError, NotFiniteError, TooFewSamplesError
        If they are no paths.

    References
    ----------
    .. [1] H. Sakoe, S. Chiba. Dynamic programming algorithm optimization for spoken word recognition.
       IEEE TASSP 26(1), 1978. doi:10.1109/TASSP.1978.1163055
    """
    return least_sum(_path(a, "a"), _path(b, "b"))


def sse(a: FloatArray, b: FloatArray) -> float:
    """Sum of squared distances of corresponding samples.

    Parameters
    ----------
    a, b : (K, 3) array
        Paths [m].

    Returns
    -------
    float
        [m^2].

    Raises
    ------
    ShapeError, NotFiniteError, TooFewSamplesError
        If they are no paths, or differ in length.
    """
    one, two = _path(a, "a"), _path(b, "b")
    if one.shape != two.shape:
        raise ShapeError("b", f"{one.shape}, as a,", two.shape)
    return float(((one - two) ** 2).sum())


def jerk(positions: FloatArray, times: FloatArray) -> float:
    """Mean squared jerk along a path.

    Parameters
    ----------
    positions : (K, 3) array
        Path, K >= 4 [m].
    times : (K,) array
        Strictly increasing [s].

    Returns
    -------
    float
        Time average of the squared third divided difference [m^2/s^6].

    Raises
    ------
    ShapeError, NotFiniteError, TooFewSamplesError, TimesNotIncreasingError
        If they are no path with times, of at least four samples, or two are at one time.
    """
    value, clock = _path(positions, "positions"), finite(times, "times", (len(positions),))
    if len(value) < 4:
        raise TooFewSamplesError("The path (a third derivative needs 4)", len(value))
    check_times("The path", clock)
    # k-th derivative = k! times the divided difference of order k.
    for order in (1, 2, 3):
        value = order * np.diff(value, axis=0) / (clock[order:] - clock[:-order])[:, None]
    span = clock[3:] - clock[:-3]
    return float(((value**2).sum(axis=1) * span).sum() / span.sum())


def end_error(positions: FloatArray, goal: FloatArray) -> float:
    """Distance of the end of a path from a goal.

    Parameters
    ----------
    positions : (K, 3) array
        Path, K >= 1 [m].
    goal : (3,) array
        [m].

    Returns
    -------
    float
        [m].

    Raises
    ------
    ShapeError, NotFiniteError, TooFewSamplesError
        If they are no path and no finite place.
    """
    return float(np.linalg.norm(_path(positions, "positions")[-1] - finite(goal, "goal", (3,))))


def det_jacobian(registration: ThinPlateSpline, points: FloatArray) -> FloatArray:
    """Change of volume by a map.

    Parameters
    ----------
    registration : ThinPlateSpline
    points : (P, 3) array
        Where to look [m].

    Returns
    -------
    (P,) array
        Determinant of the Jacobian: 1 keeps volumes, 0 or less folds space [-].

    Raises
    ------
    ShapeError, NotFiniteError
        If the points are not finite places.
    """
    return np.linalg.det(registration.jacobian(finite(points, "points", (None, 3))))


def _path(values: FloatArray, what: str) -> FloatArray:
    path = finite(values, what, (None, 3))
    if not len(path):
        raise TooFewSamplesError(f"The path {what}", 0)
    return path


def _least_maximum(cost: FloatArray) -> float:
    """Least maximum of costs (K, L) over monotone ways from corner to corner, diagonal by diagonal."""
    rows, columns = cost.shape
    flipped = cost[:, ::-1]
    older = np.full(rows + 1, np.inf)
    latest = np.full(rows + 1, np.inf)
    # Slot i + 1 belongs to row i; slot 0 stays infinite, and before the first cell there is nothing to pay.
    older[0] = -np.inf
    for diagonal in range(rows + columns - 1):
        low, high = max(0, diagonal - columns + 1), min(rows, diagonal + 1)
        here = np.diagonal(flipped, columns - 1 - diagonal)
        best = np.minimum(np.minimum(latest[low + 1 : high + 1], latest[low:high]), older[low:high])
        fresh = np.full(rows + 1, np.inf)
        fresh[low + 1 : high + 1] = np.maximum(best, here)
        older, latest = latest, fresh
    return float(latest[rows])
