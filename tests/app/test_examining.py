"""How the arm holds itself along what was shown is found out aside, once, and said."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from app import advising
from app.actor import Actor
from app.arm import PlanarArm
from app.document import Document, Shown
from app.examining import Examining, joints_along
from app.model import learn
from app.quality import Postures
from gc_core import Demonstration
from tests.app.makers import taught
from tests.panels.desk import state_of

SOON = 10.0


class Stiff(PlanarArm):
    """The tiny arm with an elbow that cannot be straightened any farther than it reaches."""

    def __init__(self) -> None:
        super().__init__()
        self.upper = np.array([*self.upper[:2], -0.39])


def stretched() -> Demonstration:
    """A reach at the end of which the arm is as straight as it can be."""
    part = np.linspace(0.0, 1.0, 240)[:, None]
    return Demonstration(4.0 * part[:, 0], [0.6, 0.0, 0.3] + part * [0.3799, 0.0, 0.0], name="Far one")


def examined(document: Document) -> Postures:
    """As a session has it examined: drawn after every answer, until nothing is asked any more."""
    state, done = state_of(document), threading.Event()
    errors: list[Exception] = []

    def draw() -> None:
        examining.follow(state)
        found = examining.postures
        if found is not None and len(found.joints) == len(state.model.demonstrations):
            done.set()

    actor = Actor(tick=lambda: False, draw=draw, report=errors.append, name="examining")
    with ThreadPoolExecutor(1) as workers:
        examining = Examining(workers, actor, Stiff)
        actor.post(lambda: None)
        assert done.wait(SOON), errors
    actor.close()
    assert examining.postures is not None
    return examining.postures


def test_the_joints_lead_the_hand_along_the_demonstration() -> None:
    shown = stretched()
    joints = joints_along(PlanarArm(), shown)
    tool = np.stack([PlanarArm().tool_pose(one)[:3, 3] for one in joints])

    assert len(joints) == len(shown.times)
    assert np.linalg.norm(tool - shown.positions, axis=1).max() < 0.005


def test_a_demonstration_at_a_joints_limit_is_noted_once_it_was_examined() -> None:
    document = replace(taught(), demonstrations=(Shown(stretched()),))
    model = learn(document)
    before = advising.advice(model).notes
    (noted,) = advising.advice(model, examined(document)).notes

    assert before == ()
    assert (noted.note.fault, noted.note.fix) == ("joint_limit", "redo")
    assert "Far one brings joint 3" in noted.note.sentence
    assert noted.note.at > 3.5


def test_what_stays_clear_of_the_limits_is_not_noted() -> None:
    document = taught()
    found = advising.advice(learn(document), examined(document))

    assert [one.note.fault for one in found.notes if one.note.fault == "joint_limit"] == []
