"""A whole path for the Jaco: which posture to begin with decides how it ends.

The cheap answer is tried first: begin as the arm stands, or at home. Only when
that jumps, misses or touches the arm itself are other postures scored on a
coarse copy of the path; and only when the best one touches the arm is the path
solved again with the bodies kept apart.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.arm.protocol import FloatArray, JointPath
from app.arm.solver import SAFE_DISTANCE, Solver

_N_COARSE = 40
_N_SEEDS = 24
_N_CHECKED = 100
_REACHED = 1e-3
"""A position nearer than this is reached [m]."""
_SMOOTH = 0.5
"""Largest joint step between two coarse positions that needs no second thought [rad]."""
_SEED_LOW = np.array([-3.1, 1.2, 0.7, -3.1, 0.9, -3.1])
_SEED_HIGH = np.array([3.1, 5.1, 5.5, 3.1, 5.3, 3.1])


@dataclass(frozen=True, eq=False)
class _Candidate:
    """A posture to begin with and what became of it on the coarse path."""

    joints: FloatArray
    missed: float
    """Sum of what the tool missed the positions by, beyond `_REACHED` [m]."""
    jump: float
    """Largest joint step [rad]."""
    distance: float
    """Smallest distance between bodies of the arm [m]."""

    @property
    def good(self) -> bool:
        """Whether no other posture needs to be tried."""
        return self.missed == 0.0 and self.jump < _SMOOTH and self.distance >= SAFE_DISTANCE

    @property
    def cost(self) -> float:
        """Reach counts most, then not to touch oneself, then smoothness."""
        return 100.0 * self.missed + self.jump + 1000.0 * max(0.0, SAFE_DISTANCE - self.distance)


def find_path(
    solver: Solver, positions: FloatArray, *, start: FloatArray | None, home: FloatArray
) -> JointPath:
    """Find continuous joints along positions.

    Parameters
    ----------
    solver : Solver
        Solves; its state does not matter.
    positions : (K, 3) array
        Reachable tool positions [m].
    start : (6,) array or None
        Joints near which to begin, where that works as well [rad].
    home : (6,) array
        Joints to begin from otherwise [rad].

    Returns
    -------
    JointPath
        Joints and distances left.
    """
    coarse = positions[_spread(len(positions), _N_COARSE)]
    best: _Candidate | None = None
    for seed in _seeds(start, home):
        candidate = _try(solver, coarse, seed)
        if best is None or candidate.cost < best.cost:
            best = candidate
        if best.good:
            break
    begin = home if best is None else best.joints
    path = solver.walk(positions, begin)
    return _apart(solver, positions, begin, path)


def _apart(solver: Solver, positions: FloatArray, begin: FloatArray, path: JointPath) -> JointPath:
    """Solve again with the bodies kept apart when a path touches the arm itself."""
    checked = _spread(len(positions), _N_CHECKED)
    distance = solver.self_distance(path.joints[checked])
    if distance >= SAFE_DISTANCE:
        return path
    careful = solver.walk(positions, begin, careful=True)
    misses = careful.errors.max() > max(_REACHED, path.errors.max())
    return path if misses or solver.self_distance(careful.joints[checked]) <= distance else careful


def _seeds(start: FloatArray | None, home: FloatArray) -> Iterator[FloatArray]:
    if start is not None:
        yield start
    yield home
    # A fixed seed: the same path always gets the same answer.
    yield from np.random.default_rng(0).uniform(_SEED_LOW, _SEED_HIGH, (_N_SEEDS, len(home)))


def _try(solver: Solver, coarse: FloatArray, seed: FloatArray) -> _Candidate:
    path = solver.walk(coarse, seed)
    steps = np.abs(np.diff(path.joints, axis=0))
    return _Candidate(
        joints=path.joints[0],
        missed=float(np.maximum(path.errors - _REACHED, 0.0).sum()),
        jump=float(steps.max(initial=0.0)),
        distance=solver.self_distance(path.joints),
    )


def _spread(length: int, wanted: int) -> npt.NDArray[np.intp]:
    """Give at most ``wanted`` indices spread evenly over a length, ends included."""
    return np.unique(np.linspace(0, length - 1, min(length, wanted)).astype(np.intp))
