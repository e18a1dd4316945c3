"""Small hooks in a mean path: where hands go back and forth without getting anywhere.

A path that turns back within a few stations has no section planes there, however they are tilted.
"""

from __future__ import annotations

import numpy as np

from gc_core.arrays import BoolArray, FloatArray, interpolated
from gc_core.frames import arc_length

LONGEST_HOOK = 0.04
"""A hook is at most this part of the path long [-]."""

CLOSED = 0.4
"""... and its ends are nearer to each other than this part of its length [-]."""

SHARP = 0.5
"""Only paths that turn by more than 60 deg (this cosine) from step to step are searched [-]."""

FINEST = 200
"""Of more stations than twice this, turns are seen over several: a rounded hook turns little at each."""

BESIDE = 2
"""How a path comes and goes is seen over this many of these steps."""

MOST_HOOKS = 8
"""Hooks that are taken out of one path."""


def without_hooks(path: FloatArray, grid: FloatArray, places: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Replace the hooks of a path by their chords.

    A hook is the piece that is most longer than its chord, among those that are at most `LONGEST_HOOK` of the
    path long, whose chord is shorter than `CLOSED` of that, and after which the path goes on as it came; one
    after the other. Turning round for good is no hook.

    Parameters
    ----------
    path : (n, 3) array
        Points along the path [m].
    grid : (n,) array
        Their parameter, increasing [-].
    places : (N,) array
        Parameters of stations at even steps along the path, the first and the last of `grid` among them [-].

    Returns
    -------
    path : (n, 3) array
        The same ends; the same object where there is no hook [m].
    bridged : (n,) array of bool
        Which points were moved.
    """
    stations = np.stack([interpolated(places, grid, column) for column in path.T], axis=1)
    bridged = np.zeros(len(path), dtype=bool)
    if not _turns_sharply(stations):
        return path, bridged
    longest = LONGEST_HOOK * float(arc_length(stations)[-1])
    for _ in range(MOST_HOOKS):
        first, last = _worst_hook(stations, longest)
        if first == last:
            break
        share = np.linspace(0.0, 1.0, last - first + 1)[:, None]
        chord = stations[first] * (1.0 - share) + stations[last] * share
        stations = np.concatenate((stations[:first], chord, stations[last + 1 :]))
        bridged |= (grid > places[first]) & (grid < places[last])
    straight = np.stack([interpolated(grid, places, column) for column in stations.T], axis=1)
    return np.where(bridged[:, None], straight, path), bridged


def _turns_sharply(path: FloatArray) -> bool:
    """Tell whether a path (n, 3) of even steps turns by more than 60 deg at one of its points."""
    stride = _stride(path)
    step = path[stride:] - path[:-stride]
    size = np.sqrt(np.einsum("ij,ij->i", step, step))
    cosine = np.einsum("ij,ij->i", step[stride:], step[:-stride])
    return bool((cosine < SHARP * size[stride:] * size[:-stride]).any())


def _stride(path: FloatArray) -> int:
    """Number of the steps between stations (N, 3) that make one over which turns are seen."""
    return max(len(path) // FINEST, 1)


def _worst_hook(path: FloatArray, longest: float) -> tuple[int, int]:
    """First and last point of the hook with the most excess; equal where there is none."""
    gone = arc_length(path)
    worst, best = 0.0, (0, 0)
    index = np.arange(len(path))
    beside = BESIDE * _stride(path)
    come = path - path[np.maximum(index - beside, 0)]
    go = path[np.minimum(index + beside, len(path) - 1)] - path
    furthest = np.searchsorted(gone, gone + longest, side="right") - index
    for lag in range(2, int(furthest.max())):
        length = gone[lag:] - gone[:-lag]
        chord = path[lag:] - path[:-lag]
        excess = length - np.sqrt(np.einsum("ij,ij->i", chord, chord)) / CLOSED
        goes_on = np.einsum("ij,ij->i", come[:-lag], go[lag:]) > 0.0
        goes_on[[0, -1]] = True
        excess = np.where(goes_on & (length <= longest), excess, 0.0)
        place = int(np.argmax(excess))
        if excess[place] > worst:
            worst, best = float(excess[place]), (place, place + lag)
    return best
