"""What a study measures of its runs: the rows of its table, and what is not yet in `gc_core.metrics`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np

from app.document import FloatArray
from gc_core import GeneralizedCylinder
from gc_core.radius import radius_at


@dataclass(frozen=True)
class Row:
    """One run of one method. None: not measured in this experiment, or the run failed."""

    experiment: str
    data_set: str
    alignment: str
    method: str
    section: str
    """Kind of slices of the tube; empty for other methods."""
    run: int
    """From 0: which start, move, or demonstration left out."""
    spread_kept: float | None = None
    """Distance of the run from the mean of all runs where it passes the middle slice, by that of its start
    from the mean of all starts [-]."""
    away_start_m: float | None = None
    """The latter [m]."""
    away_mid_m: float | None = None
    """The former [m]."""
    start_error_m: float | None = None
    """Where the run begins, from where it was asked to [m]."""
    end_error_m: float | None = None
    """Where it ends: from the mean end of the demonstrations (starts), from the moved goal (moves), from the
    end of the demonstration left out [m]."""
    frechet_m: float | None = None
    """Discrete Frechet distance from the nearest demonstration, or from the one left out [m]."""
    dtw_m: float | None = None
    """Dynamic time warping distance from the same, by the run's samples [m]."""
    jerk: float | None = None
    """Time average of the squared third derivative of the place [m^2/s^6]."""
    contained_shown: float | None = None
    """Share of its samples in the tightest tube (hull) around all that was shown [-]."""
    contained_own: float | None = None
    """Share of its samples in the tube that it was made with [-]."""
    eta_start: float | None = None
    """Ratio of the start in the tube that it was made with: above 1 where nothing was shown [-]."""
    shape: float | None = None
    """Root mean square distance from the run that was not moved after the best similarity, by the length of
    the latter [-]."""
    folded: int | None = None
    """Stations of the moved tube at which the map turns space inside out."""
    crossing: int | None = None
    """Stations of the moved tube whose slice cuts its neighbour's."""
    failed: str | None = None
    """Why there is no run, in a sentence."""


def on_sections(cylinder: GeneralizedCylinder, stations: np.ndarray, rng: np.random.Generator) -> FloatArray:
    """Random places, evenly spread over sections of a tube.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
    stations : (S,) integer array
        On which section each is.
    rng : numpy Generator

    Returns
    -------
    (S, 3) array
        In the planes of the sections, inside of their polygons [m].
    """
    angles = rng.uniform(0.0, 2.0 * np.pi, len(stations))
    ratios = np.sqrt(rng.uniform(0.0, 1.0, len(stations)))
    away = ratios * radius_at(cylinder.radii, stations, angles)
    local = away[:, None] * np.stack((np.cos(angles), np.sin(angles)), axis=1)
    return cylinder.directrix[stations] + np.einsum("sj,skj->sk", local, cylinder.frames[stations, :, 1:])


def in_ball(count: int, farthest: float, rng: np.random.Generator) -> FloatArray:
    """Random vectors (count, 3), evenly spread over a ball of radius `farthest` [m]."""
    away = rng.normal(size=(count, 3))
    length = farthest * rng.uniform(0.0, 1.0, (count, 1)) ** (1.0 / 3.0)
    return length * away / np.linalg.norm(away, axis=1)[:, None]


def shape_change(one: FloatArray, other: FloatArray) -> float:
    """Tell how unlike two curves are, wherever they are, however turned and however large.

    Parameters
    ----------
    one, other : (N, 3) array
        Corresponding places [m].

    Returns
    -------
    float
        Root mean square distance after the best similarity (Procrustes), by the other's length [-].
    """
    a, b = one - one.mean(axis=0), other - other.mean(axis=0)
    left, sizes, right = cast("tuple[FloatArray, FloatArray, FloatArray]", np.linalg.svd(b.T @ a))
    sign = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    scale = float((sizes * sign).sum() / (a**2).sum())
    rest = b - scale * a @ (left @ np.diag(sign) @ right).T
    length = float(np.linalg.norm(np.diff(other, axis=0), axis=1).sum())
    return float(np.sqrt((rest**2).sum(axis=1).mean())) / length
