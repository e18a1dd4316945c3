"""Which rules bite, what is said of them, and what is drawn of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app import biting, edits
from app.arm import PlanarArm
from app.desk import Desk
from app.document import Document
from app.model import Model, Run, learn
from app.panels.rules import overview
from app.scene.rules import MOST_ARROWS, MOST_PLANES, arrows, quads, thinned
from gc_core import Constraint, constrain, reproduce
from tests.app.makers import FIRST_START, taught
from tests.panels.desk import state_of

DOWN = np.array([0.0, 0.0, -1.0])


def two_runs() -> Document:
    """One run above the other."""
    return replace(taught(), starts=(FIRST_START + 0.03 * DOWN, FIRST_START - 0.03 * DOWN))


def ruled(document: Document, by: float, run: int = 1, name: str = "Lid") -> Document:
    """A run pressed down, or up where negative, in its middle."""
    path = learn(document).runs[run].free.positions
    bell = np.sin(np.linspace(0.0, np.pi, len(path)))[:, None] ** 2
    return edits.add_rule(document, Constraint.from_correction(path, path + by * bell * DOWN), name)


def only(document: Document) -> tuple[biting.Bite, Model]:
    model = learn(document)
    return biting.bites(model)[0], model


def test_a_rule_bites_the_run_that_would_pass_it_where_it_is_held() -> None:
    bite, model = only(ruled(two_runs(), 0.02))
    held = np.concatenate([run.reproduction.positions for run in model.runs])
    gaps = np.linalg.norm(bite.places[:, None] - held[None], axis=2).min(axis=1)

    assert 1 in bite.runs
    assert bite.depth == pytest.approx(0.02, rel=1e-2)
    assert gaps.max() == 0.0
    np.testing.assert_allclose(bite.normals, np.broadcast_to(DOWN, bite.normals.shape), atol=1e-9)


def test_a_rule_for_the_way_before_a_run_joins_does_not_bite_while_it_waits() -> None:
    document = ruled(two_runs(), -0.02)
    model = learn(document)
    cylinder, constraints = model.cylinder, model.constraints
    both = reproduce(cylinder, np.array([FIRST_START, cylinder.directrix[40] - 0.03 * DOWN]))
    late = replace(both, positions=both.positions[1], ratios=both.ratios[1], start_inside=True)
    run = Run(late.positions[0], late, constrain(late, constraints), constraints)
    (bite,) = biting.bites(replace(model, runs=(run,)))
    moved = np.linalg.norm(run.reproduction.positions - late.positions, axis=1)

    assert (late.positions[:30] == late.positions[0]).all()
    assert bite.depth <= moved.max() + 1e-9
    assert len(bite.places) <= (moved > 0.0).sum()


def test_a_rule_that_touches_no_run_says_so() -> None:
    lifted = ruled(two_runs(), -0.004, run=0)
    above = replace(lifted, starts=(lifted.starts[1], lifted.starts[1]))
    bite, model = only(above)

    assert bite.runs == ()
    assert biting.words(bite, model) == "It touches none of the 2 runs: nothing would pass its planes."


def test_a_rule_that_is_off_bites_nothing_and_says_so() -> None:
    bite, model = only(edits.enable_rule(ruled(two_runs(), 0.02), 0, False))

    assert bite.runs == ()
    assert biting.words(bite, model).startswith("It is off")


def test_rules_that_contradict_each_other_are_named() -> None:
    document = ruled(ruled(two_runs(), 0.06, name="Lid"), -0.06, name="Floor")

    assert "Lid and Floor contradict each other" in overview(state_of(document))


def test_a_rule_that_contradicts_another_says_so_when_it_is_made_and_when_it_is_switched_on() -> None:
    lid = ruled(two_runs(), 0.06, name="Lid")
    desk = Desk(lid, PlanarArm())
    said = []
    for change in (
        lambda document: ruled(document, -0.06, name="Floor"),
        lambda document: edits.enable_rule(document, 0, False),
        lambda document: edits.enable_rule(document, 0, True),
    ):
        desk.edit(change, "change rules", now=10.0)
        said.append(desk.state().message)

    assert [one.startswith("Lid and Floor contradict each other") for one in said] == [True, False, True]
    assert desk.state().warning


def test_few_planes_are_drawn_flat_and_across_their_normals() -> None:
    bite, _ = only(ruled(two_runs(), 0.02))
    centres, normals = thinned((bite,))
    vertices, faces = quads(centres, normals)
    corners = vertices.reshape(-1, 4, 3)

    assert len(centres) == MOST_PLANES
    assert len(faces) == 2 * MOST_PLANES
    np.testing.assert_allclose(corners.mean(axis=1), centres, atol=1e-6)
    along = np.einsum("pci,pi->pc", corners - centres[:, None], normals)
    np.testing.assert_allclose(along, 0.0, atol=1e-6)


def test_arrows_lead_from_the_run_to_where_it_was_corrected() -> None:
    document = ruled(two_runs(), 0.05)
    rule = biting.shown(learn(document), -1)
    assert rule is not None
    drawn = arrows(rule)
    shafts = drawn[: len(drawn) // 3]
    run = learn(two_runs()).runs[1].free.positions

    assert len(shafts) == MOST_ARROWS
    assert np.linalg.norm(shafts[:, 0, None] - run[None], axis=2).min(axis=1).max() < 1e-9
    assert (shafts[:, 1] - shafts[:, 0])[:, 2].min() < -0.04


def test_no_arrows_are_shown_of_a_rule_that_is_not_there() -> None:
    model = learn(ruled(two_runs(), 0.05))

    assert [biting.shown(model, which) is None for which in (None, -2, 1, 0)] == [True, True, True, False]
