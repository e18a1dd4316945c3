"""How far and how suddenly does one pulled way point take the tube along?

Start, goal and two way points near the middle line are four landmarks in general position: the paper's map is
then affine, and shears. Part of `tests.measurements.transfer`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from app.model import STIFFNESS
from gc_core import GeneralizedCylinder, generalize, register
from gc_core.arrays import FloatArray

TRIALS: Final = 200
PULL: Final = 0.06
"""[m]."""
NUDGE: Final = 1e-5
"""[m]."""
BESIDE: Final = 0.02
"""Way points lie this far from the middle line, in each direction (standard deviation) [m]."""
STIFFNESSES: Final = (0.0, 0.003, 0.01, STIFFNESS, 0.1, 0.3)

PULLS: Final = (
    "stiffness [cm] | farthest moved [cm]: median | 95 % | worst | nudged: the map changes by [mm] "
    "| the tube: 95 % [mm] | worst | folds: moves"
)


def directions(rng: np.random.Generator, length: float) -> FloatArray:
    """A vector (3,) of a length, any way."""
    way = rng.normal(size=3)
    return np.asarray(length * way / np.linalg.norm(way), dtype=np.float64)


def pulled(tube: GeneralizedCylinder, seed: int, stiffness: float) -> FloatArray:
    """Farthest move, change of the map and of the tube after a nudge [m], and whether it folds (4,)."""
    rng = np.random.default_rng(seed)
    count = len(tube.directrix)
    way_points = tube.directrix[rng.choice(np.arange(count // 10, count - count // 10), 2, replace=False)]
    source = np.concatenate((tube.directrix[[0, -1]], way_points + rng.normal(scale=BESIDE, size=(2, 3))))
    target = source.copy()
    target[2] += directions(rng, PULL)
    nudged = target.copy()
    nudged[2] += directions(rng, NUDGE)
    one, other = (register(source, places, stiffness=stiffness) for places in (target, nudged))
    surface = tube.surface()
    here, there = (generalize(tube, spline, repair=False) for spline in (one, other))
    return np.array(
        [
            np.linalg.norm(one(surface) - surface, axis=2).max(),
            np.linalg.norm(other(surface) - one(surface), axis=2).max(),
            np.linalg.norm(there.surface() - here.surface(), axis=2).max(),
            here.diagnostics.folded.any(),
        ]
    )


def pull_line(tubes: Sequence[GeneralizedCylinder], stiffness: float) -> str:
    """One row on pulls with one stiffness."""
    rows = np.array([pulled(tubes[seed % len(tubes)], seed, stiffness) for seed in range(TRIALS)])
    far, tube = 100.0 * rows[:, 0], 1000.0 * rows[:, 2]
    return (
        f"| {100.0 * stiffness:g} | {np.median(far):.1f} | {np.percentile(far, 95):.1f} | {far.max():.1f} "
        f"| {1000.0 * rows[:, 1].max():.2f} | {np.percentile(tube, 95):.2f} | {tube.max():.2f} "
        f"| {int(rows[:, 3].sum())} |"
    )
