"""Rules: a corrected run keeps later runs on its side, where they would pass it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from gc_core.arrays import BoolArray, FloatArray, fading, finite, read_only_fields
from gc_core.errors import ShapeError, TooFewSamplesError
from gc_core.frames import arc_length
from gc_core.reproduction import Reproduction

LEAST_CORRECTION = 0.001
"""A station where the correction is shorter makes no plane [m]."""

FADE_LENGTH = 0.08
"""Beyond the corrected span, what a run was moved in excess of the teacher fades out over this length [m]."""

ALLOWED = 1e-13
"""A place this little behind a plane is on it: rounding [m]."""

CORNERS = 3
"""In space, the nearest point of an intersection of half-spaces lies on at most this many planes."""


@dataclass(frozen=True, eq=False)
class Constraint:
    """Half-spaces along a corrected run: behind a plane nothing may pass. Made by `from_correction`."""

    stations: FloatArray
    """(K,) stations of the run, increasing [-]."""
    points: FloatArray
    """(K, 3) corrected places, through which the planes go [m]."""
    normals: FloatArray
    """(K, 3) unit normals, towards the allowed side; 0 where there is no plane [-]."""
    lengths: FloatArray
    """(K,) how far the teacher moved the run [m]."""
    name: str = ""
    """How the person calls the rule."""

    def __post_init__(self) -> None:
        read_only_fields(self)

    @property
    def active(self) -> BoolArray:
        """(K,) where there is a plane."""
        return self.lengths >= LEAST_CORRECTION

    @staticmethod
    def from_correction(
        original: Reproduction | FloatArray, corrected: Reproduction | FloatArray, name: str = ""
    ) -> Constraint:
        """Make a rule of a run and its correction.

        At each station where the correction v is at least 1 mm long, the plane goes through the corrected
        place with the normal v / |v|.

        Parameters
        ----------
        original, corrected : Reproduction or (K, 3) array
            The run before and after, station by station [m].
        name : str
            How to call the rule.

        Returns
        -------
        Constraint
            Of an array, the stations are 0 to K - 1.

        Raises
        ------
        ShapeError, NotFiniteError, TooFewSamplesError
            If the two are not paths of equal length, or empty.
        """
        before = finite(_path(original), "original", (None, 3))
        after = finite(_path(corrected), "corrected", (None, 3))
        if not len(before):
            raise TooFewSamplesError("The original", 0)
        if len(before) != len(after):
            raise ShapeError("corrected", f"({len(before)}, 3), as the original,", after.shape)
        stations = (
            original.stations
            if isinstance(original, Reproduction)
            else np.arange(len(before), dtype=np.float64)
        )
        moved = after - before
        lengths = np.linalg.norm(moved, axis=1)
        active = (lengths >= LEAST_CORRECTION)[:, None]
        normals = np.where(active, moved / np.maximum(lengths, LEAST_CORRECTION)[:, None], 0.0)
        return Constraint(stations, after, normals, lengths, name)


@dataclass(frozen=True, eq=False)
class _Planes:
    """The planes of one constraint at the samples of a run."""

    points: FloatArray
    normals: FloatArray
    lengths: FloatArray
    active: BoolArray


def constrain(reproduction: Reproduction, constraints: Sequence[Constraint]) -> Reproduction:
    """Move a run to the allowed side of all rules, and no further.

    At every station the nearest point of the intersection of the half-spaces is taken. Beyond the ends of
    a corrected span, what the run was moved in excess of the teacher's own correction there fades
    out over 8 cm.

    Parameters
    ----------
    reproduction : Reproduction
        One run or several; not changed.
    constraints : sequence of Constraint
        In any order; rules that are off are left out.

    Returns
    -------
    Reproduction
        The same object when no sample is behind a plane. Ratios stay those of the unconstrained run. Where
        rules contradict each other, the violation is as small as one of their corners allows.

    References
    ----------
    .. [1] S. R. Ahmadzadeh, M. A. Rana, S. Chernova. Generalized Cylinders for Learning, Reproduction,
       Generalization, and Refinement of Robot Skills. RSS 2017, Sec. VI-B (it does not define the planes).
       doi:10.15607/RSS.2017.XIII.021
    """
    if not constraints:
        return reproduction
    planes = [_planes(constraint, reproduction.stations) for constraint in constraints]
    single = reproduction.positions.ndim == 2
    runs = reproduction.positions[None] if single else reproduction.positions
    moved = np.array([_moved(run, planes) for run in runs]).reshape(runs.shape)
    if np.array_equal(moved, runs):
        return reproduction
    return replace(reproduction, positions=moved[0] if single else moved)


def _path(run: Reproduction | FloatArray) -> FloatArray:
    return run.positions if isinstance(run, Reproduction) else run


def _planes(constraint: Constraint, stations: FloatArray) -> _Planes:
    """Planes at stations (K,): those of the corrected run's nearest station, within half a station."""
    edges = 0.5 * (constraint.stations[1:] + constraint.stations[:-1])
    index = np.searchsorted(edges, stations)
    here = np.abs(constraint.stations[index] - stations) <= 0.5
    return _Planes(
        constraint.points[index],
        constraint.normals[index],
        constraint.lengths[index],
        here & constraint.active[index],
    )


