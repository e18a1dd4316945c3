"""A person who does anything in any order: nothing raises, nothing is lost, everything can be undone."""

from __future__ import annotations

import numpy as np
import pytest

from app import edits, placing
from app.desk import Desk
from app.history import DEEPEST
from tests.app.makers import Mouse, desk_of

KINDS = ("/hand", "/landmarks/start", "/landmarks/goal", "/start/0", "/demonstrations/0", "/reproductions/0")
A_FEW = 60
MOST = 5
"""Landmarks."""
MANY = 1000


def do_anything(desk: Desk, mouse: Mouse, rng: np.random.Generator) -> None:
    """One gesture, edit, undo or redo; pulls go up to half a metre, so some leave the arm's reach."""
    action = int(rng.integers(13))
    if action < 6 and has(desk, KINDS[action]):
        by = 0.5 * rng.uniform(-1.0, 1.0, 3)
        mouse.pull(KINDS[action], by, vertical=bool(rng.integers(2)), aside=bool(rng.integers(2)), events=5)
    elif action >= 10:
        change_landmarks(desk, mouse, rng)
    elif action == 6:
        desk.undo(mouse.now)
    elif action == 7:
        desk.redo(mouse.now)
    elif action == 8 and len(desk.store.document.demonstrations) > 3:
        desk.edit(lambda d: edits.delete_demonstration(d, len(d.demonstrations) - 1), "delete", now=mouse.now)
    elif desk.store.document.rules:
        desk.edit(lambda d: edits.delete_rule(d, 0), "delete rule", now=mouse.now)
    mouse.wait(0.4)


def has(desk: Desk, node: str) -> bool:
    """Whether there is such a landmark still; of other things there is always one."""
    kind, _, name = node.strip("/").partition("/")
    return kind != "landmarks" or any(place.name == name for place in desk.store.document.landmarks)


def change_landmarks(desk: Desk, mouse: Mouse, rng: np.random.Generator) -> None:
    """Add one where something is, turn one, rename one, remove one, smooth, or put all back."""
    document, model = desk.store.document, desk.state().model
    names, action = [place.name for place in document.landmarks], int(rng.integers(7))
    objects = [place.name for place in document.landmarks if place.kind == "object"]
    if action <= 1 and len(names) < MOST:
        kind = ("via", "obstacle", "object")[int(rng.integers(3))]
        place = placing.placed(
            model, model.cylinder.directrix[int(rng.integers(60))] + 0.1 * rng.normal(size=3)
        )
        desk.edit(lambda d: edits.add_landmark(d, kind, place), "add", now=mouse.now)
    elif action == 2 and objects:
        desk.edit(lambda d: edits.turn_landmark(d, objects[0], rng.normal(size=3)), "turn", now=mouse.now)
    elif action == 3 and objects:
        mouse.pull(f"/turns/{objects[0]}", 0.2 * rng.normal(size=3), at=rng.normal(size=3), events=3)
    elif action == 4 and len(names) > 1:
        desk.edit(lambda d: edits.remove_landmark(d, names[-1]), "remove", now=mouse.now)
    elif action == 5:
        desk.edit(lambda d: edits.set_smoothing(d, float(rng.uniform())), "smooth", now=mouse.now)
    elif action == 6:
        desk.edit(edits.put_landmarks_back, "put back", now=mouse.now)


@pytest.mark.parametrize("seed", range(3))
def test_whatever_is_done_can_be_undone(seed: int) -> None:
    check_whatever_is_done(seed, A_FEW)


@pytest.mark.soak
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("seed", range(10, 14))
def test_whatever_is_done_for_hours_can_be_undone(seed: int) -> None:
    check_whatever_is_done(seed, MANY)


def check_whatever_is_done(seed: int, count: int) -> None:
    desk, rng = desk_of(), np.random.default_rng(seed)
    mouse = Mouse(desk)
    first = desk.store.document
    for _ in range(count):
        do_anything(desk, mouse, rng)
        state = desk.state()
        assert np.isfinite(state.hand.position).all()
        assert state.model.problem is None
        assert all(np.isfinite(run.reproduction.positions).all() for run in state.model.runs)

    taken_back = 0
    while desk.store.undo_name is not None:
        desk.undo(mouse.now)
        taken_back += 1
    assert desk.store.document is first or taken_back == DEEPEST
