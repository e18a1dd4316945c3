"""How far a run is from the nearest of what was shown: the numbers that comparisons and studies share."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from scipy.spatial.distance import cdist

from app.document import FloatArray
from gc_core import metrics


def nearest_frechet(path: FloatArray, others: Iterable[FloatArray]) -> float:
    """Frechet distance of a path (K, 3) from the nearest of some others (L, 3) [m].

    No leash is shorter than what takes both ends and every place to the other path: most others need not be
    walked along.
    """
    bounds = [(_at_least(path, other), other) for other in others]
    shortest = np.inf
    for bound, other in sorted(bounds, key=lambda each: each[0]):
        if bound >= shortest:
            break
        shortest = min(shortest, metrics.frechet(path, other))
    return shortest


def nearest_dtw(path: FloatArray, others: Iterable[FloatArray]) -> float:
    """Dynamic time warping distance of a path (K, 3) from the nearest of some others, by its samples [m]."""
    return min(metrics.dtw(path, other) for other in others) / len(path)


def _at_least(path: FloatArray, other: FloatArray) -> float:
    apart = np.asarray(cdist(path, other), dtype=np.float64)
    return float(max(apart[0, 0], apart[-1, -1], apart.min(axis=0).max(), apart.min(axis=1).max()))
