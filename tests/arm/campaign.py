"""Random drags and random paths for the arm, as test and soak run them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from app.arm import FloatArray, Jaco
from app.arm.jaco import SHELL
from app.servo import advance, begin

SHOULDER = np.asarray(SHELL.shoulder)
SPEEDS = (0.3, 0.8, 1.5, 2.5)
"""Of the pulling hand [m/s]."""
TICK = 0.01
STILL = 0.6e-3
"""A joint that moves less than this in a tick is at rest [rad]."""
HOLD = 3.5
"""How long the pointer rests at the end [s]."""
LAG = 0.06
"""The servo follows the pointer this late [s]."""


@dataclass(frozen=True)
class Drag:
    """One random drag from home, and what the arm did."""

    goal: FloatArray
    joints: FloatArray
    largest_step: float
    """Of a joint in a tick [rad]."""
    settled: float
    """When the joints came to rest after the pointer did [s]."""
    swings: float
    """How far a joint goes to and fro in a tick, later than 3 s after the pointer came to rest [rad]."""
    distance: float
    """Of the hand from the goal in the end [m]."""


def somewhere(rng: np.random.Generator) -> FloatArray:
    """A place that the arm reaches: 0.3 to 0.9 m from the shoulder, above the table."""
    while True:
        place = _around(rng, 0.3, 0.9)
        if place[2] > 0.05:
            return place


def anywhere(rng: np.random.Generator) -> FloatArray:
    """Any place up to 2.5 m from the shoulder, below the table and inside the arm too."""
    return _around(rng, 0.0, 2.5)


def _around(rng: np.random.Generator, low: float, high: float) -> FloatArray:
    direction = rng.normal(size=3)
    return SHOULDER + rng.uniform(low, high) * direction / np.linalg.norm(direction)


def drag(jaco: Jaco, goal: FloatArray, speed: float) -> Drag:
    """Pull the hand from home straight to a goal with 20 events a second, and hold it there."""
    start = jaco.tool_pose(jaco.home)[:3, 3]
    lasts = float(np.linalg.norm(goal - start)) / speed
    times = np.append(np.arange(0.0, lasts, 0.05), lasts)
    events = np.column_stack([times, start + np.minimum(times / lasts, 1.0)[:, None] * (goal - start)])
    _, motion = advance(begin(jaco, jaco.home, 0.0), jaco, events, lasts + HOLD)
    steps = np.abs(np.diff(np.vstack([jaco.home, motion.joints]), axis=0)).max(axis=1)
    rests = int((lasts + LAG) / TICK)
    moving = np.flatnonzero(steps[rests:] > STILL)
    return Drag(
        goal=goal,
        joints=motion.joints[-1],
        largest_step=float(steps.max()),
        settled=0.0 if len(moving) == 0 else (int(moving[-1]) + 1) * TICK,
        swings=to_and_fro(motion.joints[rests + 300 :]),
        distance=float(np.linalg.norm(motion.positions[-1] - goal)),
    )


def to_and_fro(joints: FloatArray) -> float:
    """Mean step of a joint (T, J) beyond what brings it anywhere; 0 for one that only goes on [rad]."""
    steps = np.diff(joints, axis=0)
    return float((np.abs(steps).sum(axis=0) - np.abs(steps.sum(axis=0))).max()) / len(steps)


def drags(jaco: Jaco, seed: int, count: int) -> list[Drag]:
    """Random drags, every other one to any place at all."""
    rng = np.random.default_rng(seed)
    goals = [anywhere(rng) if number % 2 else somewhere(rng) for number in range(count)]
    return [drag(jaco, goal, SPEEDS[number // 2 % len(SPEEDS)]) for number, goal in enumerate(goals)]


def random_path(rng: np.random.Generator, length: float = 2.6, n_samples: int = 200) -> FloatArray:
    """A smooth path (K, 3) of a given length through the arm's workspace [m]."""
    while True:
        corners = np.array([somewhere(rng) for _ in range(5)])
        dense = CubicSpline(np.linspace(0.0, 1.0, 5), corners)(np.linspace(0.0, 1.0, 600))
        way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(dense, axis=0), axis=1))])
        where = np.linspace(0.0, length, n_samples)
        path = np.stack([np.interp(where, way, dense[:, axis]) for axis in range(3)], axis=1)
        radii = np.linalg.norm(path - SHOULDER, axis=1)
        if way[-1] >= length and radii.max() < 0.95 and radii.min() > 0.28 and path[:, 2].min() > 0.03:
            return path
