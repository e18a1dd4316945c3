"""Pulling the hand: the one pull that takes time, because the arm has to follow.

What is recorded is where the hand really was, in exact ticks of 10 ms, never where the
pointer was. While a demonstration is being drawn it is shown as if it were finished: the
part so far, continued to the end by the ratio rule from where the hand is.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app import edits, servo
from app.arm.protocol import Arm, Shortfall
from app.document import Document, FloatArray
from app.model import Model
from app.servo import Motion
from app.store import Hand
from gc_core import Demonstration, GeneralizedCylinder, reproduce

LATE: Final = 0.3
"""A hand that is off its target for this long cannot follow [s]."""
SHOWN_FROM: Final = 0.03
"""A drawn part is shown as a demonstration from this length on [m]."""
LOST: Final = 0.001
"""A sample that misses its way back by more than this has none [m]."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """A demonstration as far as it was recorded."""

    times: FloatArray
    """(T,) from 0 [s]."""
    positions: FloatArray
    """(T, 3) [m]."""
    gripper: FloatArray
    """(T,) 0 open .. 1 closed."""

    @property
    def length(self) -> float:
        """Way of the hand [m]."""
        return float(np.sum(np.linalg.norm(np.diff(self.positions, axis=0), axis=1)))


class HandPull:
    """The hand being pulled, from the grab to the release."""

    node: Final = "/hand"

    def __init__(self, arm: Arm, hand: Hand, now: float, *, records: bool) -> None:
        self.records: Final = records
        """Whether this is a demonstration, or the hand is merely put elsewhere."""
        self.begins_at: Final = hand
        self._arm = arm
        self._servo = servo.begin(arm, hand.joints, now)
        self._off_since: float | None = None
        """Since when the hand is off its target [s]; None while it is there."""
        self._gripper = hand.gripper
        self._began = self._servo.time
        self._drawn = Drawn(np.zeros(1), hand.position[None], np.full(1, hand.gripper))
        self._station = 0

    def aim(self, time: float, target: FloatArray) -> None:
        """The pointer wants the hand at a place [m]."""
        event = np.concatenate([[time], target])
        self._servo = replace(self._servo, pending=np.vstack([self._servo.pending, event]))

    def set_gripper(self, gripper: float) -> None:
        """Open (0) or close (1) the hand from now on."""
        self._gripper = gripper

    def advance(self, until: float) -> Hand:
        """Let the arm follow to a time; returns where it is."""
        self._servo, motion = servo.advance(self._servo, self._arm, (), until)
        self._record(motion)
        return self._hand()

    def finish(self, at_most: float = servo.SETTLE_TIME) -> Hand:
        """Let the arm arrive where the pointer let go, within a time [s]; returns where it is.

        A hand that is merely put somewhere stays there, so it says at once where it could not follow.
        """
        self._servo, motion = servo.settle(self._servo, self._arm, at_most)
        self._record(motion)
        if not self.records:
            self._off_since = -np.inf
        return self._hand()

    def drawn(self) -> Drawn:
        """Give what was recorded."""
        return self._drawn

    def preview(self, cylinder: GeneralizedCylinder | None) -> Demonstration | None:
        """Give the demonstration as it would be if the ratio rule finished it.

        Parameters
        ----------
        cylinder : GeneralizedCylinder or None
            Of the finished demonstrations; None: there are none, only the part is given.

        Returns
        -------
        Demonstration or None
            None while there is too little of it, or when the hand is not recording.
        """
        if not self.records or self._drawn.length < SHOWN_FROM:
            return None
        part = demonstration(self._drawn)
        if cylinder is None:
            return part
        self._station = max(self._station, int(cylinder.locate(part.positions[-1:])[0][0]))
        return continued(part, cylinder, self._station)

    def _record(self, motion: Motion) -> None:
        if not len(motion.times):
            return
        drawn = self._drawn
        self._drawn = Drawn(
            np.concatenate([drawn.times, motion.times - self._began]),
            np.concatenate([drawn.positions, motion.positions]),
            np.concatenate([drawn.gripper, np.full(len(motion.times), self._gripper)]),
        )

    def _hand(self) -> Hand:
        joints, position = self._servo.joints, self._drawn.positions[-1]
        shortfall = self._shortfall(joints)
        return Hand(
            joints,
            position,
            self._gripper,
            wanted=None if shortfall is None else self._servo.target,
            shortfall=shortfall,
            recording=self._drawn.positions if self.records else None,
            returns_to=self.begins_at.position if self.records else None,
        )

    def _shortfall(self, joints: FloatArray) -> Shortfall | None:
        short = self._arm.shortfall(joints, self._servo.target)
        if short is None:
            self._off_since = None
            return None
        if self._off_since is None:
            self._off_since = self._servo.time
        return short if self._servo.time - self._off_since >= LATE else None


def demonstration(drawn: Drawn) -> Demonstration:
    """Make a demonstration of what was recorded."""
    return Demonstration(drawn.times, drawn.positions, gripper=drawn.gripper)


@dataclass(frozen=True, eq=False)
class TakenBack:
    """A demonstration as it is kept: where the landmarks stood when the skill was taught."""

    demonstration: Demonstration
    carried: bool = False
    """Landmarks were moved, so that it is not where it was drawn."""
    muted: bool = False
    """There is no way back from where it was drawn, so that nothing can be learned from it."""


def taken_back(shown: Demonstration, among: Model) -> TakenBack:
    """Undo what moved landmarks do to a demonstration that is shown among them.

    The tube, bent as they bend it, then holds it where it was drawn. Where the map folds there is no such
    place; the demonstration is kept as it was drawn.
    """
    if among.registration is None:
        return TakenBack(shown)
    places, misses = among.taken_back(shown.positions)
    if misses.max() > LOST:
        return TakenBack(shown, muted=True)
    return TakenBack(replace(shown, positions=places), carried=True)


def added(document: Document, shown: TakenBack) -> Document:
    """Add a demonstration as it is kept."""
    document = edits.add_demonstrations(document, [shown.demonstration])
    return edits.mute_demonstration(document, len(document.demonstrations) - 1, shown.muted)


def continued(part: Demonstration, cylinder: GeneralizedCylinder, station: int) -> Demonstration:
    """Continue a drawn part to the end of the cylinder by the ratio rule from a station on."""
    if station >= len(cylinder.directrix) - 2:
        return part
    rest = reproduce(cylinder, part.positions[-1], at=station, outside="boundary")
    times = part.times[-1] + rest.times[1:] - rest.times[0]
    return Demonstration(
        np.concatenate([part.times, times]), np.concatenate([part.positions, rest.positions[1:]])
    )
