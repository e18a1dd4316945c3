"""Rules: a corrected run keeps later runs on its side, where they would pass it.

A rule belongs to parts of the way, from 0 at the beginning of the skill to 1 at its end, and not to
numbers of stations: it means the same for runs with more stations, and for runs that join later.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gc_core.arrays import BoolArray, FloatArray, finite, interpolated, read_only_fields
from gc_core.errors import ShapeError, TooFewSamplesError
from gc_core.half_spaces import ALLOWED, step_to_allowed
from gc_core.planes import Planes, asked
from gc_core.registration import ThinPlateSpline
from gc_core.reproduction import Reproduction

LEAST_CORRECTION = 0.001
"""A station where the correction is shorter makes no plane [m]."""

SAME_PART = 1e-9
"""Parts of the way that differ by less are the same."""

SINGULAR = 1e-12
"""A map that changes volumes by less than this has no inverse [-]."""


@dataclass(frozen=True, eq=False)
class Constraint:
    """Half-spaces along a corrected run: behind a plane nothing may pass. Made by `from_correction`."""

    stations: FloatArray
    """(K,) stations of the run, increasing; the last is the last of the skill [-]."""
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
    def parts(self) -> FloatArray:
        """(K,) the part of the way at each station, up to 1 [-]."""
        return _parts(self.stations)

    @property
    def active(self) -> BoolArray:
        """(K,) where there is a plane."""
        return self.lengths >= LEAST_CORRECTION

    @property
    def moves(self) -> FloatArray:
        """(K, 3) the corrections v; transposed they are the refinement matrix V, 0 below 1 mm [m]."""
        return self.lengths[:, None] * self.normals

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
            The samples of an array are spread evenly over the whole way; a run knows where it joined.

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

    def carried(self, registration: ThinPlateSpline) -> Constraint:
        """Move the rule with the space around it.

        Parameters
        ----------
        registration : ThinPlateSpline
            Map of space, from `register`.

        Returns
        -------
        Constraint
            Points go where the map takes them; each plane becomes the tangent plane of its image, and its
            allowed side stays allowed. Wherever there was a plane there is one.
        """
        inverse = _inverse_transposed(registration.jacobian(self.points))
        return self._turned(registration(self.points), inverse)

    def taken_back(self, registration: ThinPlateSpline, places: FloatArray) -> Constraint:
        """Undo `carried`.

        Parameters
        ----------
        registration : ThinPlateSpline
            Map of space, from `register`.
        places : (K, 3) array
            The places that the map takes to the rule's points [m].

        Returns
        -------
        Constraint
            The rule as it was before the map.

        Raises
        ------
        ShapeError, NotFiniteError
            If the places are not as many finite places.
        """
        before = finite(places, "places", (len(self.points), 3))
        return self._turned(before, np.swapaxes(registration.jacobian(before), 1, 2))

    def _turned(self, points: FloatArray, turn: FloatArray) -> Constraint:
        """Give it other points (K, 3), and the normals that matrices (K, 3, 3) make of its own."""
        normals = np.einsum("kij,kj->ki", turn, self.normals)
        stretch = np.linalg.norm(normals, axis=1)
        active = self.active & (stretch > 0.0)
        stretch = np.where(active, stretch, 1.0)
        lengths = np.where(active, np.maximum(self.lengths / stretch, LEAST_CORRECTION), self.lengths)
        return replace(self, points=points, normals=normals / stretch[:, None], lengths=lengths)


def constrain(reproduction: Reproduction, constraints: Sequence[Constraint]) -> Reproduction:
    """Move a run to the allowed side of all rules, and no further.

    At every station the nearest place of the intersection of the half-spaces is taken. Beyond the ends of
    a corrected span, what the run was moved in excess of the teacher's own correction there fades
    out over 8 cm, or over as much as that excess where it is more.

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
        rules contradict each other (`contradictions`), the violation is as small as one of their corners
        allows.

    References
    ----------
    .. [1] S. R. Ahmadzadeh, M. A. Rana, S. Chernova. Generalized Cylinders for Learning, Reproduction,
       Generalization, and Refinement of Robot Skills. RSS 2017, Sec. VI-B (it does not define the planes).
       doi:10.15607/RSS.2017.XIII.021
    """
    if not constraints:
        return reproduction
    single = reproduction.positions.ndim == 2
    runs = reproduction.positions[None] if single else reproduction.positions
    moved = np.empty_like(runs)
    for index, run in enumerate(runs):
        planes = [planes_along(constraint, reproduction.stations, run) for constraint in constraints]
        moved[index] = _moved(run, planes)
    if np.array_equal(moved, runs):
        return reproduction
    return replace(reproduction, positions=moved[0] if single else moved)


def planes_at(constraint: Constraint, parts: FloatArray) -> Planes:
    """Planes of a rule at parts of the way.

    Parameters
    ----------
    constraint : Constraint
    parts : (P,) array
        From 0 to 1 [-].

    Returns
    -------
    Planes
        Where the rule has a station, its own plane; between two of them, through the corrected path, across
        the correction interpolated. None before the corrected run began.
    """
    known, moves = constraint.parts, constraint.moves
    points, moved = (
        np.stack([interpolated(parts, known, column) for column in values.T], axis=1)
        for values in (constraint.points, moves)
    )
    lengths = interpolated(parts, known, constraint.lengths)
    size = np.sqrt(np.einsum("ij,ij->i", moved, moved))
    active = (lengths >= LEAST_CORRECTION) & (size > 0.0) & (parts >= known[0] - SAME_PART)
    normals = np.where(active[:, None], moved / np.where(size > 0.0, size, 1.0)[:, None], 0.0)
    return Planes(points, normals, lengths, active)


def planes_along(constraint: Constraint, stations: FloatArray, run: FloatArray) -> Planes:
    """Planes of a rule at the samples of one run.

    Parameters
    ----------
    constraint : Constraint
    stations : (K,) array
        Of the samples; the last is the last of the skill [-].
    run : (K, 3) array
        [m].

    Returns
    -------
    Planes
        A run that joins later than others waits at its start, where rules for before do not concern it.
    """
    parts = _parts(stations)
    return planes_at(constraint, np.maximum(parts, parts[_waiting(run)]) if len(run) else parts)


def _path(run: Reproduction | FloatArray) -> FloatArray:
    return run.positions if isinstance(run, Reproduction) else run


def _parts(stations: FloatArray) -> FloatArray:
    """Parts of the way (K,) at the stations of a run (K,): all runs go on to the last station."""
    return stations / stations[-1] if stations[-1] > 0.0 else np.ones_like(stations)


def _inverse_transposed(jacobian: FloatArray) -> FloatArray:
    """Inverse transposes (K, 3, 3) of Jacobians, finite also where these have no inverse."""
    a, b, c = (jacobian[:, :, column] for column in range(3))
    cofactors = np.stack((np.cross(b, c), np.cross(c, a), np.cross(a, b)), axis=2)
    volume = np.einsum("ki,ki->k", a, cofactors[:, :, 0])
    volume = np.where(np.abs(volume) < SINGULAR, np.copysign(SINGULAR, volume), volume)
    return cofactors / volume[:, None, None]


def _waiting(run: FloatArray) -> int:
    """Sample of a run (K, 3) up to which it waits at its start."""
    gone = (run != run[0]).any(axis=1)
    return int(np.argmax(gone)) - 1 if gone.any() else 0


def _moved(run: FloatArray, planes: Sequence[Planes]) -> FloatArray:
    """Move one run (K, 3) behind no plane; untouched samples stay bit-identical."""
    behind, normals = asked(run, planes)
    rows = np.flatnonzero((behind > ALLOWED).any(axis=1))
    if not rows.size:
        return run
    moved = run.copy()
    moved[rows] += step_to_allowed(behind[rows], normals[rows])
    return moved
