"""Inverse kinematics of the Jaco: the only module that drives placo.

placo keeps a configuration inside; every function here sets it before use, so
that results depend on arguments and conditions alone. Four solves a tick take the
oscillation out of a drag, damping in proportion to the distance left makes it
settle, and a weight of 1e-5 for "tool down" bends the tip by 0.04 mm only.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from app.arm import urdf
from app.arm.bodies import Bodies
from app.arm.conditions import FREE, Conditions
from app.arm.programs import SAFE_DISTANCE, TRIGGER, Program, Wrist, placo
from app.arm.protocol import Clearance, FloatArray, JointPath
from app.arm.shapes import rotation_of

DRAG_SPEED = 3.0
"""No joint turns faster than this while the hand is dragged [rad/s]."""
_SOLVES_PER_TICK = 4
_AT_REST = 1e-5
"""When a solve moves no joint by more than this, the others of its tick would not either [rad]."""
_TREMBLE, _SLOW = 0.05, 0.05
"""Joints faster than this [rad/s] while the tool is slower than this [m/s] may be a tremble."""
_TOUCH = 0.002
"""It happens where bodies are hardly farther apart than they should be [m]."""
_LOOK_AHEAD, _CALM = 4, 0.05
"""Ticks that tell a tremble from a turn, and what is left of it."""
_TRUST = 0.3
"""Largest joint step of one solve along a path [rad]."""
_AHEAD = 0.05
"""How far a body moves at most until obstacles are looked for again [m]."""
_FAR_AHEAD = 0.3
"""The same from one position of a path to the next [m]."""
_FIRST, _OTHERS = 80, 20
"""Largest number of solves for the first position of a path and for each other one."""
_REACHED, _STILL = 1e-4, 1e-3
"""A path point is solved when the tip is this near [m] and the joints move less than that [rad]."""


class Solver:
    """One placo robot with its programs; belongs to one arm at a time."""

    def __init__(self, folder: Path, posture: FloatArray) -> None:
        self.kinematics = urdf.kinematics(folder.joinpath(urdf.ROBOT_FILE).read_text("utf-8"))
        self._robot = placo.RobotWrapper(str(folder), 0)
        self._bodies = Bodies(self._robot, folder)
        self._columns = [self._robot.get_joint_offset(name) for name in urdf.JOINT_NAMES]
        self._posture = posture
        self._endless = self.kinematics.upper >= urdf.ENDLESS
        self._programs: dict[tuple[bool, Wrist], Program] = {}
        self._conditions = FREE

    def heed(self, conditions: Conditions) -> Solver:
        """From now on heed these conditions; gives itself."""
        if conditions is not self._conditions:
            self._bodies.surround(conditions.obstacles)
            self._conditions = conditions
        return self

    def tip(self, joints: FloatArray) -> FloatArray:
        """Give the (3,) position of the tool [m]."""
        self._place(joints)
        return self._tip()

    def frames(self, joints: FloatArray, names: Sequence[str]) -> list[FloatArray]:
        """Give the (4, 4) pose of each named frame in the world."""
        self._place(joints)
        return [self._robot.get_T_world_frame(name) for name in names]

    def drag(self, joints: FloatArray, target: FloatArray, dt: float) -> FloatArray:
        """Move the tool towards a reachable target for one tick of ``dt`` seconds.

        Where two faces are parallel, the points nearest to each other leap from corner to corner, and an arm
        that rests there would tremble: then it takes a part of what the next ticks together come to.
        """
        moved = self._tick(joints, target, dt)
        if not self._may_tremble(joints, moved, dt):
            return joints + moved
        ahead = joints + moved
        for _ in range(_LOOK_AHEAD - 1):
            ahead = ahead + self._tick(ahead, target, dt)
        mean = (ahead - joints) / _LOOK_AHEAD
        trembles = np.abs(mean).max() < 0.5 * np.abs(moved).max()
        return joints + (_CALM * mean if trembles else moved)

    def _tick(self, joints: FloatArray, target: FloatArray, dt: float) -> FloatArray:
        """Give the movement (6,) of one tick [rad]."""
        program = self._begin(joints, avoid=True, wrist=None)
        self._robot.set_velocity_limits(DRAG_SPEED)
        program.solver.dt = dt / _SOLVES_PER_TICK
        program.aim(target)
        for _ in range(_SOLVES_PER_TICK):
            if self._solve(program, target) < _AT_REST:
                break
        return np.clip(self._joints() - joints, -DRAG_SPEED * dt, DRAG_SPEED * dt)

    def _may_tremble(self, joints: FloatArray, moved: FloatArray, dt: float) -> bool:
        """Say whether joints turn though the tool rests and something is touched."""
        if np.abs(moved).max() < _TREMBLE * dt:
            return False
        after = self._tip()
        self._place(joints)
        if math.dist(self._tip(), after) > _SLOW * dt:
            return False
        nearest = self._bodies.nearest()
        return min(nearest.itself, nearest.obstacle) < SAFE_DISTANCE + _TOUCH

    def walk(
        self,
        positions: FloatArray,
        start: FloatArray,
        *,
        careful: bool = False,
        wrist: Wrist | None = None,
        rotations: FloatArray | None = None,
    ) -> JointPath:
        """Visit positions (K, 3) one after the other, each from the joints of the one before.

        Parameters
        ----------
        positions : (K, 3) array
            Where the tool should be [m].
        start : (6,) array
            Joints to begin from [rad].
        careful : bool
            Keep the bodies of the arm apart and off obstacles; costs ten times as much.
        wrist : optional
            How the tool is held; None: as the conditions say.
        rotations : (K, 3, 3) array, optional
            Of the tool in the world, for a wrist that is ``shown``.

        Returns
        -------
        JointPath
            Joints and distances left.
        """
        program = self._begin(start, avoid=careful, wrist=wrist)
        self._robot.set_velocity_limits(_TRUST)
        program.solver.dt = 1.0
        joints, errors = np.empty((len(positions), len(start))), np.empty(len(positions))
        for index, position in enumerate(positions):
            if careful:
                self._bodies.watch(_FAR_AHEAD)
            if wrist == "shown" and rotations is not None:
                program.hold(rotations[index])
            errors[index] = self._converge(program, position, _FIRST if index == 0 else _OTHERS)
            joints[index] = self._joints()
        return JointPath(joints, errors)

    def clearance(self, configurations: FloatArray) -> Clearance:
        """Measure along configurations (K, 6); as `app.arm.protocol.Arm.clearance`."""
        itself, obstacles = np.empty(len(configurations)), np.empty(len(configurations))
        pairs: list[tuple[str, str]] = []
        for index, joints in enumerate(configurations):
            self._place(joints)
            nearest = self._bodies.nearest()
            itself[index], obstacles[index] = nearest.itself, nearest.obstacle
            pairs.append((nearest.link, nearest.name))
        return Clearance(
            itself, obstacles, tuple(link for link, _ in pairs), tuple(name for _, name in pairs)
        )

    def room(self, configurations: FloatArray) -> float:
        """Give the smallest distance of the arm from itself and from obstacles along (K, 6) [m]."""
        found = self.clearance(configurations)
        return float(min(found.itself.min(), found.obstacles.min()))

    def inside(self, position: FloatArray) -> str:
        """Name the obstacle that a position (3,) lies deep in; empty when in none."""
        return self._bodies.around(position)

    def lowest(self, joints: FloatArray) -> float:
        """Give the height of the lowest of elbow, wrist and tool [m]."""
        self._place(joints)
        return min(
            float(self._robot.get_T_world_frame(name)[2, 3]) for name in (*urdf.MOVING_LINKS[1:], urdf.TOOL)
        )

    @property
    def endless(self) -> npt.NDArray[np.bool_]:
        """(6,) which joints turn without end."""
        return self._endless

    def _begin(self, joints: FloatArray, *, avoid: bool, wrist: Wrist | None) -> Program:
        """Place the arm and give the program for it."""
        orientation = None if wrist == "shown" else self._conditions.orientation
        if wrist is None or orientation is not None:
            wrist = "down" if orientation is None else "locked"
        if (avoid, wrist) not in self._programs:
            self._programs[avoid, wrist] = Program(self._robot, avoid=avoid, wrist=wrist)
        program = self._programs[avoid, wrist]
        if orientation is not None:
            program.hold(rotation_of(orientation))
        self._place(joints)
        if avoid:
            self._bodies.watch(TRIGGER + _AHEAD)
        program.rest_at(self._posture_near(joints))
        return program

    def _converge(self, program: Program, position: FloatArray, iterations: int) -> float:
        program.aim(position)
        for _ in range(iterations):
            moved = self._solve(program, position)
            if moved < _STILL and math.dist(self._tip(), position) < _REACHED:
                break
        return math.dist(self._tip(), position)

    def _solve(self, program: Program, position: FloatArray) -> float:
        """Take one step; give the largest joint movement [rad]."""
        moved = program.solve(math.dist(self._tip(), position))
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
