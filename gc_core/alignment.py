"""Demonstrations -> stations in correspondence.

A `Clock` says for each demonstration which of its moments belongs to a common parameter in
[0, 1]; stations are then spread evenly along the mean curve, so that a pause makes no cluster
of stations and `times` keeps the taught speed.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gc_core.arrays import BoolArray, FloatArray, interpolated, read_only, remembered
from gc_core.demonstration import Demonstration, Trimmed, sign_continuous
from gc_core.errors import OpposedDemonstrationsError, UnknownOptionError
from gc_core.frames import arc_length, smooth, tangents
from gc_core.hooks import without_hooks
from gc_core.warping import warped_together

ALIGNMENTS = ("time", "arc_length", "dtw")
"""Ways to put demonstrations in correspondence."""

WARPED = 200
"""Dynamic time warping matches this many places of each demonstration, evenly spaced along it."""

GRIPPER_HYSTERESIS = 0.1
"""The gripper changes when the share of demonstrations is this far beyond one half [-]."""


@dataclass(frozen=True, eq=False)
class Alignment:
    """Demonstrations sampled at the same stations."""

    parameter: FloatArray
    """(N,) common parameter at the stations, from 0 to 1 [-]."""
    moments: FloatArray
    """(n, N) time within each trimmed demonstration [s]."""
    aligned: FloatArray
    """(n, N, 3) places on the demonstrations [m]."""
    directrix: FloatArray
    """(N, 3) their mean, or the curve that was given [m]."""
    times: FloatArray
    """(N,) mean time law, strictly increasing from 0 [s]."""
    smoothed: BoolArray
    """(N,) where the directrix leaves out a hook of the mean, see `hooks`."""

    @cached_property
    def along(self) -> FloatArray:
        """(N, 3) unit tangents of the directrix [-]."""
        return read_only(tangents(self.directrix))


def align(
    demonstrations: tuple[Trimmed, ...], stations: int, align_by: str, directrix: FloatArray | None
) -> Alignment:
    """Put demonstrations in correspondence at stations that are evenly spaced along their mean.

    Parameters
    ----------
    demonstrations : tuple of Trimmed
    stations : int
        Number of stations N.
    align_by : {"time", "arc_length", "dtw"}
        What the common parameter is: the part of the duration or of the path gone through, or of a middle
        curve onto which all are warped by their places.
    directrix : (K, 3) array or None
        Curve to use in place of the mean, evenly sampled in the common parameter [m]. By "dtw" the
        demonstrations are warped onto it.

    Returns
    -------
    Alignment

    Raises
    ------
    UnknownOptionError
        If there is no such alignment.
    OpposedDemonstrationsError
        If the mean does not move.
    """
    if align_by not in ALIGNMENTS:
        raise UnknownOptionError("align_by", align_by, ALIGNMENTS)
    grid = np.linspace(0.0, 1.0, 4 * stations + 1)
    clocks, places = _clocks(demonstrations, align_by, grid, directrix)
    if directrix is None:
        mean = np.mean(places, axis=0)
        # A place on the directrix stands for a station's length of path, not for one noisy sample.
        mean = smooth(mean, len(mean) // 400)
    else:
        mean = _sampled(directrix, grid)
    longest = max(d.length for d in demonstrations)
    parameter = _even_parameter(mean, grid, stations, longest)
    bridged = np.zeros(len(grid), dtype=bool)
    if directrix is None:
        mean, bridged = without_hooks(mean, grid, parameter)
    if bridged.any():
        parameter = _even_parameter(mean, grid, stations, longest)
    moments = np.array([np.interp(parameter, grid, clock) for clock in clocks])
    aligned = np.array([_at(d, m) for d, m in zip(demonstrations, moments, strict=True)])
    smoothed = np.zeros(stations, dtype=bool)
    nearest = interpolated(grid[bridged], parameter, np.arange(stations, dtype=np.float64))
    smoothed[np.rint(nearest).astype(np.intp)] = True
    return Alignment(parameter, moments, aligned, _sampled(mean, parameter), _time_law(moments), smoothed)


def mean_orientations(
    demonstrations: tuple[Demonstration, ...], trimmed: tuple[Trimmed, ...], moments: FloatArray
) -> FloatArray | None:
    """Mean rotation at each station.

    Parameters
    ----------
    demonstrations, trimmed : tuples of length n
    moments : (n, N) array
        Time within each trimmed demonstration [s].

    Returns
    -------
    (N, 4) array or None
        Sign-continuous w, x, y, z; None unless every demonstration has orientations.

    References
    ----------
    .. [1] F. L. Markley, Y. Cheng, J. L. Crassidis, Y. Oshman. Averaging quaternions.
       Journal of Guidance, Control, and Dynamics 30(4), 2007. doi:10.2514/1.28949
    """
    sampled: list[FloatArray] = []
    for demonstration, part, moment in zip(demonstrations, trimmed, moments, strict=True):
        if demonstration.orientations is None:
            return None
        sampled.append(_turned(demonstration.orientations, interpolated(moment, part.times, part.kept)))
    stacked = np.array(sampled)
    _, vectors = np.linalg.eigh(np.einsum("jia,jib->iab", stacked, stacked))
    mean = vectors[:, :, -1]
    return sign_continuous(mean * (1.0 if mean[0] @ stacked[0, 0] >= 0.0 else -1.0))


def majority_gripper(
    demonstrations: tuple[Demonstration, ...], trimmed: tuple[Trimmed, ...], moments: FloatArray
) -> FloatArray | None:
    """Gripper state that most demonstrations agree on, without chatter.

    Returns
    -------
    (N,) array or None
        The lowest or the highest value of all demonstrations; None unless every one has a gripper.
    """
    channels: list[FloatArray] = []
    for demonstration, part, moment in zip(demonstrations, trimmed, moments, strict=True):
        if demonstration.gripper is None:
            return None
        channels.append(
            demonstration.gripper[np.rint(interpolated(moment, part.times, part.kept)).astype(np.intp)]
        )
    values = np.array(channels)
    low, high = float(values.min()), float(values.max())
    share = (values > 0.5 * low + 0.5 * high).mean(axis=0)
    decided = np.abs(share - 0.5) > GRIPPER_HYSTERESIS
    decided[0] = True
    latest = np.maximum.accumulate(np.where(decided, np.arange(len(share)), 0))
    return np.where(share[latest] > 0.5, high, low)


def _clocks(
    demonstrations: tuple[Trimmed, ...], align_by: str, grid: FloatArray, directrix: FloatArray | None
) -> tuple[tuple[FloatArray, ...], tuple[FloatArray, ...]]:
    """Moments (K,) [s] and places (K, 3) [m] of each demonstration at common parameters (K,)."""
    if align_by == "dtw":
        return _warped(demonstrations, grid, directrix)
    paced = [_paced(demonstration, align_by, len(grid)) for demonstration in demonstrations]
    return tuple(moments for moments, _ in paced), tuple(places for _, places in paced)


def _warped(
    demonstrations: tuple[Trimmed, ...], grid: FloatArray, directrix: FloatArray | None
) -> tuple[tuple[FloatArray, ...], tuple[FloatArray, ...]]:
    """As `_clocks`, for warped demonstrations."""
    even = np.linspace(0.0, 1.0, WARPED)
    paced = [_paced(demonstration, "arc_length", WARPED) for demonstration in demonstrations]
    reference, place = (None, grid) if directrix is None else _evenly(directrix, even, grid)
    warps = warped_together([places for _, places in paced], reference)
    clocks = tuple(
        interpolated(interpolated(place, even, warp / (WARPED - 1.0)), even, moments)
        for warp, (moments, _) in zip(warps, paced, strict=True)
    )
    return clocks, tuple(_at(d, moments) for d, moments in zip(demonstrations, clocks, strict=True))


@remembered
def _paced(demonstration: Trimmed, align_by: str, count: int) -> tuple[FloatArray, FloatArray]:
    """Moments (K,) [s] and places (K, 3) [m] at even parts of the time or the path of a demonstration.

    Remembered, as `trim` is: while one demonstration is drawn, the others stay as they are.
    """
    even = np.linspace(0.0, 1.0, count)
    moments = even * demonstration.times[-1] if align_by == "time" else _walked(demonstration, even)
    return read_only(moments), read_only(_at(demonstration, moments))


def _evenly(curve: FloatArray, even: FloatArray, grid: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Points (W, 3) at even parts (W,) of a curve's length, and the parts (K,) at its parameters (K,)."""
    samples = np.linspace(0.0, 1.0, len(curve))
    gone = arc_length(curve)
    part = gone / max(float(gone[-1]), np.finfo(float).tiny) + 1e-9 * samples
    part = part / part[-1]
    return _sampled(curve, interpolated(even, part, samples)), interpolated(grid, samples, part)


