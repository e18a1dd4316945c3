"""Motions as people would show them: one path, a spread around it, each person's own timing.

A `Plan` describes a set of demonstrations; `demonstrate` performs it. Everything
random comes from the plan's seed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.interpolate import (  # pyright: ignore[reportMissingTypeStubs]  # SciPy has none
    CubicSpline,
    PchipInterpolator,
)

from app.document import FloatArray
from gc_core import Demonstration

_FINE: Final = 801
_FIRST_MOVE: Final = 0.06
"""Part of a minimum-jerk motion that is too slow to be seen: a recording begins with the move."""


@dataclass(frozen=True)
class Plan:
    """How a motion is shown several times."""

    waypoints: tuple[tuple[float, float, float], ...]
    """The middle of the path passes through these, smoothly [m]; at least two."""
    spread: tuple[tuple[float, float], ...]
    """(part of the way 0..1, half-width there [m]), rising; between them it changes smoothly."""
    seed: int
    demonstrations: int = 5
    seconds: tuple[float, float] = (4.0, 6.0)
    """Shortest and longest demonstration [s]."""
    wander: float = 0.12
    """How far a person strays from an even course, as a part of the half-width."""
    unevenness: float = 0.12
    """How far a person's progress leads or lags a minimum-jerk motion, as a part of the whole; below 0.3."""
    care: float = 0.0
    """How much of the slowness comes from narrowness, 0..1; at 1 speed is proportional to the half-width."""
    rate: float = 50.0
    """Samples a second [Hz]."""
    grip: tuple[float, float] | None = None
    """About which parts of the way the hand closes and opens, 0..1; None if it holds nothing."""


def demonstrate(plan: Plan) -> tuple[Demonstration, ...]:
    """Show the motion as often as planned.

    Returns
    -------
    tuple of Demonstration
        Around the middle path, at evenly spread sides of it; positions in metres, gripper 0 open, 1 closed.
    """
    rng = np.random.default_rng(plan.seed)
    path = middle_path(plan.waypoints)
    first_side = rng.uniform(0.0, 2.0 * np.pi)
    sides = first_side + 2.0 * np.pi * np.arange(plan.demonstrations) / plan.demonstrations
    return tuple(
        _one(plan, path, side, f"Demonstration {number}", rng) for number, side in enumerate(sides, start=1)
    )


def middle_path(waypoints: tuple[tuple[float, float, float], ...]) -> FloatArray:
    """Draw a smooth curve through waypoints.

    Returns
    -------
    (K, 3) array
        Points at even steps of arc length [m].
    """
    corners = np.array(waypoints, dtype=np.float64)
    chord = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1) ** 0.5)))
    curve = _spline(chord, corners, np.linspace(0.0, float(chord[-1]), 4 * _FINE))
    length = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))))
    even = np.linspace(0.0, float(length[-1]), _FINE)
    return np.stack([np.interp(even, length, curve[:, axis]) for axis in range(3)], axis=1)


def progress(seconds: float, lead: float, second_thought: float, rate: float = 50.0) -> FloatArray:
    """Say how far along the way a person is at each sample.

    A minimum-jerk motion whose clock runs unevenly, from where it begins to be seen
    to where it is seen no more; it never goes back.

    Parameters
    ----------
    seconds : float
        How long the motion takes [s].
    lead : float
        Ahead of an even clock in the middle of the motion (negative: behind) [-].
    second_thought : float
        Hesitation in the first half, made up for in the second [-].
    rate : float
        Samples a second [Hz].

    Returns
    -------
    (T,) array
        From 0 to 1.
    """
    u = np.linspace(_FIRST_MOVE, 1.0 - _FIRST_MOVE, max(round(seconds * rate), 2) + 1)
    clock = u + lead * np.sin(np.pi * u) / np.pi + second_thought * np.sin(2.0 * np.pi * u) / (2.0 * np.pi)
    way = clock**3 * (10.0 - 15.0 * clock + 6.0 * clock**2)
    return (way - way[0]) / (way[-1] - way[0])


