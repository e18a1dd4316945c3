"""Documents, and a hand on the mouse: what the tests of the app are made of."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.actions import Drag
from app.arm import PlanarArm
from app.desk import Desk
from app.document import Box, Cylinder, Document, FloatArray, Place, Rule, Settings, Shape, Shown, View
from app.measures import handles
from app.model import Model
from app.planning import plan_run
from app.store import Plan
from gc_core import Constraint, Demonstration

EVENT = 0.05
"""A browser sends an event each 50 ms [s]."""
TICK = 0.04
"""Of a session [s]."""
FIRST_START = np.array([0.45, 0.30, 0.45])


def demonstration(number: int = 0, n_samples: int = 60, name: str = "") -> Demonstration:
    """A reach downwards, beside the others of the same skill; within the planar arm's reach."""
    share = np.linspace(0.0, 1.0, n_samples)[:, None]
    turn = 0.3 + 2.1 * number
    spread = 0.06 * np.array([np.cos(turn), np.sin(turn), 0.4 * np.cos(2.0 * turn)])
    middle = np.array([0.45, 0.30, 0.45]) + share * np.array([0.1, -0.6, -0.3])
    bow = 0.08 * np.sin(np.pi * share) * np.array([0.3, 0.0, 1.0])
    path = middle + bow + (1.0 - 0.8 * share) * spread
    return Demonstration(
        3.0 * share[:, 0], path, gripper=np.round(share[:, 0]), name=name or f"Reach {number + 1}"
    )


def taught(count: int = 3, *, built_in: bool = False, stations: int = 60) -> Document:
    """A skill of some demonstrations and one start."""
    return Document(
        "Reaching",
        demonstrations=tuple(Shown(demonstration(i)) for i in range(count)),
        settings=Settings(stations=stations),
        starts=(FIRST_START,),
        built_in=built_in,
    )


def rule(name: str = "Lid") -> Rule:
    """A run pushed down by a hand's breadth in its middle."""
    before = demonstration().positions
    bell = np.exp(-(np.linspace(-3.0, 3.0, len(before)) ** 2))[:, None]
    return Rule(Constraint.from_correction(before, before - 0.08 * bell * np.array([0.0, 0.0, 1.0])), name)


def furnished() -> Document:
    """A skill with one of everything, so that every edit finds something to change."""
    document = taught()
    goal = Place("goal", now=np.array([0.60, -0.25, 0.20]))
    cup = Place("cup", taught=np.array([0.50, 0.05, 0.30]), kind="object", turn=np.array([0.0, 0.1, 0.3]))
    return Document(
        document.title,
        demonstrations=document.demonstrations,
        settings=document.settings,
        landmarks=(Place("start"), goal, cup),
        starts=document.starts,
        rules=(rule(),),
        things=(
            Box("crate", (0.3, -0.2, 0.1), (0.1, 0.2, 0.2)),
            Cylinder("can", (0.4, 0.4, 0.3), 0.03, 0.1, mass=0.2),
        ),
    )


class Mouse:
    """A person at a desk: pulls, waits, and lets go, on a clock that the test owns."""

    def __init__(self, desk: Desk, now: float = 10.0) -> None:
        self.desk, self.now = desk, now

    def press(
        self, node: str, at: FloatArray | None = None, *, vertical: bool = False, aside: bool = False
    ) -> None:
        """Grab a node where it is, or at a place."""
        self._node, self._vertical, self._aside = node, vertical, aside
        self._at = self.place(node) if at is None else np.asarray(at, dtype=np.float64)
        self._say("start")

    def move(self, by: Sequence[float] | FloatArray) -> None:
        """Move the pointer on by some way [m]; one event later."""
        self.now += EVENT
        self._at = self._at + by
        self._say("update")
        self.desk.state()

    def release(self) -> None:
        """Let go where the pointer is; one event later."""
        self.now += EVENT
        self._say("end")

    def wait(self, seconds: float) -> None:
        """Let time pass; the session ticks."""
        until = self.now + seconds
        while self.now < until - 1e-9:
            self.now += TICK
            self.desk.tick(self.now, TICK)

    def pull(
        self,
        node: str,
        by: Sequence[float],
        *,
        at: FloatArray | None = None,
        vertical: bool = False,
        aside: bool = False,
        events: int = 12,
        kept: bool = True,
    ) -> None:
        """Grab, pull by some way in even steps, let go, and wait until that is taken for the end.

        When a correction then waits, its first choice is taken, if it is to be kept.
        """
        self.press(node, at, vertical=vertical, aside=aside)
        for _ in range(events):
            self.move(np.asarray(by, dtype=np.float64) / events)
        self.release()
        self.wait(0.2)
        if kept and self.desk.amending.waits:
            self.desk.amend(lambda amending: amending.answer(0, self.now))

    def place(self, node: str) -> FloatArray:
        """Where a node of the scene is: the middle of a line, the origin of anything else."""
        return place_of(node, self.desk.state().model, self.desk.state().hand.position)

    def _say(self, phase: str) -> None:
        grabbed = self._at
        self.desk.drag(
            Drag(self._node, phase, grabbed, self._at, self.now, vertical=self._vertical, aside=self._aside)
        )


def place_of(node: str, model: Model, hand: FloatArray) -> FloatArray:
    """Where one would grab a node of the scene (3,) [m]."""
    kind, _, which = node.strip("/").partition("/")
    if kind == "hand":
        return hand
    if kind == "start":
        return model.runs[int(which)].start
    if kind == "landmarks":
        return next(anchor.now for anchor in model.anchors if anchor.name == which)
    if kind == "obstacles":
        return np.array(thing_of(model, which).position)
    if kind == "sizes":
        name, _, number = which.rpartition("/")
        return handles(thing_of(model, name))[int(number)].place
    if kind == "demonstrations":
        path = model.source.demonstrations[int(which)].demonstration.positions
    else:
        path = model.runs[int(which)].reproduction.positions
    return path[len(path) // 2]


def thing_of(model: Model, name: str) -> Shape:
    """The thing of a name."""
    return next(thing for thing in model.source.things if thing.name == name)


def desk_of(document: Document | None = None) -> Desk:
    """A desk with the tiny arm."""
    return Desk(taught() if document is None else document, PlanarArm())


def planned(desk: Desk, run: int = 0) -> Plan:
    """What the desk's worker would make of a run now."""
    arm = desk.stage.arm
    return plan_run(arm, desk.model, run, arm.conditions, arm.home)


WIDTH = View().pull_width
