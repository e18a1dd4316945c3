"""When the joints pass each point of a path: as fast as speed and acceleration limits allow.

The joints of a solved path tremble by a tenth of a milliradian, which is nothing to
see and everything to an acceleration; so a smoothing spline is timed, and both limits are
checked on it at 1 kHz. What is left too fast by the grid is slowed down as a whole.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Protocol, cast

import numpy as np
import numpy.typing as npt
from scipy import interpolate  # pyright: ignore[reportMissingTypeStubs] - SciPy has none here

from app.arm.errors import ArmInputError
from app.arm.protocol import FloatArray

RATE = 1000.0
"""Limits are checked this often [1/s]."""
SMOOTHED = 2e-4
"""The timed joints keep this near to the given ones, in the root mean square [rad]."""

_STILL = 1e-6
"""A step of all joints together below this is standing still [rad]."""
_N_GRID = 600
_LEAST_SPEED = 1e-6
_MARGIN = 1.0005
"""A path is slowed down by this much more than it must be."""
# SciPy states no types that a strict checker can follow.
_interpolate = cast("Any", interpolate)


class Curve(Protocol):
    """Joints over the length of a path, and their derivatives."""

    def __call__(self, where: npt.ArrayLike, nu: int = 0) -> FloatArray:
        """Give (T, J) at lengths (T,)."""
        ...


@dataclass(frozen=True, eq=False)
class TimedPath:
    """A joint path with a time law; it begins and ends at rest."""

    times: FloatArray
    """(K,) when the joints pass each given configuration; not decreasing, from 0 [s]."""
    curve: Curve
    """Joints over the length of the path."""
    knots: FloatArray
    """(G, 3) time [s], length and its speed on a grid; the acceleration is constant in between."""

    @property
    def duration(self) -> float:
        """How long it takes [s]."""
        return float(self.knots[-1, 0])

    def at(self, times: npt.ArrayLike) -> FloatArray:
        """Give joints (T, J) at times (T,); outside the path those of its ends [rad]."""
        wanted = np.clip(np.asarray(times, dtype=np.float64), 0.0, self.duration)
        begins, length, speed = self.knots.T
        index = np.clip(np.searchsorted(begins, wanted, side="right") - 1, 0, len(begins) - 2)
        since = wanted - begins[index]
        change = np.diff(speed) / np.maximum(np.diff(begins), _LEAST_SPEED)
        return self.curve(
            np.minimum(length[index] + since * (speed[index] + 0.5 * since * change[index]), length[-1])
        )

    def sampled(self) -> FloatArray:
        """Give joints (T, J) at `RATE` [rad]."""
        return self.at(np.arange(math.ceil(self.duration * RATE) + 1) / RATE)


def retime(joints: npt.ArrayLike, speeds: FloatArray, accelerations: FloatArray) -> TimedPath:
    """Find when to pass each configuration of a path, as early as the limits allow.

    Parameters
    ----------
    joints : (K, J) array
        Configurations in order [rad]; K >= 1. Waits in it take no time.
    speeds, accelerations : (J,) array
        Largest absolute values [rad/s], [rad/s^2]; positive.

    Returns
    -------
    TimedPath
        At rest at both ends; at `RATE` no joint is faster or accelerates more than allowed.

    Raises
    ------
    ArmInputError
        If an argument has the wrong shape or is not finite.

    References
    ----------
    .. [1] H. Pham, Q.-C. Pham. A new approach to time-optimal path parameterization based on
       reachability analysis. IEEE Transactions on Robotics 34(3), 2018.
    """
    path = np.array(joints, dtype=np.float64)
    if path.ndim != 2 or len(path) == 0 or not np.isfinite(path).all():
        raise ArmInputError("a path to time", "(K, J) finite joints with K >= 1", f"shape {path.shape}")
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    if length[-1] <= _STILL:
        return _standing(path)
    curve = _smoothed(path, length)
    grid = np.linspace(0.0, float(length[-1]), _N_GRID)
    squares = _fastest(curve, grid, speeds, accelerations)
    knots = _knots(grid, squares)
    timed = TimedPath(np.interp(length, grid, knots[:, 0]), curve, knots)
    return _within(timed, speeds, accelerations)


def no_faster_than(taught: FloatArray, fastest: FloatArray) -> FloatArray:
    """Find when to pass each configuration at the pace it was taught at, slower where the arm must.

    Parameters
    ----------
    taught : (K,) array
        When each is wanted [s]; increasing.
    fastest : (K,) array
        When each can be passed at the earliest; not decreasing [s]: `TimedPath.times`.

    Returns
    -------
    (K,) array
        From 0; increasing [s]. At each place the lower of the two speeds: the arm begins and ends at rest,
        and is never faster than it can. How hard it is accelerated is limited where it is slowed down.
    """
    return np.concatenate([[0.0], np.cumsum(np.maximum(np.diff(taught), np.diff(fastest)))])


def _standing(path: FloatArray) -> TimedPath:
    """Give the path of an arm that does not move, one thousandth of a second long."""
    curve: Curve = _interpolate.BSpline(np.array([0.0, 0.0, 1.0, 1.0]), np.stack([path[0], path[0]]), 1)
    return TimedPath(np.zeros(len(path)), curve, np.array([[0.0, 0.0, 0.0], [1.0 / RATE, 0.0, 0.0]]))


def _smoothed(path: FloatArray, length: FloatArray) -> Curve:
    """Lay a smooth curve along a path (K, J), over its length (K,)."""
    fresh = np.concatenate([[True], np.diff(length) > _STILL])
    points, where = path[fresh], length[fresh]
    if len(points) <= 3:  # too few for a cubic: as they are
        where, points = _filled(where, points)
    budget = len(points) * points.shape[1] * SMOOTHED**2
    (knots, coefficients, degree), _ = _interpolate.splprep(points.T, u=where, k=3, s=budget)
    return cast("Curve", _interpolate.BSpline(knots, np.array(coefficients).T, degree))


def _filled(where: FloatArray, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Put points between few points, on straight lines."""
    dense = np.linspace(float(where[0]), float(where[-1]), 30)
    columns = [np.interp(dense, where, points[:, joint]) for joint in range(points.shape[1])]
    return dense, np.stack(columns, axis=1)


