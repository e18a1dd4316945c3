"""The methods to compare with: each keeps the law it is known for, and says when it cannot."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest

from app.baselines import (
    CannotLearnError,
    MissingPackageError,
    Mixture,
    Primitive,
    Ramp,
    Tube,
    UnknownMethodError,
    methods,
    mixture_directrix,
    taught,
)
from app.baselines.protocol import failing_as
from gc_core import encode, reproduce
from tests.baselines.makers import GOAL, demonstrations, needs_gmr, needs_primitives

START = np.array([0.03, 0.02, 0.01])
ELSEWHERE = GOAL + np.array([0.05, -0.1, 0.08])
KINDS = [
    "gc",
    "ramp",
    pytest.param("gmr-5", marks=needs_gmr),
    pytest.param("dmp-10", marks=needs_primitives),
    pytest.param("promp-5", marks=needs_primitives),
]


def run_of(name: str, start: np.ndarray = START, goal: np.ndarray | None = None) -> np.ndarray:
    (method,) = methods([name])
    return method.fit(demonstrations()).reproduce(start, goal).positions


@pytest.mark.parametrize("name", KINDS)
def test_a_run_is_as_long_as_the_demonstrations_and_its_time_moves_on(name: str) -> None:
    (method,) = methods([name])
    run = method.fit(demonstrations()).reproduce(START)

    assert method.name == name
    assert run.positions.shape == (len(run.times), 3)
    assert (np.diff(run.times) > 0.0).all()
    assert run.times[-1] == pytest.approx(4.0, rel=0.1)


@pytest.mark.parametrize("name", [kind for kind in KINDS if getattr(kind, "values", kind) != ("gmr-5",)])
def test_a_run_begins_where_it_is_asked_to(name: str) -> None:
    np.testing.assert_allclose(run_of(name)[0], START, atol=1e-4)


@pytest.mark.parametrize("name", [kind for kind in KINDS if getattr(kind, "values", kind) != ("promp-5",)])
def test_what_is_learned_somewhere_else_is_done_there_in_the_same_way(name: str) -> None:
    shift = np.array([0.2, -0.3, 0.1])
    (method,) = methods([name])
    moved = [replace(each, positions=each.positions + shift) for each in demonstrations()]

    there = method.fit(moved).reproduce(START + shift).positions

    np.testing.assert_allclose(there - shift, run_of(name), atol=1e-3)


@pytest.mark.parametrize("goal", [None, ELSEWHERE])
def test_the_ramp_meets_both_ends(goal: np.ndarray | None) -> None:
    skill = Ramp().fit(demonstrations())
    end = skill.taught.mean[-1] if goal is None else goal

    np.testing.assert_allclose(skill.reproduce(START, goal).positions[[0, -1]], [START, end], atol=1e-12)


@needs_primitives
@pytest.mark.parametrize("goal", [GOAL, ELSEWHERE, START])
def test_a_dynamical_primitive_ends_at_the_goal_wherever_that_is_even_at_the_start(goal: np.ndarray) -> None:
    assert np.linalg.norm(run_of("dmp-20", goal=goal)[-1] - goal) < 0.005


@needs_primitives
def test_more_weights_follow_the_mean_more_closely() -> None:
    mean = taught(demonstrations(), "arc_length").mean
    runs = [Primitive(weights).fit(demonstrations()).reproduce(mean[0]) for weights in (5, 10, 40)]
    away = [np.linalg.norm(run.positions - mean, axis=1).max() for run in runs]

    assert away[0] > away[1] > away[2]


@needs_gmr
def test_regression_over_time_depends_neither_on_start_nor_on_goal() -> None:
    np.testing.assert_array_equal(run_of("gmr-5"), run_of("gmr-5", start=START + 0.05, goal=ELSEWHERE))


@needs_gmr
def test_regression_stays_near_the_mean() -> None:
    shown = taught(demonstrations(), "arc_length")

    assert np.linalg.norm(run_of("gmr-10") - shown.mean, axis=1).max() < 0.02


@needs_gmr
def test_demonstrations_in_one_plane_have_a_regression_in_this_plane() -> None:
    flat = [replace(each, positions=each.positions * [1.0, 1.0, 0.0]) for each in demonstrations()]

    assert np.abs(Mixture(10).fit(flat).positions[:, 2]).max() < 1e-3


@needs_primitives
def test_a_probabilistic_primitive_ends_where_it_is_conditioned_to() -> None:
    goal = GOAL + np.array([0.01, 0.01, 0.0])

    np.testing.assert_allclose(run_of("promp-5", goal=goal)[-1], goal, atol=1e-3)


def test_the_cylinder_runs_as_the_ratio_rule_says() -> None:
    skill = Tube(section="ellipse").fit(demonstrations())

    expected = reproduce(encode(demonstrations(), section="ellipse", align_by="arc_length"), START)
    np.testing.assert_array_equal(skill.reproduce(START).positions, expected.positions)


def test_the_cylinder_is_bent_to_another_goal() -> None:
    skill = Tube().fit(demonstrations())
    shift = ELSEWHERE - skill.cylinder.directrix[-1]
    end = skill.reproduce(skill.cylinder.directrix[0], ELSEWHERE).positions[-1]

    assert np.linalg.norm(shift) > 0.1
    np.testing.assert_allclose(end, ELSEWHERE, atol=1e-3)


@needs_gmr
@pytest.mark.parametrize("align_by", ["time", "arc_length", "dtw"])
def test_a_tube_around_the_regression_holds_what_was_shown(align_by: str) -> None:
    curve = mixture_directrix(demonstrations(), 8, align_by)  # type: ignore[arg-type]  # all three are ways
    tube = encode(demonstrations(), directrix=curve, align_by=align_by)
    mean = encode(demonstrations(), align_by=align_by)

    assert tube.contains(tube.effective_points.reshape(-1, 3)).all()
    away = np.linalg.norm(tube.directrix - mean.directrix, axis=1).max()
    assert 1e-6 < away < 0.02


@needs_gmr
def test_a_mixture_of_more_gaussians_than_the_samples_allow_is_refused() -> None:
    with pytest.raises(CannotLearnError, match=r"gmr-60 cannot learn .* 1 to 40 Gaussians"):
        Mixture(60).fit(demonstrations(1))


def test_what_a_library_raises_on_singular_data_becomes_a_sentence() -> None:
    failure = pytest.raises(
        CannotLearnError, match="gmr-5 cannot learn these demonstrations: Singular matrix"
    )
    with failure, failing_as(CannotLearnError, "gmr-5"):
        np.linalg.inv(np.zeros((2, 2)))


@pytest.mark.parametrize(("package", "name"), [("gmr", "gmr-5"), ("movement_primitives", "dmp-5")])
def test_a_missing_package_is_named_with_how_to_install_it(
    package: str, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in (package, "movement_primitives.dmp"):
        monkeypatch.setitem(sys.modules, module, None)

    with pytest.raises(MissingPackageError, match=rf"{name} needs the package {package}.*pip install"):
        methods([name])[0].fit(demonstrations())


@pytest.mark.parametrize("name", ["", "dmp", "dmp-1", "dmp-x", "gmr--5", "lstm-5", "dmp-5000"])
def test_a_name_that_stands_for_no_method_is_told_which_there_are(name: str) -> None:
    with pytest.raises(UnknownMethodError, match="Choose gc, ramp"):
        methods([name])
