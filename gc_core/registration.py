"""The smooth map of space that takes landmarks from where they were to where they are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.distance import cdist

from gc_core.arrays import FloatArray, IntArray, finite, read_only_fields
from gc_core.errors import InvalidSettingError, LandmarkMismatchError
from gc_core.landmarks import Landmark, acting_points, landmarks, rotation

SAME_PLACE = 1e-9
"""Landmarks nearer than this are one [m]."""

FLAT = 1e-6
"""Landmarks whose spread across a direction is below this part of their extent have none there [-]."""

GREATEST_SHEAR = np.deg2rad(60.0)
"""Flat or straight arrangements that turn by less are sheared; others are turned first [rad]."""

LEAST_STRETCH = 0.05
"""Two landmarks are never brought closer than to this part of their distance: space would collapse [-]."""


@dataclass(frozen=True, eq=False)
class ThinPlateSpline:
    """z(x) = target_mean + A (x - source_mean) + sum w_n (-|s_n - x|) / scale.

    Made by `fit` or `register`. The domain is scaled by the spread of the landmarks, so that
    lambda has no unit.
    """

    centres: FloatArray
    """(L, 3) distinct source landmarks s_n; none where the map is affine [m]."""
    weights: FloatArray
    """(L, 3) weights w_n [m]."""
    linear: FloatArray
    """(3, 3) A [-]."""
    origin: FloatArray
    """(3,) source_mean [m]."""
    image: FloatArray
    """(3,) target_mean [m]."""
    scale: float
    """Spread of the landmarks [m]."""
    bending_energy: float
    """Sum over coordinates of w^T K w / scale; 0 for an affine map [m^2]."""
    rank: int
    """Dimensions that the source landmarks span: 0 a point, 1 a line, 2 a plane, 3 space."""
    case: str
    """Name of the case in words."""
    residual: float
    """Greatest distance between a moved source landmark and its target [m]."""

    def __post_init__(self) -> None:
        read_only_fields(self)

    @staticmethod
    def fit(source: ArrayLike, target: ArrayLike, regularization: float = 0.0) -> ThinPlateSpline:
        """Fit the smoothest map that takes points to points.

        Where the points span less than space, the map leaves the other directions as they are: the affine
        part is as near the identity as can be. Landmarks on a line or plane that turn by 60 degrees or more
        are turned by the smallest rotation first, since a shear would mirror them.

        Parameters
        ----------
        source, target : (L, 3) array
            Landmarks before and after; any number L >= 0, coincident ones are merged [m].
        regularization : float
            lambda >= 0: 0 meets the targets exactly, more bends less [-].

        Returns
        -------
        ThinPlateSpline

        Raises
        ------
        ShapeError, NotFiniteError
            If the points are not finite places.
        LandmarkMismatchError
            If there are not as many targets as sources.
        InvalidSettingError
            If the regularization is negative or not finite.

        References
        ----------
        .. [1] F. L. Bookstein. Principal warps: thin-plate splines and the decomposition of deformations.
           IEEE PAMI 11(6), 1989. doi:10.1109/34.24792
        """
        before = finite(np.reshape(source, (-1, 3)) if np.size(source) == 0 else source, "source", (None, 3))
        after = finite(np.reshape(target, (-1, 3)) if np.size(target) == 0 else target, "target", (None, 3))
        if len(before) != len(after):
            raise LandmarkMismatchError(len(before), len(after))
        if not 0.0 <= regularization < np.inf:
            raise InvalidSettingError("regularization", regularization, "a number of at least 0")
        if not len(before):
            return _affine(np.eye(3), np.zeros(3), np.zeros(3), "no landmarks: nothing moves", rank=0)
        return _fit(before, after, regularization)

    def __call__(self, points: ArrayLike) -> FloatArray:
        """Map points.

        Parameters
        ----------
        points : (..., 3) array
            [m].

        Returns
        -------
        (..., 3) array
            Where they go [m].
        """
        points = np.asarray(points, dtype=np.float64)
        mapped = (points - self.origin) @ self.linear.T + self.image
        if not len(self.weights):
            return mapped
        flat = points.reshape(-1, 3)
        return mapped + (_kernel(flat, self.centres, self.scale) @ self.weights).reshape(points.shape)

    def jacobian(self, points: ArrayLike) -> FloatArray:
        """Derivative of the map.

        Parameters
        ----------
        points : (P, 3) array
            [m].

        Returns
        -------
        (P, 3, 3) array
            Row: output, column: input. At a landmark, where the kernel has a corner, its part is 0 [-].
        """
        points = np.asarray(points, dtype=np.float64)
        if not len(self.weights):
            return np.broadcast_to(self.linear, (len(points), 3, 3)).copy()
        away = points[:, None, :] - self.centres
        distance = np.sqrt(np.einsum("pli,pli->pl", away, away))[..., None]
        unit = np.where(distance > SAME_PLACE, away / np.maximum(distance, SAME_PLACE), 0.0)
        return self.linear - np.einsum("lo,pli->poi", self.weights, unit) / self.scale


def register(
    source: Sequence[Landmark] | FloatArray,
    target: Sequence[Landmark] | FloatArray,
    regularization: float = 0.0,
) -> ThinPlateSpline:
    """Find the map of space that takes landmarks from where they were to where they are.

    None: nothing moves. One: a translation, or a rigid motion for a frame. Two: the map that changes least
    and moves both. More: a thin-plate spline. A landmark that has an orientation in both lists is a frame
    and acts through seven points: its origin and 0.1 m out on each half-axis.

    Parameters
    ----------
    source, target : sequences of L Landmark, or (L, 3) arrays
        Paired by order [m].
    regularization : float
        lambda >= 0; 0 meets the targets exactly [-].

    Returns
    -------
    ThinPlateSpline
        Its `case` says in words which case it is, `residual` how far the targets are missed.

    Raises
    ------
    LandmarkMismatchError
        If there are not as many targets as sources.
    ShapeError, NotFiniteError, InvalidSettingError
        If the points or the regularization are not valid.
    """
    before, after = landmarks(source), landmarks(target)
    if len(before) != len(after):
        raise LandmarkMismatchError(len(before), len(after))
    pairs = [acting_points(a, b) for a, b in zip(before, after, strict=True)]
    if not pairs:
        return ThinPlateSpline.fit(np.zeros((0, 3)), np.zeros((0, 3)), regularization)
    places, moved = (np.concatenate(side) for side in zip(*pairs, strict=True))
    if len(pairs) == 1 and len(places) > 1:
        (a, b), (one, two) = (before[0], after[0]), (rotation(before[0]), rotation(after[0]))
        return _affine(two @ one.T, a.position, b.position, "one frame: a rigid motion", rank=3)
    return ThinPlateSpline.fit(places, moved, regularization)


def _affine(
    linear: FloatArray, origin: FloatArray, image: FloatArray, case: str, *, rank: int
) -> ThinPlateSpline:
    none = np.zeros((0, 3))
    return ThinPlateSpline(none, none, linear, origin, image, 1.0, 0.0, rank, case, 0.0)


def _merged(source: FloatArray, target: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Replace coincident sources (L, 3) by one, with the mean of their targets."""
    apart = np.linalg.norm(source[:, None] - source[None], axis=2)
    group: IntArray = np.argmax(apart <= SAME_PLACE, axis=1)
    keep, member = np.unique(group, return_inverse=True)
    total = np.zeros((len(keep), 3))
    np.add.at(total, member, target)
    counts = np.bincount(member).astype(np.float64)[:, None]
    return source[keep], np.asarray(total / counts, dtype=np.float64)


