"""The quadratic programs that placo solves: what is wanted of the tool, and how much."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Literal, TypeAlias

import numpy as np

from app.arm import urdf
from app.arm.protocol import FloatArray

Wrist: TypeAlias = Literal["down", "free", "locked", "shown"]
"""The tool rather points down, turns as it likes, keeps an orientation, or rather follows those shown."""

SAFE_DISTANCE = 0.01
"""Bodies of the arm stay this far from each other and from obstacles [m]."""

# Not an import statement: placo lives in a prefix of its own, and its stubs name types that do not exist.
placo: Any = import_module("placo")
_DAMPING, _DAMPING_PER_METRE = 1e-6, 0.1
_TOOL_DOWN, _POSTURE, _AVOID = 1e-5, 1e-6, 1e3
_LOCKED = 0.1
"""A turn of the locked tool by 1 rad costs as much as a miss of 0.3 m."""
_SHOWN = 1e-4
"""Along a path the places come first: where both cannot be, the tool is turned otherwise."""
TRIGGER = 0.06
"""Bodies begin to keep away from each other at this distance [m]."""


class Program:
    """One quadratic program: position first, the tool's direction a little, posture hardly."""

    def __init__(self, robot: Any, *, avoid: bool, wrist: Wrist) -> None:
        self.solver = placo.KinematicsSolver(robot)
        self.solver.mask_fbase(True)
        # "soft" throughout: a hard position has no solution where the arm cannot reach.
        self._position = self.solver.add_position_task(urdf.TOOL, np.zeros(3))
        self._position.configure("position", "soft", 1.0)
        upwards = np.array([0.0, 0.0, 1.0])
        if wrist == "down":
            axis = self.solver.add_axisalign_task(urdf.TOOL, upwards, -upwards)
            axis.configure("tool down", "soft", _TOOL_DOWN)
        if wrist in ("locked", "shown"):
            self._orientation = self.solver.add_orientation_task(urdf.TOOL, np.eye(3))
            self._orientation.configure(wrist, "soft", _LOCKED if wrist == "locked" else _SHOWN)
        self._rest = self.solver.add_joints_task()
        self._rest.set_joints(dict.fromkeys(urdf.JOINT_NAMES, 0.0))
        self._rest.configure("posture", "soft", _POSTURE)
        self._damping = self.solver.add_regularization_task(_DAMPING)
        self.solver.enable_joint_limits(True)
        self.solver.enable_velocity_limits(True)
        if avoid:
            apart = self.solver.add_avoid_self_collisions_constraint()
            apart.configure("apart", "soft", _AVOID)
            apart.self_collisions_margin = SAFE_DISTANCE
            apart.self_collisions_trigger = TRIGGER

    def rest_at(self, posture: FloatArray) -> None:
        """Prefer this posture where position and tool leave a choice."""
        self._rest.set_joints(dict(zip(urdf.JOINT_NAMES, posture.tolist(), strict=True)))

    def hold(self, rotation: FloatArray) -> None:
        """Want the tool at a (3, 3) rotation in the world; for a wrist that is locked or shown."""
        self._orientation.R_world_frame = rotation

    def aim(self, position: FloatArray) -> None:
        """Want the tool at a position (3,) [m]."""
        self._position.target_world = position

    def solve(self, distance: float) -> float:
        """Take one step, the tool being a distance [m] away; give the largest joint movement [rad]."""
        self._damping.set_weight(_DAMPING + _DAMPING_PER_METRE * distance)
        try:
            return float(np.abs(self.solver.solve(True)).max())
        except RuntimeError:
            # The quadratic program had no solution; placo then leaves the joints as they were.
            return 0.0
