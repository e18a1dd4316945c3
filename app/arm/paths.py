"""A whole path for the Jaco: which posture to begin with decides how it ends.

The cheap answer is tried first: begin as the arm stands, or at home. Only when
that jumps, misses or touches the arm itself or an obstacle are other postures
scored on a coarse copy of the path; and only when the best one touches something,
or misses what the copy reached, is the path solved again: with the bodies kept
apart, from the next best postures, then with the tool turned as it likes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.arm.postures import seeds
from app.arm.programs import SAFE_DISTANCE, Wrist
from app.arm.protocol import Clearance, FloatArray, JointPath
from app.arm.solver import Solver

_N_COARSE = 40
_N_CHECKED = 400
_GOOD_ROOM = 0.8 * SAFE_DISTANCE
"""Kept apart, bodies come a little nearer than asked for; that is near enough [m]."""
_REACHED = 1e-3
"""A position nearer than this is reached [m]."""
_SMOOTH = 0.5
"""Largest joint step between two coarse positions that needs no second thought [rad]."""
_LEAP = 1.5
"""A larger one is another posture in all likelihood [rad]."""
_UNPLAYABLE = 200.0
"""What each radian beyond costs: no arm can leap, while what stands in its way can be moved."""
_MISSED = 1e5
"""What each metre of a miss costs on the whole path: reach counts most."""
_OVERLAP = 100.0
"""What it costs that the arm touches itself: more than any step that is no leap."""
_OTHER = 0.1
"""Postures nearer to each other than this lead the same way [rad]."""
_N_WALKED = 4
"""Postures to begin with that are walked on the whole path."""


@dataclass(frozen=True, eq=False)
class _Candidate:
    """A posture to begin with and what became of it on the coarse path."""

    joints: FloatArray
    missed: float
    """Sum of what the tool missed the positions by, beyond `_REACHED` [m]."""
    jump: float
    """Largest joint step [rad]."""
    clearance: Clearance

    @property
    def good(self) -> bool:
        """Whether no other posture needs to be tried."""
        return self.missed == 0.0 and self.jump < _SMOOTH and _tightness(self.clearance, SAFE_DISTANCE) == 0.0

    @property
    def cost(self) -> float:
        """Reach counts most, then to touch nothing without leaping, then smoothness."""
        leap = _UNPLAYABLE * max(0.0, self.jump - _LEAP)
        return 100.0 * self.missed + leap + self.jump + _tightness(self.clearance, SAFE_DISTANCE)


@dataclass(frozen=True, eq=False)
class Course:
    """What the tool should pass."""

    positions: FloatArray
    """(K, 3) reachable [m]."""
    rotations: FloatArray | None = None
    """(K, 3, 3) of the tool in the world; None: it rather points down."""

    @property
    def wrist(self) -> Wrist:
        """How the tool is held on the way."""
        return "down" if self.rotations is None else "shown"

    def at(self, indices: npt.NDArray[np.intp]) -> Course:
        """Give a part of it."""
        rotations = self.rotations
        return Course(self.positions[indices], None if rotations is None else rotations[indices])

    def walk(self, solver: Solver, start: FloatArray, wrist: Wrist, *, careful: bool = False) -> JointPath:
        """Lead the arm along it from joints (6,)."""
        return solver.walk(self.positions, start, careful=careful, wrist=wrist, rotations=self.rotations)


def find_path(solver: Solver, course: Course, *, start: FloatArray | None, home: FloatArray) -> JointPath:
    """Find continuous joints along a course.

    Parameters
    ----------
    solver : Solver
        Solves; its state does not matter.
    course : Course
        What the tool should pass.
    start : (6,) array or None
        Joints near which to begin, where that works as well [rad].
    home : (6,) array
        Joints to begin from otherwise [rad].

    Returns
    -------
    JointPath
        Joints and distances left.
    """
    n_positions = len(course.positions)
    coarse = course.at(_spread(n_positions, _N_COARSE))
    best = _ranked(solver, coarse, start, home, course.wrist)[0]
    path = course.walk(solver, best.joints, course.wrist)
    cost = _cost(solver, path)
    clearance = solver.clearance(path.joints[_spread(n_positions, _N_CHECKED)])
    room = min(clearance.itself.min(), clearance.obstacles.min())
    if cost < _SMOOTH or (best.missed > 0.0 and room >= SAFE_DISTANCE):
        return path  # it does, or no posture reaches it all
    # Whatever stands in the way of the hand itself does so in every posture.
    walked = _N_WALKED if clearance.obstacles.min() >= _GOOD_ROOM else 1
    for begin, wrist, careful in _others(solver, coarse, start, home, course.wrist, walked=walked):
        if cost < _SMOOTH:
            break
        other = course.walk(solver, begin, wrist, careful=careful)
        other_cost = _cost(solver, other)
        if other_cost < cost:
            path, cost = other, other_cost
    return path


def _others(
    solver: Solver, coarse: Course, start: FloatArray | None, home: FloatArray, wrist: Wrist, *, walked: int
) -> Iterator[tuple[FloatArray, Wrist, bool]]:
    """Give other ways to walk: joints to begin with, how the tool is held, whether bodies are kept apart."""
    begins: list[FloatArray] = []
    for candidate in _ranked(solver, coarse, start, home, wrist, all_of_them=True):
        if all(np.abs(candidate.joints - begin).max() > _OTHER for begin in begins):
            begins.append(candidate.joints)
    yield begins[0], wrist, True
    for begin in begins[1:walked]:
        yield begin, wrist, False
        yield begin, wrist, True
    free = _ranked(solver, coarse, start, home, "free")[0]
    yield free.joints, "free", False
    yield free.joints, "free", True


def _cost(solver: Solver, path: JointPath) -> float:
    """Weigh touching against jumping: 1 mm too near is as bad as 1 rad; leaps and misses are worse."""
    clearance = solver.clearance(path.joints[_spread(len(path.joints), _N_CHECKED)])
    jump = float(np.abs(np.diff(path.joints, axis=0)).max(initial=0.0))
    missed = _MISSED * max(0.0, float(path.errors.max()) - _REACHED)
    missed += _OVERLAP * float(clearance.itself.min() < 0.0)
    return missed + _tightness(clearance, _GOOD_ROOM) + jump + _UNPLAYABLE * max(0.0, jump - _SMOOTH)


def _tightness(clearance: Clearance, wanted: float) -> float:
    """Give how many millimetres nearer than wanted the arm comes to itself and to what stands around.

    One is not bought with the other: the two are added up.
    """
    nearest = np.array([clearance.itself.min(), clearance.obstacles.min()])
    return 1000.0 * float(np.maximum(0.0, wanted - nearest).sum())


def _ranked(
    solver: Solver,
    coarse: Course,
    start: FloatArray | None,
    home: FloatArray,
    wrist: Wrist,
    *,
    all_of_them: bool = False,
) -> list[_Candidate]:
    """Give postures to begin with, the best first; one good one is enough."""
    tried: list[_Candidate] = []
    for seed in seeds(start, home):
        tried.append(_try(solver, coarse, seed, wrist))
        if tried[-1].good and not all_of_them:
            break
    return sorted(tried, key=lambda candidate: (not candidate.good, candidate.cost))


def _try(solver: Solver, coarse: Course, seed: FloatArray, wrist: Wrist) -> _Candidate:
    path = coarse.walk(solver, seed, wrist)
    steps = np.abs(np.diff(path.joints, axis=0))
    return _Candidate(
        joints=path.joints[0],
        missed=float(np.maximum(path.errors - _REACHED, 0.0).sum()),
        jump=float(steps.max(initial=0.0)),
        clearance=solver.clearance(path.joints),
    )


def _spread(length: int, wanted: int) -> npt.NDArray[np.intp]:
    """Give at most ``wanted`` indices spread evenly over a length, ends included."""
    return np.unique(np.linspace(0, length - 1, min(length, wanted)).astype(np.intp))
