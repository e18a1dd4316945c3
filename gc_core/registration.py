"""The smooth map of space that takes landmarks from where they were to where they are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.distance import cdist

from gc_core.arrays import BoolArray, FloatArray, finite, read_only_fields
from gc_core.errors import InvalidSettingError, LandmarkMismatchError
from gc_core.landmarks import ACTING, Landmark, acting_points, landmarks, rotation
from gc_core.rank_cases import (
    SAME_PLACE,
    change_of_affine,
    dimensions,
    first_turn,
    merged,
    not_collapsed,
    spread,
    words,
)

STRAIGHT = 1e-11
"""A map whose weights are below this part of the landmarks' spread is affine: that is rounding [-]."""


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
    """Sum over coordinates of w^T K w / scale; 0 for an affine map. Times 8 pi it is the integral over all
    space of the squared second derivatives [m]."""
    rank: int
    """Dimensions that the source landmarks span: 0 a point, 1 a line, 2 a plane, 3 space."""
    case: str
    """Name of the case in words."""
    residual: float
    """Greatest distance between a moved source landmark and its target [m]."""

    def __post_init__(self) -> None:
        read_only_fields(self)

    @staticmethod
    def fit(
        source: ArrayLike, target: ArrayLike, regularization: float = 0.0, stiffness: float = 0.0
    ) -> ThinPlateSpline:
        """Fit the smoothest map that takes points to points.

        Where the points span less than space, the map leaves the other directions as they are: the affine
        part is as near the identity as can be. Landmarks on a line or plane that turn by much are turned
        first, since a shear would mirror them. All this comes gradually as landmarks approach a line or plane
        (`gc_core.rank_cases`).

        Parameters
        ----------
        source, target : (L, 3) array
            Landmarks before and after; any number L >= 0, coincident ones are merged [m].
        regularization : float
            lambda >= 0: 0 meets the targets exactly, more bends less [-].
        stiffness : float
            mu >= 0: mu |A - I|^2 is minimized with the bending energy. At 0, as in the paper, one landmark of
            four shears all space; the more, the more local a pull is. The targets are met all the same [m].

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
            If the regularization or the stiffness is negative or not finite.

        References
        ----------
        .. [1] F. L. Bookstein. Principal warps: thin-plate splines and the decomposition of deformations.
           IEEE PAMI 11(6), 1989. doi:10.1109/34.24792

        Notes
        -----
        Where the landmarks span space this is SciPy's ``RBFInterpolator(kernel="linear", degree=1)`` over the
        scaled domain, and tested against it. It is not used: it refuses landmarks that span less, has no
        Jacobian, and takes longer for few centres than the whole of a drag may.
        """
        before = finite(np.reshape(source, (-1, 3)) if np.size(source) == 0 else source, "source", (None, 3))
        after = finite(np.reshape(target, (-1, 3)) if np.size(target) == 0 else target, "target", (None, 3))
        if len(before) != len(after):
            raise LandmarkMismatchError(len(before), len(after))
        for name, value in (("regularization", regularization), ("stiffness", stiffness)):
            if not 0.0 <= value < np.inf:
                raise InvalidSettingError(name, value, "a number of at least 0")
        if not len(before):
            return _affine(np.eye(3), np.zeros(3), np.zeros(3), "no landmarks: nothing moves", rank=0)
        return _fit(before, after, regularization, stiffness)

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
        return map_columns(self, points.reshape(-1, 3).T).T.reshape(points.shape)

    def jacobian(self, points: ArrayLike) -> FloatArray:
        """Derivative of the map.

        Parameters
        ----------
        points : (P, 3) array
            [m].

        Returns
        -------
        (P, 3, 3) array
            Row: output, column: input. At a landmark, where the map has a corner, the mean of all sides [-].
        """
        points = np.asarray(points, dtype=np.float64)
        if not len(self.weights):
            return np.broadcast_to(self.linear, (len(points), 3, 3)).copy()
        return self.linear - _bending(self, points).transpose(2, 1, 0)


def map_columns(spline: ThinPlateSpline, points: FloatArray) -> FloatArray:
    """Map points (3, P) that are given and returned column by column [m]."""
    mapped = spline.linear @ (points - spline.origin[:, None])
    mapped += spline.image[:, None]
    if len(spline.weights):
        mapped += spline.weights.T @ _kernel(spline.centres, points.T, spline.scale)
    return mapped


def has_corner(spline: ThinPlateSpline, points: FloatArray) -> BoolArray:
    """Tell at which points (P, 3) [m] a map has a corner, because a landmark is there: (P,)."""
    if not len(spline.weights):
        return np.zeros(len(points), dtype=bool)
    return np.asarray(cdist(points, spline.centres).min(axis=1) <= SAME_PLACE)


def turns_inside_out(spline: ThinPlateSpline, points: FloatArray) -> BoolArray:
    """Tell where a map turns space inside out.

    Parameters
    ----------
    spline : ThinPlateSpline
    points : (P, 3) array
        [m].

    Returns
    -------
    (P,) array of bool
        Where the determinant of the Jacobian is 0 or less.
    """
    most = np.sqrt(np.einsum("lo,lo->l", spline.weights, spline.weights)).sum() / spline.scale
    if most < float(np.linalg.svd(spline.linear, compute_uv=False)[-1]):
        # The bending cannot undo the affine part anywhere.
        return np.full(len(points), float(np.linalg.det(spline.linear)) <= 0.0)
    x, y, z = spline.linear.T[:, :, None] - _bending(spline, points)
    normal = (y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0])
    return x[0] * normal[0] + x[1] * normal[1] + x[2] * normal[2] <= 0.0


