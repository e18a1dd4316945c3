"""Pulling the hand: the one pull that takes time, because the arm has to follow.

What is recorded is where the hand really was, in exact ticks of 10 ms, never where the
pointer was. While a demonstration is being drawn it is shown as if it were finished: the
part so far, continued to the end by the ratio rule from where the hand is.
"""

from dataclasses import replace
from typing import Final

import numpy as np
import numpy.typing as npt

from app import servo
from app.arm.conditions import Conditions
from app.arm.protocol import HERE, Arm, Shortfall
from app.arm.shapes import Quadruple
from app.document import FloatArray
from app.drawn import Drawn, continued, demonstration
from app.inquiry import Inquiry
from app.servo import Motion
from app.store import Hand
from app.toolturn import SPEED, TICK, ToolTurn
from gc_core import Demonstration, GeneralizedCylinder

WALK: Final = 0.25
"""Led by buttons and numbers the hand walks this fast [m/s]."""
PATIENT: Final = 3.0
"""Then it is given this time to arrive after its last step, which takes it anywhere [s]."""
LONGEST_REST: Final = 30
"""A longer rest between two presses of buttons is not recorded [ticks]."""
AT_REST: Final = 5
"""A hand that did not move for so long rests [ticks]."""
ASK_AGAIN: Final = 0.02
"""Why the hand cannot follow is asked again when the pointer has gone this far [m]."""
ON_ITS_WAY: Final = "still on its way"
"""What an arm says whose hand still moves."""
LATE: Final = 0.3
"""A hand that is off its target for this long cannot follow [s]."""
SHOWN_FROM: Final = 0.03
"""A drawn part is shown as a demonstration from this length on [m]."""