def _fit(all_sources: FloatArray, all_targets: FloatArray, regularization: float) -> ThinPlateSpline:
    source, target = _merged(all_sources, all_targets)
    origin, image = source.mean(axis=0), target.mean(axis=0)
    centred, moved = source - origin, target - image
    axes = _spanned_axes(centred)
    rank = len(axes)
    scale = float(np.sqrt((centred**2).sum() / len(source))) or 1.0
    turn = _turn(centred, moved) if 0 < rank < 3 else np.eye(3)
    if len(source) == 2:
        moved = _not_collapsed(centred, moved)
    spanned = axes.T
    weights, stretch = _solve(source, centred @ spanned, moved - centred @ turn.T, scale, regularization)
    # The kernel's mean goes into the image, so that `image` is where `origin` would go without bending.
    linear = turn + stretch[1:].T @ spanned.T
    energy = float(np.einsum("li,lm,mi->", weights, _kernel(source, source, scale), weights)) / scale
    spline = ThinPlateSpline(
        centres=source if rank + 1 < len(source) else np.zeros((0, 3)),
        weights=weights if rank + 1 < len(source) else np.zeros((0, 3)),
        linear=linear,
        origin=origin,
        image=image + stretch[0],
        scale=scale,
        bending_energy=max(energy, 0.0),
        rank=rank,
        case=_case(len(source), rank, not np.array_equal(turn, np.eye(3)), len(all_sources) - len(source)),
        residual=0.0,
    )
    return replace(spline, residual=float(np.linalg.norm(spline(all_sources) - all_targets, axis=1).max()))


