"""The tool of a led hand being turned: the lock that the arm heeds goes to the wanted one at a bounded speed.

The arm follows by its servo, so nothing ever jumps. Where it does not follow, the lock stops and stays
where the tool is; otherwise it would push the hand off its place.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from app import turning
from app.arm.conditions import Conditions
from app.arm.protocol import HERE, Arm, FloatArray
from app.arm.shapes import Quadruple

TICK: Final = 0.01
"""Of the servo [s]."""
SPEED: Final = 1.2
"""The tool turns this fast [rad/s]."""
LAGS: Final = 0.12
"""The lock waits for a tool that is this far behind [rad]."""
PATIENCE: Final = 0.3
"""After this long the tool does not follow any more [s]."""
THERE: Final = 0.01
"""A tool this near to its lock has arrived [rad]."""


class ToolTurn:
    """How the tool of one led hand is held, and how it shall be."""

    def __init__(self, arm: Arm, joints: FloatArray) -> None:
        self.arm = arm
        """Heeds the lock as it is now."""
        self.stopped_by = ""
        """What keeps the tool from being turned as wanted."""
        self._given: Conditions | None = None
        self._wanted: Quadruple | None = None
        self._behind = 0.0
        """For how long the tool has been behind [s]."""
        self.heed(arm.conditions, joints)

    @property
    def held(self) -> Quadruple | None:
        """How the tool is held now; None: it is free."""
        return self.arm.conditions.orientation

    @property
    def turning(self) -> bool:
        """Whether it still has to turn."""
        return self._wanted is not None

    def now(self, joints: FloatArray) -> Quadruple:
        """Give how the tool is really turned."""
        return turning.orientation_of(self.arm.tool_pose(joints))

    def heed(self, conditions: Conditions, joints: FloatArray) -> None:
        """From now on keep off these things, and turn to how the tool shall be held."""
        if conditions == self._given:
            return
        self._given = conditions
        begin = conditions.orientation and self.now(joints)
        self.arm = self.arm.under(replace(conditions, orientation=begin))
        self._wanted, self._behind, self.stopped_by = conditions.orientation, 0.0, ""

    def turn(self, joints: FloatArray, target: FloatArray, *, rests: bool) -> None:
        """Turn the lock on by one tick, unless the tool is behind or the hand is off its target.

        Parameters
        ----------
        joints : (J,) array
            Before the tick [rad].
        target : (3,) array
            Where the hand should be [m].
        rests : bool
            Whether the hand does not move: then what is behind will not come any more.
        """
        lock, wanted, now = self.held, self._wanted, self.now(joints)
        if lock is None or wanted is None:
            return
        off = float(np.linalg.norm(self.arm.tool_pose(joints)[:3, 3] - target))
        behind = turning.apart(now, lock)
        if lock == wanted and behind < THERE:
            self._wanted = None
        elif lock != wanted and behind < LAGS and off < HERE:
            self._behind = 0.0
            self._hold(turning.towards(lock, wanted, SPEED * TICK))
        elif rests:
            self._behind += TICK
            if self._behind >= PATIENCE:
                self._wanted, self.stopped_by = None, turning.stopped_by(self.arm, joints)
                self._hold(now)

    def _hold(self, lock: Quadruple) -> None:
        self.arm = self.arm.under(replace(self.arm.conditions, orientation=lock))
