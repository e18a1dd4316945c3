"""Questions about the arm that take a tenth of a second or more: asked by the desk, answered in a worker."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from app import servo
from app.actor import Latest
from app.arm.conditions import Conditions
from app.arm.protocol import Arm, FloatArray, Shortfall
from app.servo import Motion

Answer: TypeAlias = Shortfall | Motion | None


@dataclass(frozen=True, eq=False)
class Inquiry:
    """Why the hand is not at a target, or how it comes there by another posture of the arm."""

    joints: FloatArray
    """(J,) of the arm when it was asked [rad]."""
    target: FloatArray
    """(3,) where the hand is wanted [m]."""
    conditions: Conditions
    """What the arm heeds."""
    way: bool = False
    """Whether a way there is asked for, or only the reason."""

    def answer(self, arm: Arm) -> Answer:
        """Find it out with an arm that nobody else uses meanwhile."""
        heeding = arm.under(self.conditions)
        if self.way:
            return servo.reposition(heeding, self.joints, self.target)
        return heeding.shortfall(self.joints, self.target)


class Inquirer:
    """Has inquiries answered in a worker, each once, the newest first."""

    def __init__(self, latest: Latest, make_arm: Callable[[], Arm]) -> None:
        self._latest, self._make_arm = latest, make_arm
        self._asked: Inquiry | None = None

    def ask(self, inquiry: Inquiry | None, answered: Callable[[Inquiry, Answer], None]) -> None:
        """Have it answered, unless it is already; the answer comes back in the session's mailbox."""
        if inquiry is None or inquiry is self._asked:
            return
        self._asked = inquiry

        def job() -> Answer:
            arm = self._make_arm()
            try:
                return inquiry.answer(arm)
            finally:
                arm.close()

        self._latest.submit(job, lambda answer: answered(inquiry, answer))