def slow_where_narrow(way: FloatArray, half_width: FloatArray, care: float) -> FloatArray:
    """Let a person slow down where the way is narrow, and take as long as before for the whole of it.

    Parameters
    ----------
    way : (T,) array
        How far along at each sample, from 0 to 1, never back.
    half_width : (K,) array
        At even steps of the way, positive [m].
    care : float
        `Plan.care`.

    Returns
    -------
    (T,) array
        From 0 to 1, never back.

    References
    ----------
    .. [1] J. Accot, S. Zhai. Beyond Fitts' law: models for trajectory-based HCI tasks. CHI 1997:
       the speed in a tunnel is proportional to its width.
    """
    slowness = (1.0 - care) + care * half_width.max() / half_width
    clock = np.concatenate(([0.0], np.cumsum(0.5 * (slowness[1:] + slowness[:-1]))))
    along = np.linspace(0.0, 1.0, len(half_width))
    return np.clip(PchipInterpolator(clock / clock[-1], along)(way), 0.0, 1.0)


def _one(plan: Plan, path: FloatArray, side: float, name: str, rng: np.random.Generator) -> Demonstration:
    seconds = rng.uniform(*plan.seconds)
    way = progress(
        seconds,
        lead=rng.uniform(-1.0, 1.0) * plan.unevenness,
        second_thought=rng.uniform(-1.0, 1.0) * 2.0 * plan.unevenness,
        rate=plan.rate,
    )
    if plan.care > 0.0:
        way = slow_where_narrow(way, _half_width(plan, len(path)), plan.care)
    line = path + _offset(plan, path, side, rng)
    along = np.linspace(0.0, 1.0, len(path))
    positions = _spline(along, line, way)
    gripper = None if plan.grip is None else _gripper(way, plan.grip, rng)
    return Demonstration(np.arange(len(way)) / plan.rate, positions, gripper=gripper, name=name)


def _gripper(way: FloatArray, grip: tuple[float, float], rng: np.random.Generator) -> FloatArray:
    """Whether the hand is closed at parts of the way (T,): some close and open it sooner, some later."""
    closes = grip[0] * rng.uniform(0.7, 1.3)
    opens = 1.0 - (1.0 - grip[1]) * rng.uniform(0.7, 1.3)
    return ((way >= closes) & (way < opens)).astype(np.float64)


def _offset(plan: Plan, path: FloatArray, side: float, rng: np.random.Generator) -> FloatArray:
    """Where this person is beside the middle path, (K, 3) [m]."""
    along = np.linspace(0.0, 1.0, len(path))
    half_width = _half_width(plan, len(path))
    across, up = _across(path)
    angle = side + rng.uniform(-0.25, 0.25) + 0.35 * _slow_wave(along, rng)
    distance = half_width * (rng.uniform(0.86, 1.0) + plan.wander * _slow_wave(along, rng))
    return distance[:, None] * (np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * up)


def _half_width(plan: Plan, count: int) -> FloatArray:
    """Half-width of the spread at even steps of the way, (count,) [m]."""
    part, width = np.array(plan.spread, dtype=np.float64).T
    return np.asarray(PchipInterpolator(part, width)(np.linspace(0.0, 1.0, count)), dtype=np.float64)


def _spline(at: FloatArray, values: FloatArray, wanted: FloatArray) -> FloatArray:
    return np.asarray(CubicSpline(at, values)(wanted), dtype=np.float64)


def _slow_wave(along: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Half a wave to one and a half along the way, within -1..1."""
    waves = rng.uniform(0.5, 1.5)
    return np.sin(2.0 * np.pi * (waves * along + rng.uniform(0.0, 1.0)))


def _across(path: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two directions across the path, each (K, 3), that turn with it and do not twist about it."""
    tangent = np.gradient(path, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    least = np.eye(3)[np.argmin(np.abs(tangent[0]))]
    first = np.cross(tangent[0], least)
    across = [first / np.linalg.norm(first)]
    for t in tangent[1:]:
        carried = across[-1] - (across[-1] @ t) * t
        across.append(carried / np.linalg.norm(carried))
    sideways = np.array(across)
    return sideways, np.asarray(np.cross(tangent, sideways), dtype=np.float64)
