"""Where the arm is: pulled by the hand, on its way back, led by the playhead, or at rest."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app.arm.protocol import Arm, FloatArray, JointPath
from app.servo import Motion, return_home, swing
from app.store import Hand
from app.turning import orientation_of
from gc_core import Reproduction

SERVO_TICK: Final = 0.01
"""Of the hand's servo [s]."""
LARGEST_LEAD: Final = 10
"""Servo ticks at most in one step of the driver."""
FASTEST: Final = 3.0
"""No joint turns faster than this when the arm catches up with the playhead [rad/s]."""
RETURN: Final = 1.0
"""The hand goes back to its start in this time [s]."""
STILL: Final = 1e-3
"""A joint that moves less than this in a step is at rest [rad]."""


@dataclass(frozen=True, eq=False)
class Lead:
    """Where the playhead wants the arm."""

    position: FloatArray
    """(3,) of the tool [m]."""
    joints: FloatArray | None
    """(J,) once the joint path is known [rad]."""
    gripper: float


def lead_at(time: float, run: Reproduction, path: JointPath | None) -> Lead:
    """Read a reproduction, and its joint path where there is one, at a time [s]."""
    index = int(np.clip(np.searchsorted(run.times, time, side="right") - 1, 0, len(run.times) - 2))
    span = run.times[index + 1] - run.times[index]
    share = float(np.clip((time - run.times[index]) / span, 0.0, 1.0)) if span > 0.0 else 0.0

    def between(values: FloatArray) -> FloatArray:
        return (1.0 - share) * values[index] + share * values[index + 1]

    gripper = 0.0 if run.gripper is None else float(run.gripper[index])
    return Lead(between(run.positions), None if path is None else between(path.joints), gripper)


def hand_at(arm: Arm, joints: FloatArray, gripper: float = 0.0) -> Hand:
    """Give the hand of an arm with joints (J,) [rad]: where its tool is then, and how it is turned."""
    pose = arm.tool_pose(joints)
    return Hand(joints, pose[:3, 3], gripper, turned=orientation_of(pose))


class Driver:
    """Keeps the arm's joints; everything that moves them goes through here."""

    def __init__(self, arm: Arm) -> None:
        self._arm = arm
        self._leads = True
        self._way: tuple[float, Motion] | None = None
        self.hand = hand_at(arm, arm.home)

    def use(self, arm: Arm) -> None:
        """From now on move the same arm under other conditions."""
        self._arm = arm

    def lead(self) -> None:
        """From now on the arm follows the playhead."""
        self._leads, self._way = True, None

    def pulled(self, hand: Hand) -> None:
        """Take over where the servo has brought the pulled hand."""
        self._leads, self._way, self.hand = False, None, hand

    def released(self, hand: Hand, back_to: FloatArray | None, now: float) -> bool:
        """Stay where the hand was let go, or go back to the joints it was grabbed at.

        Returns
        -------
        bool
            False when it should go back and no way is clear of the arm itself, of things and of the table;
            then it stays.
        """
        self.pulled(hand)
        if back_to is None:
            return True
        way = self._arm.way(hand.joints, back_to)
        if way is None:
            return False
        straight = return_home(self._arm, way[0], way[-1], duration=RETURN)
        self._way = now, straight if len(way) == 2 else swing(self._arm, way)
        return True

    def swings(self, motion: Motion, now: float) -> None:
        """Go this way from where it begins."""
        self._leads, self._way = False, (now, motion)

    def grip(self, gripper: float) -> None:
        """Open (0) or close (1) the hand."""
        self.hand = replace(self.hand, gripper=gripper)

    def tick(self, now: float, dt: float, lead: Lead | None) -> bool:
        """Move the arm on; returns whether it still moves."""
        if self._way is not None:
            return self._go_back(now)
        if not self._leads or lead is None:
            return False
        before = self.hand.joints
        joints = self._catch_up(before, lead, dt)
        moved = bool(np.max(np.abs(joints - before)) > STILL)
        if moved or lead.gripper != self.hand.gripper:
            self.hand = hand_at(self._arm, joints, lead.gripper)
        return moved

    def _go_back(self, now: float) -> bool:
        assert self._way is not None
        began, motion = self._way
        index = int(np.searchsorted(motion.times, now - began))
        if index >= len(motion.times):
            self.hand, self._way = hand_at(self._arm, motion.joints[-1], self.hand.gripper), None
            return False
        on_its_way = hand_at(self._arm, motion.joints[index], self.hand.gripper)
        self.hand = replace(on_its_way, returns_to=motion.positions[-1])
        return True

    def _catch_up(self, joints: FloatArray, lead: Lead, dt: float) -> FloatArray:
        if lead.joints is not None:
            most = FASTEST * max(dt, SERVO_TICK)
            return joints + np.clip(lead.joints - joints, -most, most)
        for _ in range(min(max(round(dt / SERVO_TICK), 1), LARGEST_LEAD)):
            joints = self._arm.step(joints, lead.position, SERVO_TICK)
        return joints
