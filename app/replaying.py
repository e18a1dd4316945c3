"""A replay in progress: the arm goes to where a path begins, replays it, and yields when its hand is pulled.

What is recorded is where the hand really was, in exact ticks of 10 ms; the way to the
beginning is not. Every event of a pull counts with its time of arrival.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from app import compliance, gesture, servo
from app.actions import Drag
from app.arm.protocol import Arm
from app.compliance import Feel, Replayed
from app.document import FloatArray
from app.driver import hand_at
from app.gesture import Track
from app.progress import Progress
from app.route import Route
from app.servo import Motion
from app.store import Hand
from app.subject import Subject
from gc_core import Demonstration, Reproduction
from gc_core.arrays import evenly

MOST_SAMPLES: Final = 400
"""A route is planned at so many of a path's samples."""
APPROACH: Final = 1.0
"""The arm goes to where the path begins in this time, or slower [s]."""
LONGEST: Final = 300.0
"""A replay ends by itself after this time, even if the hand is still held [s]."""
SETTLING: Final = 1.5
"""A replay that is stopped is continued this long at most, to see how the hand eases back [s]."""
EASING: Final = 0.5
"""What a hand that is held would do if it were let go: it would ease back in about this time [s]."""
GUESSED: Final = 10
"""... is found out anew after so many ticks."""
BACK: Final = 0.001
"""A hand this near to its path is back on it [m]."""
SLIP: Final = 0.001
"""A hand that was nowhere moved by more than this was not corrected [m]."""


@dataclass(frozen=True, eq=False)
class Corrected:
    """What the hand did during a replay in which it was pulled."""

    times: FloatArray
    """(T,) on the clock of what was replayed, increasing; 100 in a second of the replay [s]."""
    positions: FloatArray
    """(T, 3) where the hand was [m]."""
    route: FloatArray
    """(T, 3) where it would have been; the same as `positions` before the first pull [m]."""
    held: npt.NDArray[np.bool_]
    """(T,) whether the hand was held."""
    events: int
    """How many events of pulls were used."""

    @property
    def farthest(self) -> float:
        """How far the hand was moved at most [m]."""
        return float(np.linalg.norm(self.positions - self.route, axis=1).max())