def _moved(run: FloatArray, planes: Sequence[_Planes]) -> FloatArray:
    """Move one run (K, 3) behind no plane; untouched samples stay bit-identical."""
    faded = sum((_faded(run, one) for one in planes), np.zeros_like(run))
    touched = (faded != 0.0).any(axis=1)
    begun = np.where(touched[:, None], run + faded, run)
    depth = np.stack([_depth(begun, one) for one in planes], axis=1)
    behind = np.flatnonzero((depth < 0.0).any(axis=1))
    if not behind.size:
        return begun
    moved = begun.copy()
    points = np.stack([one.points[behind] for one in planes], axis=1)
    normals = np.stack([np.where(one.active[:, None], one.normals, 0.0)[behind] for one in planes], axis=1)
    moved[behind] = nearest_allowed(begun[behind], points, normals)
    return moved


def _depth(run: FloatArray, planes: _Planes) -> FloatArray:
    """Signed distance (K,) before the plane; 0 where there is none."""
    return np.where(planes.active, np.einsum("ij,ij->i", run - planes.points, planes.normals), 0.0)


def _faded(run: FloatArray, planes: _Planes) -> FloatArray:
    """Displacement (K, 3) beyond the ends of the spans, for one constraint."""
    push = np.maximum(-_depth(run, planes), 0.0)
    excess = np.where(planes.active, np.maximum(push - planes.lengths, 0.0), 0.0)[:, None] * planes.normals
    if not excess.any() or planes.active.all():
        return np.zeros_like(run)
    gone = arc_length(run)
    index = np.arange(len(run))
    before = np.maximum.accumulate(np.where(planes.active, index, -1))
    after = np.minimum.accumulate(np.where(planes.active, index, len(run))[::-1])[::-1]
    share_before = np.where(before >= 0, _fade(gone - gone[np.maximum(before, 0)]), 0.0)
    share_after = np.where(after < len(run), _fade(gone[np.minimum(after, len(run) - 1)] - gone), 0.0)
    total = np.maximum(share_before + share_after, 1.0)
    moved = (share_before / total)[:, None] * excess[np.maximum(before, 0)]
    moved = moved + (share_after / total)[:, None] * excess[np.minimum(after, len(run) - 1)]
    return np.where(planes.active[:, None], 0.0, moved)


def _fade(away: FloatArray) -> FloatArray:
    return fading(np.clip(away / FADE_LENGTH, 0.0, 1.0))


def nearest_allowed(places: FloatArray, points: FloatArray, normals: FloatArray) -> FloatArray:
    """Nearest point of an intersection of half-spaces, for many places at once.

    Parameters
    ----------
    places : (P, 3) array
        [m].
    points, normals : (P, C, 3) array
        A point of each plane [m], and its unit normal towards the allowed side; a normal of 0 allows all.

    Returns
    -------
    (P, 3) array
        Exact: every set of up to three planes that could meet there is tried. Where the half-spaces have no
        common point, the tried point with the least violation.
    """
    offset = np.einsum("pci,pci->pc", points - places[:, None], normals)
    best = np.zeros_like(places)
    best_cost = _cost(best, offset, normals)
    for size in range(1, min(CORNERS, normals.shape[1]) + 1):
        for chosen in combinations(range(normals.shape[1]), size):
            some = normals[:, chosen, :]
            gram = some @ np.swapaxes(some, 1, 2)
            step = np.einsum("pk,pki->pi", (np.linalg.pinv(gram) @ offset[:, chosen, None])[..., 0], some)
            cost = _cost(step, offset, normals)
            better = cost < best_cost
            best[better], best_cost[better] = step[better], cost[better]
    return places + best


def _cost(step: FloatArray, offset: FloatArray, normals: FloatArray) -> FloatArray:
    """Length of steps (P, 3), after any violation: a step that obeys all rules is always cheaper."""
    violation = np.maximum(offset - np.einsum("pci,pi->pc", normals, step), 0.0).max(axis=1)
    return np.linalg.norm(step, axis=1) + np.where(violation > ALLOWED, 1e6 * (1.0 + violation), 0.0)
