"""Inverse kinematics of the Jaco: the only module that talks to placo.

placo keeps a configuration inside; every function here sets it before use, so
that results depend on arguments alone. Four solves a tick take the oscillation
out of a drag, damping in proportion to the distance left makes it settle, and
a weight of 1e-5 for "tool down" bends the tip by 0.04 mm only.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from app.arm import urdf
from app.arm.protocol import FloatArray, JointPath

DRAG_SPEED = 3.0
"""No joint turns faster than this while the hand is dragged [rad/s]."""
SAFE_DISTANCE = 0.01
"""Bodies of the arm stay this far from each other [m]."""

# Not an import statement: placo lives in a prefix of its own, and its stubs name types that do not exist.
_placo: Any = import_module("placo")
_SOLVES_PER_TICK = 4
_TRUST = 0.3
"""Largest joint step of one solve along a path [rad]."""
_DAMPING, _DAMPING_PER_METRE = 1e-6, 0.1
_TOOL_DOWN, _POSTURE, _AVOID = 1e-5, 1e-7, 1e3
_TRIGGER = 0.06
"""Bodies of the arm begin to keep away from each other at this distance [m]."""
_FIRST, _OTHERS = 80, 20
"""Largest number of solves for the first position of a path and for each other one."""
_REACHED, _STILL = 1e-4, 1e-3
"""A path point is solved when the tip is this near [m] and the joints move less than that [rad]."""


class Solver:
    """One placo robot with its solvers; belongs to one arm at a time."""

    def __init__(self, folder: Path, posture: FloatArray) -> None:
        self.kinematics = urdf.kinematics(folder.joinpath(urdf.ROBOT_FILE).read_text("utf-8"))
        self._robot = _placo.RobotWrapper(str(folder), 0)
        self._robot.load_collision_pairs(str(folder / urdf.PAIRS_FILE))
        self._bodies: list[str] = [str(body.name) for body in self._robot.collision_model.geometryObjects]
        self._columns = [self._robot.get_joint_offset(name) for name in urdf.JOINT_NAMES]
        self._posture = posture
        self._endless = self.kinematics.upper >= urdf.ENDLESS
        self._careful = _Tasks(self._robot, avoid=True)
        self._free = _Tasks(self._robot, avoid=False)

    def tip(self, joints: FloatArray) -> FloatArray:
        """Give the (3,) position of the tool [m]."""
        self._place(joints)
        return self._tip()

    def frames(self, joints: FloatArray, names: Sequence[str]) -> list[FloatArray]:
        """Give the (4, 4) pose of each named frame in the world."""
        self._place(joints)
        return [self._robot.get_T_world_frame(name) for name in names]

    def drag(self, joints: FloatArray, target: FloatArray, dt: float) -> FloatArray:
        """Move the tool towards a reachable target for one tick of ``dt`` seconds."""
        self._place(joints)
        self._careful.rest_at(self._posture_near(joints))
        self._robot.set_velocity_limits(DRAG_SPEED)
        self._careful.solver.dt = dt / _SOLVES_PER_TICK
        self._careful.position.target_world = target
        for _ in range(_SOLVES_PER_TICK):
            self._solve(self._careful, target)
        return np.clip(self._joints(), joints - DRAG_SPEED * dt, joints + DRAG_SPEED * dt)

    def walk(
        self,
        positions: FloatArray,
        start: FloatArray,
        *,
        careful: bool = False,
    ) -> JointPath:
        """Visit positions (K, 3) one after the other, each from the joints of the one before.

        Parameters
        ----------
        positions : (K, 3) array
            Where the tool should be [m].
        start : (6,) array
            Joints to begin from [rad].
        careful : bool
            Keep the bodies of the arm apart; costs ten times as much.

        Returns
        -------
        JointPath
            Joints and distances left.
        """
        tasks = self._careful if careful else self._free
        tasks.solver.dt = 1.0
        self._robot.set_velocity_limits(_TRUST)
        self._place(start)
        tasks.rest_at(self._posture_near(start))
        joints, errors = np.empty((len(positions), len(start))), np.empty(len(positions))
        for index, position in enumerate(positions):
            errors[index] = self._converge(tasks, position, _FIRST if index == 0 else _OTHERS)
            joints[index] = self._joints()
        return JointPath(joints, errors)

    def closest_bodies(self, joints: FloatArray) -> tuple[float, str, str]:
        """Give the smallest distance between two bodies of the arm [m] and their links."""
        self._place(joints)
        pairs: list[Any] = self._robot.distances()
        nearest = min(pairs, key=_min_distance)
        return float(nearest.min_distance), self._bodies[int(nearest.objA)], self._bodies[int(nearest.objB)]

    def self_distance(self, joints: FloatArray) -> float:
        """Give the smallest distance between bodies of the arm over joints (K, 6) [m]."""
        return min(self.closest_bodies(configuration)[0] for configuration in joints)

    def _converge(self, tasks: _Tasks, position: FloatArray, iterations: int) -> float:
        tasks.position.target_world = position
        for _ in range(iterations):
            moved = self._solve(tasks, position)
            if moved < _STILL and math.dist(self._tip(), position) < _REACHED:
                break
        return math.dist(self._tip(), position)

    def _solve(self, tasks: _Tasks, position: FloatArray) -> float:
        """Take one step; give the largest joint movement [rad]."""
        tasks.damping.set_weight(_DAMPING + _DAMPING_PER_METRE * math.dist(self._tip(), position))
        try:
            moved = float(np.abs(tasks.solver.solve(True)).max())
        except RuntimeError:
            # The quadratic program had no solution; placo then leaves the joints as they were.
            return 0.0
        self._robot.update_kinematics()
        return moved

    def _posture_near(self, joints: FloatArray) -> FloatArray:
        """Give the posture with as many turns of the endless joints as they have made."""
        turns = np.round((joints - self._posture) / (2.0 * np.pi))
        return self._posture + np.where(self._endless, 2.0 * np.pi * turns, 0.0)

    def _place(self, joints: FloatArray) -> None:
        state = self._robot.state.q.copy()
        state[self._columns] = np.clip(joints, self.kinematics.lower, self.kinematics.upper)
        self._robot.state.q = state
        self._robot.update_kinematics()

    def _joints(self) -> FloatArray:
        return self._robot.state.q[self._columns].copy()

    def _tip(self) -> FloatArray:
        return self._robot.get_T_world_frame(urdf.TOOL)[:3, 3]


def _min_distance(pair: Any) -> float:
    return pair.min_distance


class _Tasks:
    """What one quadratic program wants: position first, tool down a little, posture hardly."""

    def __init__(self, robot: Any, *, avoid: bool) -> None:
        self.solver = _placo.KinematicsSolver(robot)
        self.solver.mask_fbase(True)
        # "soft" throughout: a hard position has no solution where the arm cannot reach.
        self.position = self.solver.add_position_task(urdf.TOOL, np.zeros(3))
        self.position.configure("position", "soft", 1.0)
        upwards = np.array([0.0, 0.0, 1.0])
        axis = self.solver.add_axisalign_task(urdf.TOOL, upwards, -upwards)
        axis.configure("tool down", "soft", _TOOL_DOWN)
        self._rest = self.solver.add_joints_task()
        self._rest.set_joints(dict.fromkeys(urdf.JOINT_NAMES, 0.0))
        self._rest.configure("posture", "soft", _POSTURE)
        self.damping = self.solver.add_regularization_task(_DAMPING)
        self.solver.enable_joint_limits(True)
        self.solver.enable_velocity_limits(True)
        if avoid:
            apart = self.solver.add_avoid_self_collisions_constraint()
            apart.configure("apart", "soft", _AVOID)
            apart.self_collisions_margin = SAFE_DISTANCE
            apart.self_collisions_trigger = _TRIGGER

    def rest_at(self, posture: FloatArray) -> None:
        """Prefer this posture where position and tool leave a choice."""
        self._rest.set_joints(dict(zip(urdf.JOINT_NAMES, posture.tolist(), strict=True)))


class SolverPool:
    """Solvers nobody uses at the moment: placo never frees a robot, so they are kept."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._idle: dict[Path, list[Solver]] = {}

    def acquire(self, folder: Path, posture: FloatArray) -> Solver:
        """Take an idle solver for the model in a folder, or make one."""
        with self._lock:
            idle = self._idle.setdefault(folder, [])
            if idle:
                return idle.pop()
        return Solver(folder, posture)

    def release(self, folder: Path, solver: Solver) -> None:
        """Give a solver back."""
        with self._lock:
            self._idle.setdefault(folder, []).append(solver)
