"""Runs of other methods in the scene: beside the tube's, each in its colour, and never to be grabbed."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from app.arm import PlanarArm
from app.compared import LOOKS, Compared
from app.comparing import asked_for, steps
from app.document import View
from app.store import State
from tests.scene.conftest import Stage, state
from tests.scene.test_scene import shown

VIEW = View(methods=("ramp",))


@cache
def known() -> Compared:
    return list(steps(asked_for(state().model, VIEW), 3, PlanarArm))[-1]


def compared(**changes: object) -> State:
    return replace(state(), view=VIEW, compared=replace(known(), **changes))


def test_all_methods_begin_at_the_same_starts_in_their_own_colours_and_cannot_be_pulled(stage: Stage) -> None:
    stage.draw(compared())
    found = known().found
    assert found is not None

    for name in ("gc", "ramp"):
        for k, start in enumerate(found.starts):
            node = stage.client.node(f"/compared/{name}/{k}")
            np.testing.assert_allclose(node.array("points", -1, 2, 3)[0, 0], start, atol=1e-4)
            assert tuple(node.array("colors").reshape(-1, 3)[0]) == LOOKS[name].color
            assert [*node.drags, *node.clicks] == []
    assert not any(each.startswith("/compared/dmp") for each in stage.client.nodes)


def test_runs_go_when_their_tick_is_taken_away_or_the_skill_changes_and_come_back(stage: Stage) -> None:
    seen = []
    for one in (
        compared(),
        replace(compared(), view=replace(VIEW, show_compared=False)),
        compared(),
        compared(outdated=True),
        replace(compared(), view=replace(VIEW, methods=())),
    ):
        stage.draw(one)
        seen.append([shown(stage, f"/compared/{name}/0") for name in ("gc", "ramp")])

    assert seen == [[True, True], [False, False], [True, True], [False, False], [True, False]]


def test_what_is_compared_already_costs_nothing_to_draw(stage: Stage) -> None:
    stage.draw(compared())
    stage.client.log.clear()
    stage.draw(compared())

    assert not stage.sent()


def test_the_skill_s_own_lines_are_thinner_than_those_that_are_compared(stage: Stage) -> None:
    widths = []
    for one in (compared(), compared(outdated=True)):
        stage.draw(one)
        own = ("/reproductions/0/line", "/directrix", "/compared/gc/0")
        widths.append([stage.client.node(name).props["thickness"] for name in own])

    (run, middle, line), after = widths
    assert max(run, middle) < 0.5 * line
    assert min(after[:2]) > max(run, middle)