def _spanned_axes(centred: FloatArray) -> FloatArray:
    """Orthonormal directions (rank, 3) in which points (L, 3) about their mean differ."""
    spread, axes = np.linalg.eigh(centred.T @ centred)
    sizes = np.sqrt(np.maximum(spread, 0.0))
    return np.asarray(axes.T[sizes > max(FLAT * float(sizes[-1]), SAME_PLACE)], dtype=np.float64)


def _solve(
    source: FloatArray, coordinates: FloatArray, displacement: FloatArray, scale: float, regularization: float
) -> tuple[FloatArray, FloatArray]:
    """Weights (L, 3) and polynomial (1 + rank, 3) of the displacement (L, 3)."""
    count, rank = coordinates.shape
    system = np.zeros((count + rank + 1, count + rank + 1))
    system[:count, :count] = _kernel(source, source, scale) + regularization * np.eye(count)
    system[:count, count] = 1.0
    system[:count, count + 1 :] = coordinates / scale
    system[count:, :count] = system[:count, count:].T
    right = np.concatenate((displacement, np.zeros((rank + 1, 3))))
    solution = np.asarray(np.linalg.solve(system, right), dtype=np.float64)
    polynomial = solution[count:]
    return solution[:count], np.concatenate((polynomial[:1], polynomial[1:] / scale))


def _kernel(points: FloatArray, centres: FloatArray, scale: float) -> FloatArray:
    """-|x - s| / scale, (P, L) array."""
    return np.asarray(cdist(points, centres), dtype=np.float64) * (-1.0 / scale)


def _turn(source: FloatArray, target: FloatArray) -> FloatArray:
    """Smallest rotation (3, 3) of a flat arrangement onto its target; identity below 60 degrees."""
    left, sizes, right = np.linalg.svd(target.T @ source)
    if sizes[0] <= SAME_PLACE**2:
        return np.eye(3)
    if sizes[1] <= FLAT * sizes[0]:
        rotation = _between(right[0], left[:, 0])
    else:
        rotation = left @ np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))]) @ right
    angle = np.arccos(np.clip(0.5 * (np.trace(rotation) - 1.0), -1.0, 1.0))
    return np.eye(3) if angle < GREATEST_SHEAR else rotation


def _between(a: FloatArray, b: FloatArray) -> FloatArray:
    """Smallest rotation (3, 3) of unit vector a to b; opposite ones turn about the most upright axis."""
    axis, cos = np.cross(a, b), float(a @ b)
    if cos < -1.0 + 1e-9:
        up = np.array([0.0, 0.0, 1.0]) if abs(a[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
        axis = up - (up @ a) * a
        axis = axis / np.linalg.norm(axis)
        return 2.0 * np.outer(axis, axis) - np.eye(3)
    cross = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    return np.eye(3) + cross + cross @ cross / (1.0 + cos)


def _not_collapsed(source: FloatArray, target: FloatArray) -> FloatArray:
    """Keep two targets (2, 3) about their mean from falling into one place."""
    chord, wanted = source[1] - source[0], target[1] - target[0]
    least = LEAST_STRETCH * float(np.linalg.norm(chord))
    length = float(np.linalg.norm(wanted))
    if length >= least:
        return target
    direction = wanted / length if length > SAME_PLACE else chord / np.linalg.norm(chord)
    return np.array([-0.5, 0.5])[:, None] * least * direction


def _case(count: int, rank: int, turned: bool, merged: int) -> str:
    """Name of the case in words."""
    if rank == 0:
        words = "one landmark: a translation"
    elif count == 2:
        words = (
            "two landmarks: a turn, then a stretch along them"
            if turned
            else "two landmarks: a stretch along them"
        )
    elif rank == 3:
        words = "an affine map" if count == 4 else "a thin-plate spline"
    else:
        shape = "on a line" if rank == 1 else "in a plane"
        first = "turn, then a " if turned else ""
        words = f"landmarks {shape}: a {first}thin-plate spline that keeps what is across"
    return words + (f" ({merged} in the same place merged)" if merged else "")