def _bending(spline: ThinPlateSpline, points: FloatArray) -> FloatArray:
    """What bending takes from the Jacobian at points (P, 3): (3, 3, P), input coordinate first."""
    away = np.ascontiguousarray(points.T)[:, None] - spline.centres.T[:, :, None]
    square = away[0] * away[0]
    square += away[1] * away[1]
    square += away[2] * away[2]
    distance = np.sqrt(square, out=square)
    distance[distance <= SAME_PLACE] = np.inf
    away /= distance
    return (spline.weights.T / spline.scale) @ away


def register(
    source: Sequence[Landmark] | FloatArray,
    target: Sequence[Landmark] | FloatArray,
    regularization: float = 0.0,
    *,
    stiffness: float = 0.0,
) -> ThinPlateSpline:
    """Find the map of space that takes landmarks from where they were to where they are.

    None: nothing moves. One: a translation, or a rigid motion for a frame. Two: the map that changes least
    and moves both. More: a thin-plate spline. A landmark that has an orientation in both lists is a frame
    and acts through seven points: its origin and 0.1 m out on each half-axis.

    Parameters
    ----------
    source, target : sequences of L Landmark, or (L, 3) arrays
        Paired by order [m].
    regularization, stiffness : float
        lambda [-] and mu [m], at least 0, see `ThinPlateSpline.fit`; both 0 as in the paper.

    Returns
    -------
    ThinPlateSpline
        Its `case` says in words which case it is, `residual` how far the targets are missed.

    Raises
    ------
    LandmarkMismatchError
        If there are not as many targets as sources.
    ShapeError, NotFiniteError, InvalidSettingError
        If the points, the regularization or the stiffness are not valid.
    """
    before, after = landmarks(source), landmarks(target)
    if len(before) != len(after):
        raise LandmarkMismatchError(len(before), len(after))
    pairs = [acting_points(a, b) for a, b in zip(before, after, strict=True)]
    if not pairs:
        return ThinPlateSpline.fit(np.zeros((0, 3)), np.zeros((0, 3)), regularization, stiffness)
    places, moved = (np.concatenate(side) for side in zip(*pairs, strict=True))
    if len(pairs) == 1 and len(places) > 1:
        (a, b), (one, two) = (before[0], after[0]), (rotation(before[0]), rotation(after[0]))
        return _affine(two @ one.T, a.position, b.position, "one frame: a rigid motion", rank=3)
    spline = ThinPlateSpline.fit(places, moved, regularization, stiffness)
    frames = (len(places) - len(pairs)) // (ACTING - 1)
    if not frames:
        return spline
    plural = "s" if frames > 1 else ""
    return replace(spline, case=f"{spline.case}, with {frames} frame{plural} of {ACTING} points each")


def _affine(
    linear: FloatArray, origin: FloatArray, image: FloatArray, case: str, *, rank: int
) -> ThinPlateSpline:
    none = np.zeros((0, 3))
    return ThinPlateSpline(none, none, linear, origin, image, 1.0, 0.0, rank, case, 0.0)


def _fit(
    sources: FloatArray, targets: FloatArray, regularization: float, stiffness: float
) -> ThinPlateSpline:
    source, target = merged(sources, targets)
    origin, image = source.mean(axis=0), target.mean(axis=0)
    centred, moved = source - origin, target - image
    scale = spread(centred)
    rank, strong = dimensions(centred / scale)
    turn = first_turn(centred, moved) if strong and (strong < 3 or stiffness) else np.eye(3)
    if rank:
        moved = not_collapsed(centred, moved, turn)
    wanted = (moved - centred @ turn.T) / scale
    weights, shift, change = _solve(centred / scale, wanted, regularization, stiffness / scale)
    bent = bool(np.abs(weights).max() > STRAIGHT)
    weights = weights * scale
    kernel = _kernel(source, source, scale)
    turned, lost = not np.array_equal(turn, np.eye(3)), len(sources) - len(source)
    spline = ThinPlateSpline(
        centres=source if bent else np.zeros((0, 3)),
        weights=weights if bent else np.zeros((0, 3)),
        linear=turn + change.T,
        origin=origin,
        image=image + scale * shift,
        scale=scale,
        bending_energy=max(float(np.einsum("li,lm,mi->", weights, kernel, weights)) / scale, 0.0) * bent,
        rank=rank,
        case=words(len(source), rank, strong, turned=turned, stiff=stiffness > 0.0, merged_count=lost),
        residual=0.0,
    )
    return replace(spline, residual=float(np.linalg.norm(spline(sources) - targets, axis=1).max()))


def _solve(
    scaled: FloatArray, displacement: FloatArray, regularization: float, stiffness: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Weights (L, 3), shift (3,) and change of the affine part (3, 3) that displace landmarks (L, 3).

    Landmarks are about their mean and displaced in units of their spread, which is 1. The weights meet the
    displacement whatever the affine part is.
    """
    count = len(scaled)
    system = np.zeros((count + 1, count + 1))
    system[:count, :count] = _kernel(scaled, scaled, 1.0)
    system.flat[: count * (count + 1) : count + 2] += regularization
    system[:count, count] = system[count, :count] = 1.0
    right = np.concatenate((np.concatenate((scaled, displacement), axis=1), np.zeros((1, 6))))
    solution = np.asarray(np.linalg.solve(system, right), dtype=np.float64)
    by_place, by_displacement = solution[:, :3], solution[:, 3:]
    gain, wanted = scaled.T @ by_place[:count], scaled.T @ by_displacement[:count]
    change = change_of_affine(scaled, gain, wanted, stiffness)
    solved = by_displacement - by_place @ change
    return solved[:count], solved[count], change


def _kernel(points: FloatArray, centres: FloatArray, scale: float) -> FloatArray:
    """-|x - s| / scale, (P, L) array."""
    return np.asarray(cdist(points, centres), dtype=np.float64) * (-1.0 / scale)