def _fastest(curve: Curve, grid: FloatArray, speeds: FloatArray, accelerations: FloatArray) -> FloatArray:
    """Give the squared speed along the path (G,) at a grid: by toppra where it is, else by two passes."""
    if find_spec("toppra") is not None:
        found = _by_toppra(curve, grid, speeds, accelerations)
        if found is not None:
            return found
    return by_two_passes(curve, grid, speeds, accelerations)


class _Geometry:
    """What toppra asks of a path."""

    def __init__(self, curve: Curve, end: float) -> None:
        self._curve = curve
        self.dof = len(curve(0.0))
        self.path_interval = np.array([0.0, end])

    def __call__(self, where: npt.ArrayLike, order: int = 0) -> FloatArray:
        return np.asarray(self._curve(where, order))


def _by_toppra(
    curve: Curve, grid: FloatArray, speeds: FloatArray, accelerations: FloatArray
) -> FloatArray | None:
    # Imported late: it brings matplotlib, which takes a second.
    algorithm: Any = import_module("toppra.algorithm")
    constraint: Any = import_module("toppra.constraint")
    limits = [
        constraint.JointVelocityConstraint(np.stack([-speeds, speeds], axis=1)),
        constraint.JointAccelerationConstraint(
            np.stack([-accelerations, accelerations], axis=1), constraint.DiscretizationType.Interpolation
        ),
    ]
    path = _Geometry(curve, float(grid[-1]))
    solved = algorithm.TOPPRA(limits, path, gridpoints=grid).compute_parameterization(0.0, 0.0)
    speed = solved[1]
    return None if speed is None or not np.isfinite(speed).all() else np.asarray(speed) ** 2


def by_two_passes(
    curve: Curve, grid: FloatArray, speeds: FloatArray, accelerations: FloatArray
) -> FloatArray:
    """Give a squared speed (G,) along a path that starts and stops in time, without any library.

    Forwards no faster than the joints can speed up, backwards no faster than they can slow down.
    """
    slope, bend, step = np.abs(curve(grid, 1)), np.abs(curve(grid, 2)), float(grid[1] - grid[0])
    by_speed = (speeds / np.maximum(slope, _LEAST_SPEED)).min(axis=1) ** 2
    squares = np.minimum(by_speed, (accelerations / np.maximum(bend, _LEAST_SPEED)).min(axis=1))
    squares[[0, -1]] = 0.0
    order = range(len(grid) - 1)
    for here, there in [*((i, i + 1) for i in order), *((i + 1, i) for i in reversed(order))]:
        left = np.maximum(accelerations - bend[here] * squares[here], 0.0)
        gain = float((left / np.maximum(slope[here], _LEAST_SPEED)).min())
        squares[there] = min(squares[there], squares[here] + 2.0 * step * gain)
    return squares


def _knots(grid: FloatArray, squares: FloatArray) -> FloatArray:
    """Turn squared speeds into times: (G, 3) time, length, speed."""
    speed = np.sqrt(np.maximum(squares, 0.0))
    mean = np.maximum(0.5 * (speed[1:] + speed[:-1]), _LEAST_SPEED)
    times = np.concatenate([[0.0], np.cumsum(np.diff(grid) / mean)])
    return np.stack([times, grid, speed], axis=1)


def _within(timed: TimedPath, speeds: FloatArray, accelerations: FloatArray) -> TimedPath:
    """Slow a path down as a whole until both limits are kept at `RATE`."""
    while (factor := too_fast(timed, speeds, accelerations)) > 1.0:
        stretch = factor * _MARGIN
        timed = TimedPath(stretch * timed.times, timed.curve, timed.knots * [stretch, 1.0, 1.0 / stretch])
    return timed


def too_fast(timed: TimedPath, speeds: FloatArray, accelerations: FloatArray) -> float:
    """Give how many times too short a duration is at `RATE`; at most 1 when both limits are kept."""
    joints = timed.sampled()
    fast = np.abs(np.diff(joints, axis=0)) * RATE / speeds
    hard = np.abs(np.diff(joints, n=2, axis=0)) * RATE**2 / accelerations
    return max(float(fast.max(initial=0.0)), math.sqrt(float(hard.max(initial=0.0))))