class HandPull:
    """The hand being led by a pointer, from the grab to the release, or by buttons and numbers.

    What buttons record is without the waiting between them: time stands still while the hand does.
    """

    node: Final = "/hand"

    def __init__(self, arm: Arm, hand: Hand, now: float, *, records: bool, pointed: bool = True) -> None:
        self.records: Final = records
        """Whether this is a demonstration, or the hand is merely put elsewhere."""
        self.pointed: Final = pointed
        """Whether a pointer leads it."""
        self.begins_at: Final = hand
        self._servo = servo.begin(arm, hand.joints, now)
        self._tool = ToolTurn(arm, hand.joints)
        self._until = now
        self._off_since: float | None = None
        """Since when the hand is off its target [s]; None while it is there."""
        self._inquiry: Inquiry | None = None
        self._answer: Shortfall | None = None
        self._asked_for = hand.position
        self._gripper = hand.gripper
        self._began = self._servo.time
        held = self._tool.held
        self._drawn = Drawn(
            np.zeros(1),
            hand.position[None],
            np.full(1, hand.gripper),
            np.array([self._tool.now(hand.joints)]) if held is not None else None,
        )
        self._rested = self._idle = 0
        """Ticks since the hand last moved; since it moved, turned or gripped."""
        self._station = 0
        self._shown: Hand | None = None

    @property
    def inquiry(self) -> Inquiry | None:
        """What a worker should find out; the same object until it is answered."""
        return self._inquiry

    @property
    def held(self) -> Quadruple | None:
        """How the tool is held now; None: it is free."""
        return self._tool.held

    @property
    def target(self) -> FloatArray:
        """(3,) where the hand is wanted [m]."""
        return self._servo.aim

    def heed(self, conditions: Conditions) -> None:
        """From now on keep off these things, and turn the tool as it shall be held."""
        self._tool.heed(conditions, self._servo.joints)

    def aim(self, time: float, target: FloatArray) -> None:
        """The pointer wants the hand at a place [m]."""
        self._expect(np.concatenate([[time], target])[None])

    def go(self, time: float, target: FloatArray) -> None:
        """Buttons or numbers want the hand at a place (3,) [m]; after what it still has to do."""
        begin, since = self.target, max(time, float(self._servo.pending[:, 0].max(initial=time)))
        n_events = max(1, int(np.ceil(np.linalg.norm(target - begin) / (WALK * servo.USUAL_GAP))))
        steps = np.arange(1, n_events + 1, dtype=np.float64)
        times, places = (
            since + servo.USUAL_GAP * steps,
            begin + (steps / n_events)[:, None] * (target - begin),
        )
        self._expect(np.hstack([times[:, None], places]))
        self._until = max(self._until, float(times[-1]) + PATIENT)

    def turns(self, time: float) -> None:
        """Give the tool time to turn, even half round."""
        self._until = max(self._until, time + np.pi / SPEED + PATIENT)

    def arrived(self, now: float) -> bool:
        """Whether buttons and numbers have led it where they want it, or never will."""
        if self.pointed or self.records:
            return False
        rests = self._servo.waits and not self._tool.turning and self._rested >= AT_REST
        return rests or now >= self._until

    def set_gripper(self, gripper: float) -> None:
        """Open (0) or close (1) the hand from now on."""
        self._gripper, self._idle = gripper, 0

    def advance(self, until: float) -> Hand:
        """Let the arm follow to a time; returns where it is."""
        while self._tool.turning and self._servo.time + TICK <= until + 1e-9:
            self._tool.turn(self._servo.joints, self._servo.target, rests=self._rested >= AT_REST)
            self._move(round(self._servo.time + TICK, 6))
        self._move(until)
        return self._hand()

    def finish(self) -> Hand:
        """Let the arm arrive where the pointer let go; returns where it is.

        A hand that is merely put somewhere stays there, so it says at once where it could not follow. One
        that was led by buttons stops where it is.
        """
        at_most = servo.SETTLE_TIME if self.pointed or self.records else 0.0
        self._servo, motion = servo.settle(self._servo, self._tool.arm, at_most)
        self._record(motion)
        hand = self._hand()
        if self.records:
            return hand
        short = self._tool.arm.shortfall(self._servo.joints, self.target)
        return replace(hand, shortfall=short, wanted=None if short is None else self.target, aim=None)

    def answered(self, inquiry: Inquiry, answer: Shortfall | None) -> None:
        """Learn why the hand cannot follow; an arm that still moved has to be asked again."""
        if inquiry is self._inquiry:
            self._inquiry = None
            if answer is None or answer.reason != ON_ITS_WAY:
                self._answer = answer

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

    def _expect(self, events: FloatArray) -> None:
        self._servo = replace(self._servo, pending=np.vstack([self._servo.pending, events]))

    def _move(self, until: float) -> None:
        self._servo, motion = servo.advance(self._servo, self._tool.arm, (), until)
        self._record(motion)

    def _record(self, motion: Motion) -> None:
        kept = self._worth_keeping(motion)
        if not kept.any():
            return
        drawn, times = self._drawn, motion.times[kept] - self._began
        if not self.pointed:
            times = drawn.times[-1] + TICK * np.arange(1, len(times) + 1)
        orientations = drawn.orientations
        if orientations is not None and self._tool.held is not None:
            now = [self._tool.now(joints) for joints in motion.joints[kept]]
            orientations = np.concatenate([orientations, now])
        else:
            orientations = None
        self._drawn = Drawn(
            np.concatenate([drawn.times, times]),
            np.concatenate([drawn.positions, motion.positions[kept]]),
            np.concatenate([drawn.gripper, np.full(len(times), self._gripper)]),
            orientations,
        )

    def _worth_keeping(self, motion: Motion) -> npt.NDArray[np.bool_]:
        """Tell (T,) which ticks belong to the motion: no long rests between buttons."""
        before = np.vstack([self._drawn.positions[-1:], motion.positions])[:-1]
        moves = np.linalg.norm(motion.positions - before, axis=1) > servo.STOPPED
        kept = np.ones(len(moves), dtype=np.bool_)
        for tick, moved in enumerate(moves):
            self._rested = 0 if moved else self._rested + 1
            self._idle = 0 if moved or self._tool.turning else self._idle + 1
            kept[tick] = self.pointed or self._idle <= LONGEST_REST
        return kept

    def _hand(self) -> Hand:
        joints, drawn = self._servo.joints, self._drawn
        shortfall = self._shortfall()
        hand = Hand(
            joints,
            drawn.positions[-1],
            self._gripper,
            wanted=None if shortfall is None else self._servo.target,
            shortfall=shortfall,
            recording=drawn.positions if self.records else None,
            returns_to=self.begins_at.position if self.records else None,
            aim=None if self.pointed else self.target,
            unturned=self._tool.stopped_by,
            turned=self._tool.now(joints),
        )
        if self._shown is None or not _same(self._shown, hand):
            self._shown = hand
        return self._shown

    def _shortfall(self) -> Shortfall | None:
        """Say why the hand is not at its target: at once where the place alone tells, else when answered."""
        target, time = self._servo.target, self._servo.time
        off = float(np.linalg.norm(self._drawn.positions[-1] - target))
        if off <= HERE:
            self._off_since = self._inquiry = self._answer = None
            return None
        if self._off_since is None:
            self._off_since = time
        if time - self._off_since < LATE:
            return None
        reason = self._tool.arm.unreachable(target[None])
        if reason is not None:
            self._inquiry = self._answer = None
            return Shortfall(off, reason)
        if self._inquiry is None and (self._answer is None or self._asked_elsewhere(target)):
            self._inquiry = Inquiry(self._servo.joints, target, self._tool.arm.conditions)
            self._asked_for = target
        return None if self._answer is None else replace(self._answer, distance=off)

    def _asked_elsewhere(self, target: FloatArray) -> bool:
        return bool(np.linalg.norm(self._asked_for - target) > ASK_AGAIN)


def _same(one: Hand, other: Hand) -> bool:
    """Whether two hands would be drawn alike."""
    return (
        np.array_equal(one.joints, other.joints)
        and (one.recording is other.recording and one.shortfall == other.shortfall)
        and (one.gripper, one.unturned) == (other.gripper, other.unturned)
        and _same_place(one.wanted, other.wanted)
        and _same_place(one.aim, other.aim)
    )


def _same_place(one: FloatArray | None, other: FloatArray | None) -> bool:
    return one is other or (one is not None and other is not None and np.array_equal(one, other))
