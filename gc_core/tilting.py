"""Tilting section planes away from the tangents where neighbouring sections would cross.

Two neighbours cross when the normals turn, over one step of the directrix, by more than that step divided by
the reach of the section towards the inside of the bend. The turn is spread over more stations by smoothing
the normals there, just enough. Tilted planes cut the demonstrations elsewhere: the sections are cut anew.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import (  # pyright: ignore[reportMissingTypeStubs] - SciPy has none here
    solveh_banded,  # pyright: ignore[reportUnknownVariableType] - nor types
)

from gc_core.arrays import FloatArray
from gc_core.surface import crossing_stations

ROUNDS = 4
"""Times the sections are cut anew at most."""

DAMPING = 0.7
"""Part of the way to the smoothed normals that one round goes [-]."""

STEPS = 15
"""Adjustments of the smoothing within a round."""

TURN = 0.7
"""Part of the turn at which neighbours would touch that is aimed at [-]."""

CLEAR = 0.98
"""Below this part of that turn, neighbours do not cross [-]."""

SPREAD = 2
"""Stations to either side that share in the smoothing of one."""

STRONGEST = 0.1
"""Normals are smoothed over at most about this part of the stations [-]."""

MOST = np.radians(100.0)
"""A plane is tilted by at most this much; beyond a right angle only where the directrix turns back [rad]."""

CORNERS = 16
"""Vertices of a section by which its reach is judged within a round."""

BACKWARDS = 0.05
"""A step along the normal counts as at least this part of the step [-]."""


def tilted_normals(
    directrix: FloatArray,
    wanted: FloatArray,
    surface: FloatArray,
    cut: Callable[[FloatArray], FloatArray],
) -> FloatArray:
    """Tilt section normals, just enough for neighbours not to cross.

    Parameters
    ----------
    directrix : (N, 3) array
        Centres of the sections [m].
    wanted : (N, 3) array
        Unit normals of the sections to begin with and to stay near to: the tangents [-].
    surface : (N, M, 3) array
        Vertices of the sections with these normals [m].
    cut : callable
        Vertices (N, M', 3) [m] of the sections with other unit normals (N, 3).

    Returns
    -------
    (N, 3) array
        Unit normals with the fewest crossing stations that were found: `wanted` itself where nothing crosses
        or no tilt helps.
    """
    normals = best = wanted
    fewest = int(crossing_stations(surface, normals).sum())
    weights = np.zeros(len(directrix) - 1)
    for _ in range(ROUNDS):
        reach = surface - directrix[:, None]
        if not fewest or _turn_ratios(directrix, normals, reach).max() < CLEAR:
            break
        some = reach[:, :: max(1, reach.shape[1] // CORNERS)]
        smoothed, weights = _smoothed(directrix, wanted, normals, some, weights)
        normals = _near(wanted, _unit(normals + DAMPING * (smoothed - normals)))
        surface = cut(normals)
        crossing = int(crossing_stations(surface, normals).sum())
        if crossing < fewest:
            fewest, best = crossing, normals
    return best


def _turn_ratios(directrix: FloatArray, normals: FloatArray, reach: FloatArray) -> FloatArray:
    """Turn of the normals at each step (N-1,), by the one at which vertices `reach` (N, M, 3) would touch."""
    turn = np.diff(normals, axis=0)
    step = np.diff(directrix, axis=0)
    least = BACKWARDS * np.sqrt(np.einsum("ij,ij->i", step, step))
    ahead = np.maximum(np.einsum("ij,ij->i", step, normals[:-1]), least)
    behind = np.maximum(np.einsum("ij,ij->i", step, normals[1:]), least)
    after = (reach[1:] @ turn[:, :, None])[..., 0].max(axis=1)
    before = (reach[:-1] @ turn[:, :, None])[..., 0].max(axis=1)
    return np.maximum(after / np.maximum(ahead, 1e-300), before / np.maximum(behind, 1e-300))


def _smoothed(
    directrix: FloatArray, wanted: FloatArray, normals: FloatArray, reach: FloatArray, weights: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Smooth `wanted` until sections of this reach would not cross: normals (N, 3) and weights (N - 1,)."""
    strongest = (STRONGEST * len(wanted)) ** 2
    window = np.full(2 * SPREAD + 1, 1.0 / (2 * SPREAD + 1))
    for _ in range(STEPS):
        ratios = _turn_ratios(directrix, normals, reach) / TURN
        weights = np.where(
            weights > 0.0, weights * np.clip(ratios, 0.5, 4.0), np.where(ratios > 1.0, 1.0, 0.0)
        )
        weights = np.where(weights < 1e-3, 0.0, weights)
        spread = np.convolve(np.pad(weights, SPREAD, mode="edge"), window, "valid")
        weights = np.minimum(np.maximum(weights, spread), strongest)
        normals = _least_bent(wanted, weights)
    return normals, weights


def _least_bent(wanted: FloatArray, weights: FloatArray) -> FloatArray:
    """Unit vectors (N, 3) near `wanted` whose differences, squared, cost their weights (N - 1,)."""
    bands = np.zeros((2, len(wanted)))
    bands[1] = 1.0
    bands[1, :-1] += weights
    bands[1, 1:] += weights
    bands[0, 1:] = -weights
    return _unit(np.asarray(solveh_banded(bands, wanted, check_finite=False), dtype=np.float64))


def _near(wanted: FloatArray, normals: FloatArray) -> FloatArray:
    """Turn unit normals (N, 3) back to within `MOST` of those wanted."""
    cosine = np.einsum("ij,ij->i", normals, wanted)[:, None]
    aside = normals - cosine * wanted
    size = np.sqrt(np.einsum("ij,ij->i", aside, aside))[:, None]
    limit = np.cos(MOST) * wanted + np.sin(MOST) * aside / np.maximum(size, np.finfo(float).tiny)
    return np.where(cosine < np.cos(MOST), limit, normals)


def _unit(vectors: FloatArray) -> FloatArray:
    return vectors / np.sqrt(np.einsum("ij,ij->i", vectors, vectors))[:, None]