class Replaying:
    """A replay, from its beginning to its end."""

    def __init__(
        self, arm: Arm, subject: Subject, hand: Hand, now: float, *, feel: Feel, speed: float
    ) -> None:
        """Set out for the beginning of a path.

        Parameters
        ----------
        arm : Arm
            Replays, under its conditions.
        subject : Subject
            What is replayed.
        hand : Hand
            Where the arm is now.
        now : float
            Session time [s].
        feel : Feel
            How hard the hand is to pull aside.
        speed : float
            Share of the path's own speed, 0.25 .. 1.
        """
        self.subject: Final = subject
        self._arm = arm
        kept = evenly(len(subject.path.times), MOST_SAMPLES)
        times, places = subject.path.times[kept], subject.path.positions[kept]
        joints = arm.follow(places, hand.joints).joints
        self._approach = _way_to(arm, hand.joints, joints[0], now)
        self._route = Route(times, places, joints)
        start = float(self._approach.times[-1])
        self._replay = compliance.begin(arm, self._route, start, feel=feel, speed=speed)
        self._began = self._replay.tick
        self._parts: list[Replayed] = []
        self._track: Track | None = None
        self._plane: FloatArray | None = None
        self._ends: float | None = None
        self._events = 0
        self._so_far: tuple[int, Corrected | None] = -1, None
        self._held_at_end = False
        self.hand = replace(hand, recording=None, wanted=None, shortfall=None, returns_to=None)
        """Where the arm is."""

    # --- pulls -------------------------------------------------------------------------

    def follow(self, drag: Drag) -> None:
        """Take one event of a pull on the hand into account."""
        if drag.phase == "start":
            if self._track is None or self._ends is None or drag.time > self._ends:
                self._plane, self._track = drag.grabbed, gesture.begin(drag)
            else:
                self._track = gesture.follow(self._track, self._flattened(drag))
            self._ends = None
        elif self._track is not None:
            self._track = gesture.follow(self._track, self._flattened(drag))
            self._ends = drag.time + gesture.GRACE if drag.phase == "end" else None
        if self._track is not None:
            self._events += 1
            self._say(drag.time, self._track.displacement)
        self.advance(drag.time)

    def let_go(self, now: float) -> None:
        """Nobody holds the hand any more."""
        if self._track is not None:
            self._track = self._ends = None
            self._say(now, None)

    def _say(self, time: float, displacement: FloatArray | None) -> None:
        said = None if displacement is None else (*map(float, displacement),)
        pull = compliance.Pull(time, None if said is None else (said[0], said[1], said[2]))
        self._replay = replace(self._replay, pending=(*self._replay.pending, pull))

    def _flattened(self, drag: Drag) -> Drag:
        """Put the pointer into the plane in which the hand was grabbed.

        viser's plane goes along with the hand: a pointer that rests would seem to move as the hand comes
        nearer.
        """
        if drag.eye is None or drag.ahead is None or self._plane is None:
            return drag
        depth, wanted = (drag.pointer - drag.eye) @ drag.ahead, (self._plane - drag.eye) @ drag.ahead
        if depth <= 0.0 or wanted <= 0.0:
            return drag
        return replace(drag, pointer=drag.eye + wanted / depth * (drag.pointer - drag.eye))

    # --- time --------------------------------------------------------------------------

    @property
    def held(self) -> bool:
        """Whether somebody holds the hand."""
        return self._track is not None

    @property
    def done(self) -> bool:
        """Whether the path is at its end and nobody holds the hand."""
        replay = self._replay
        at_end = replay.along >= float(self._route.times[-1])
        late = replay.tick - self._began > LONGEST * servo.TICKS_PER_SECOND
        return replay.done or late or (at_end and self._held_at_end and replay.grip is None and not self.held)

    def advance(self, until: float) -> None:
        """Replay up to a session time [s]."""
        if self._ends is not None and until >= self._ends:
            self.let_go(until)
        if until <= self._approach.times[-1]:
            index = max(int(np.searchsorted(self._approach.times, until, side="right")) - 1, 0)
            self.hand = self._hand_at(self._approach.joints[index])
        self._step(until)

    def _step(self, until: float) -> None:
        self._replay, part = compliance.advance(self._replay, self._arm, (), until)
        if not len(part.times):
            return
        self._parts.append(part)
        self._held_at_end |= bool(np.any(part.pulled & (part.along >= self._route.times[-1])))
        self.hand = self._hand_at(part.joints[-1])

    def _hand_at(self, joints: FloatArray) -> Hand:
        return hand_at(self._arm, joints, gripper_at(self.subject.path, self._replay.along))

    # --- what came of it ---------------------------------------------------------------

    def progress(self) -> Progress:
        """Say how far it is."""
        path, along = self.subject.path, self._replay.along
        done = np.concatenate([part.positions for part in self._parts] or [np.zeros((0, 3))])
        return Progress(
            name=self.subject.name,
            path=path.positions,
            done=done,
            time=along - float(path.times[0]),
            duration=float(path.times[-1] - path.times[0]),
            held=self.held,
        )

    def so_far(self) -> Corrected | None:
        """Give what would be recorded if the hand were let go now; None before the first pull.

        It is the same object for `GUESSED` ticks, and while nobody holds the hand.
        """
        pulled = self._track is not None and bool(self._parts) and bool(self._parts[-1].pulled.any())
        known, made = self._so_far
        if not pulled or (made is not None and self._replay.tick < known + GUESSED):
            return made
        made = self._recorded(float(self._route.times[-1]))
        gone = (made.times - self._replay.along) / (EASING * self._replay.speed)
        fade = np.where(gone > 0.0, np.clip(1.0 - gone, 0.0, 1.0) ** 2, 0.0)
        made = replace(made, positions=made.positions + fade[:, None] * self._replay.aside)
        self._so_far = self._replay.tick, made
        return made

    def finish(self, now: float) -> Corrected | None:
        """End it, wherever it is; the hand stays there.

        Returns
        -------
        Corrected or None
            What the hand did, then how it would have eased back, then the rest of the path as it was. None
            when the hand was not moved.
        """
        stays = self.hand
        self.let_go(now)
        end = float(self._route.times[-1])
        latest = self._replay.time + SETTLING
        while self._replay.along < end and self._replay.time < latest and self._away():
            self._step(self._replay.time + 0.1)
        self.hand = stays
        if not any(part.pulled.any() for part in self._parts):
            return None
        corrected = self._recorded(end)
        return corrected if corrected.farthest > SLIP else None

    def _away(self) -> bool:
        pending = bool(self._replay.pending) or self._replay.grip is not None
        return pending or float(np.linalg.norm(self._replay.aside)) > BACK

    def _recorded(self, end: float) -> Corrected:
        path, speed = self.subject.path, self._replay.speed
        positions = np.concatenate([part.positions for part in self._parts])
        along = np.concatenate([part.along for part in self._parts])
        held = np.concatenate([part.pulled for part in self._parts])
        route = np.concatenate([part.route for part in self._parts])
        if self._held_at_end:  # what it did after the release, at the end, is no part of the motion
            count = int(np.flatnonzero(held)[-1]) + 1
            positions, along, held, route = positions[:count], along[:count], held[:count], route[:count]
        first = int(np.argmax(held))
        route[:first] = positions[:first]
        ticks = np.arange(1, len(positions) + 1) / servo.TICKS_PER_SECOND
        times = float(path.times[0]) + speed * ticks
        rest = (path.times > times[-1] + 1e-3) & (along[-1] < end)
        return Corrected(
            times=np.concatenate([path.times[:1], times, path.times[rest]]),
            positions=np.concatenate([self._approach.positions[-1:], positions, path.positions[rest]]),
            route=np.concatenate([self._approach.positions[-1:], route, path.positions[rest]]),
            held=np.concatenate([[False], held, np.zeros(np.count_nonzero(rest), dtype=np.bool_)]),
            events=self._events,
        )


def gripper_at(path: Demonstration | Reproduction, time: float) -> float:
    """Read the gripper of a path at a time of its own clock [s]; open where nothing is known."""
    if path.gripper is None:
        return 0.0
    index = int(np.searchsorted(path.times, time, side="right")) - 1
    return float(path.gripper[max(index, 0)])


def _way_to(arm: Arm, start: FloatArray, goal: FloatArray, now: float) -> Motion:
    """Go to where a path begins, clear of what is around where there is such a way."""
    way = arm.way(start, goal)
    way = np.stack([start, goal]) if way is None else way
    return servo.swing(arm, way, time=now, at_least=APPROACH / (len(way) - 1))
