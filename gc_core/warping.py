"""Dynamic time warping of two paths: its distance, and which of their samples belong together.

The dynamic program is dtaidistance's, compiled; what it returns are stairs, which `warp` makes smooth.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

import numpy as np
from dtaidistance import dtw  # pyright: ignore[reportMissingTypeStubs] - it has none

from gc_core.arrays import FloatArray, interpolated
from gc_core.frames import arc_length, smooth

REACH = 0.04
"""The stairs of a matching are averaged, twice, over this part of the path to either side [-]."""

EVEN = 0.02
"""Part of even pace that is mixed into a matching, so that it never stands still [-]."""

WINDOW = 0.25
"""Samples further apart than this part of the path are never matched [-]."""

_untyped = cast("Any", dtw)
_distance: Callable[..., float] = _untyped.distance_fast
_warping_path: Callable[..., list[tuple[int, int]]] = _untyped.warping_path_fast


def least_sum(a: FloatArray, b: FloatArray) -> float:
    """Least sum of distances [m] over monotone matchings of all samples of paths (K, 3), (L, 3) [m]."""
    # The library's pruning bounds from a wrong side for paths of different length, and then finds no way.
    return float(
        _distance(_writable(a), _writable(b), use_ndim=True, inner_dist="euclidean", use_pruning=False)
    )


def _writable(path: FloatArray) -> FloatArray:
    """Copy a path, since the library takes no array that is read-only, although it does not write."""
    return np.array(path, dtype=np.float64, order="C")


def warp(reference: FloatArray, path: FloatArray) -> FloatArray:
    """Tell which place of a path belongs to each sample of a reference.

    The least sum of squared distances is sought, in which a sample that is matched twice costs a step of the
    reference more; its stairs are then averaged. Turning, moving and scaling both paths changes nothing.

    Parameters
    ----------
    reference, path : (K, 3) array
        Paths, best evenly sampled [m].

    Returns
    -------
    (K,) array
        Fractional sample numbers of the path, strictly increasing from 0 to K - 1.

    References
    ----------
    .. [1] H. Sakoe, S. Chiba. Dynamic programming algorithm optimization for spoken word recognition.
       IEEE TASSP 26(1), 1978. doi:10.1109/TASSP.1978.1163055
    """
    count = len(reference)
    step = float(arc_length(reference)[-1]) / (count - 1)
    pairs = _warping_path(
        _writable(reference), _writable(path), use_ndim=True, window=round(WINDOW * count), penalty=step
    )
    mine, theirs = np.array(pairs, dtype=np.intp).T
    times = np.bincount(mine, minlength=count)
    stairs = np.bincount(mine, weights=theirs, minlength=count) / times
    stairs[0], stairs[-1] = 0.0, count - 1.0
    reach = round(REACH * count)
    ramp = smooth(smooth(stairs[:, None], reach), reach)[:, 0]
    return (1.0 - EVEN) * ramp + EVEN * np.arange(count)


def warped_together(paths: list[FloatArray], reference: FloatArray | None) -> list[FloatArray]:
    """Match several paths with one another.

    Without a reference, their mean is one, then the mean of what was matched with that: as in barycenter
    averaging, but with smooth matchings. The order of the paths does not matter beyond rounding.

    Parameters
    ----------
    paths : list of (K, 3) array
        Evenly sampled [m].
    reference : (K, 3) array or None
        The curve with which they are matched [m].

    Returns
    -------
    list of (K,) array
        For each path, fractional sample numbers that correspond to those of the others.

    References
    ----------
    .. [1] F. Petitjean, A. Ketterlin, P. Gançarski. A global averaging method for dynamic time warping, with
       applications to clustering. Pattern Recognition 44(3), 2011. doi:10.1016/j.patcog.2010.09.013
    """
    if reference is not None:
        return [warp(reference, path) for path in paths]
    middle = np.mean(paths, axis=0)
    samples = np.arange(len(middle), dtype=np.float64)
    first = [warp(middle, path) for path in paths]
    moved = [
        np.stack([interpolated(where, samples, axis) for axis in path.T], axis=1)
        for where, path in zip(first, paths, strict=True)
    ]
    middle = np.mean(moved, axis=0)
    return [warp(middle, path) for path in paths]
