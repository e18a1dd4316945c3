"""A person who does anything in any order: nothing raises, nothing is lost, everything can be undone."""

from __future__ import annotations

import numpy as np
import pytest

from app import edits
from app.desk import Desk
from app.store import DEEPEST
from tests.app.makers import Mouse, desk_of

KINDS = ("/hand", "/landmarks/start", "/landmarks/goal", "/start/0", "/demonstrations/0", "/reproductions/0")
A_FEW = 60
MANY = 1000


def do_anything(desk: Desk, mouse: Mouse, rng: np.random.Generator) -> None:
    """One gesture, edit, undo or redo; pulls go up to half a metre, so some leave the arm's reach."""
    action = int(rng.integers(10))
    if action < 6:
        by = 0.5 * rng.uniform(-1.0, 1.0, 3)
        mouse.pull(KINDS[action], by, vertical=bool(rng.integers(2)), aside=bool(rng.integers(2)), events=5)
    elif action == 6:
        desk.undo(mouse.now)
    elif action == 7:
        desk.redo(mouse.now)
    elif action == 8 and len(desk.store.document.demonstrations) > 3:
        desk.edit(lambda d: edits.delete_demonstration(d, len(d.demonstrations) - 1), "delete", now=mouse.now)
    elif desk.store.document.rules:
        desk.edit(lambda d: edits.delete_rule(d, 0), "delete rule", now=mouse.now)
    mouse.wait(0.4)


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
