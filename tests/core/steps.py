"""How even the steps of runs are: a jump is a step far above those around it."""

from __future__ import annotations

import numpy as np

from gc_core.arrays import FloatArray

AROUND = 21
"""Steps whose median a step is compared with."""

JUMP = 5.0
"""A step above this many medians is a jump."""


def worst_step_ratio(positions: FloatArray) -> FloatArray:
    """Greatest ratio of a step to the median of the 21 steps around it.

    Parameters
    ----------
    positions : (S, K, 3) array
        Runs; those of several starts at once may wait at their start, which is left out [m].

    Returns
    -------
    (S,) array
        At an end of a run, the 21 steps next to it count; of a shorter run, all [-].
    """
    steps = np.linalg.norm(np.diff(positions, axis=1), axis=2)
    waits = (np.maximum.accumulate(steps, axis=1) == 0.0).sum(axis=1)
    worst = np.zeros(len(steps))
    for wait in np.unique(waits):
        rows = waits == wait
        worst[rows] = _worst(steps[rows, wait:])
    return worst


def _worst(steps: FloatArray) -> FloatArray:
    count = steps.shape[1]
    if not count:
        return np.zeros(len(steps))
    width = min(AROUND, count)
    medians = np.median(np.lib.stride_tricks.sliding_window_view(steps, width, axis=1), axis=2)
    window = np.clip(np.arange(count) - width // 2, 0, count - width)
    return (steps / np.maximum(medians[:, window], 1e-300)).max(axis=1)