def _walked(demonstration: Trimmed, part: FloatArray) -> FloatArray:
    """Moments (K,) [s] at which a demonstration has gone through parts (K,) of its path."""
    # A sensor's noise must not count as path while the hand pauses.
    gone = arc_length(smooth(demonstration.positions, len(demonstration.positions) // 200))
    gone = gone + 1e-9 * gone[-1] * np.linspace(0.0, 1.0, len(gone))
    return interpolated(part * gone[-1], gone, demonstration.times)


def _at(demonstration: Trimmed, moments: FloatArray) -> FloatArray:
    """Places (K, 3) on the demonstration's polyline at given moments (K,)."""
    sample = interpolated(moments, demonstration.times, np.arange(len(demonstration.times), dtype=np.float64))
    return _sampled_rows(demonstration.positions, sample)


def _sampled_rows(rows: FloatArray, sample: FloatArray) -> FloatArray:
    """Interpolate rows (T, d) at fractional row numbers (K,)."""
    index = np.minimum(sample.astype(np.intp), len(rows) - 2)
    part = (sample - index)[:, None]
    # np.take copies rows five times as quickly as an index in brackets.
    return np.take(rows, index, axis=0) * (1.0 - part) + np.take(rows, index + 1, axis=0) * part


def _turned(quaternions: FloatArray, sample: FloatArray) -> FloatArray:
    """Rotations (K, 4) at fractional sample numbers (K,), turning evenly from sample to sample."""
    index = np.minimum(sample.astype(np.intp), len(quaternions) - 2)
    before, after = quaternions[index], quaternions[index + 1]
    part = (sample - index)[:, None]
    half = np.arccos(np.clip(np.einsum("ij,ij->i", before, after), -1.0, 1.0))[:, None]
    # Of a turn too small for its sine, the straight line is the arc.
    small = half < 1e-6
    sine = np.sin(np.where(small, 1.0, half))
    first = np.where(small, 1.0 - part, np.sin((1.0 - part) * half) / sine)
    second = np.where(small, part, np.sin(part * half) / sine)
    values = first * before + second * after
    return values / np.linalg.norm(values, axis=1, keepdims=True)


def _sampled(curve: FloatArray, parameter: FloatArray) -> FloatArray:
    return _sampled_rows(curve, parameter * (len(curve) - 1))


def _even_parameter(mean: FloatArray, grid: FloatArray, stations: int, longest: float) -> FloatArray:
    """Parameters (N,) at which the mean curve has gone through equal lengths."""
    gone = arc_length(smooth(mean, len(mean) // 200))
    if gone[-1] <= 1e-3 * longest:
        raise OpposedDemonstrationsError(float(gone[-1]))
    gone = gone + 1e-6 * gone[-1] * grid
    return interpolated(np.linspace(0.0, float(gone[-1]), stations), gone, grid)


def _time_law(moments: FloatArray) -> FloatArray:
    """Mean time (N,) from the start [s], strictly increasing."""
    mean = (moments - moments[:, :1]).mean(axis=0)
    return mean + 1e-9 * max(mean[-1], 1e-6) * np.arange(len(mean))
