"""Methods side by side: the same starts for all, Fig. 9's claims, failures, and the command."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from app.__main__ import main
from app.baselines import DEFAULT, Run, methods, taught
from app.comparison import Comparison, Row, Task, claims, compare, half_way, spread, starts_in
from app.document import Sphere
from app.files import write
from gc_core import Demonstration, InvalidSettingError, encode, metrics
from tests.baselines.makers import demonstrations, needs_gmr, needs_primitives

PROMISED = {
    "method",
    "spread_mid_m",
    "end_error_m",
    "frechet_m",
    "dtw_m",
    "jerk",
    "fit_ms",
    "reproduce_ms",
    "failed",
}


@pytest.fixture(scope="module")
def found() -> Comparison:
    return compare(Task(tuple(demonstrations())), methods(["gc", "ramp", "dmp-5", "gmr-5"]))


def row_of(comparison: Comparison, method: str) -> Row:
    return next(row for row in comparison.rows if row.method == method)


@pytest.mark.parametrize("count", [1, 5, 40])
def test_starts_are_distinct_places_of_the_first_slice_and_always_the_same(count: int) -> None:
    cylinder = encode(demonstrations())
    starts = starts_in(cylinder, count)

    np.testing.assert_array_equal(starts, starts_in(cylinder, count))
    np.testing.assert_allclose((starts - cylinder.directrix[0]) @ cylinder.frames[0, :, 0], 0.0, atol=1e-12)
    assert cylinder.contains(starts).all()
    assert len(np.unique(starts.round(4), axis=0)) == count


def test_starts_of_ones_own_are_taken_as_they_are() -> None:
    starts = np.array([[0.02, 0.01, 0.0], [-0.02, 0.0, 0.03]])
    found = compare(Task(tuple(demonstrations()), starts=starts), methods(["ramp"]))

    np.testing.assert_allclose([run.positions[0] for run in found.runs["ramp"]], starts, atol=1e-12)


@needs_gmr
@needs_primitives
def test_a_loop_that_ends_where_it_begins_and_equal_demonstrations_stop_nothing() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 120)
    loop = 0.2 * np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=1)
    rows = compare(Task((Demonstration(turn, loop),) * 3), methods(), 2).rows

    assert [row.method for row in rows] == list(DEFAULT)
    assert all(row.failed or row.end_error_m is not None for row in rows)


@needs_gmr
def test_a_covariance_that_is_singular_is_reported_in_its_row() -> None:
    place = 0.005 * np.array([[0.0, 0.0, 0.0], [0.5, 0.9, 0.001], [1.0, 1.8, 0.006]])
    barely = tuple(Demonstration(0.03 * np.arange(3.0), place + aside) for aside in (0.0, 0.01))
    row = row_of(compare(Task(barely), methods(["gmr-10", "gc"]), 2), "gmr-10")

    assert "singular" in (row.failed or "")


def test_the_leash_is_that_of_the_nearest_demonstration(found: Comparison) -> None:
    shown = taught(demonstrations(), "arc_length").paths
    leashes = [min(metrics.frechet(run.positions, each) for each in shown) for run in found.runs["ramp"]]

    assert row_of(found, "ramp").frechet_m == pytest.approx(np.mean(leashes), abs=1e-12)


@pytest.mark.parametrize("count", [0, -1, 10_000])
def test_no_start_or_too_many_are_refused(count: int) -> None:
    with pytest.raises(InvalidSettingError, match="number of starts"):
        starts_in(encode(demonstrations()), count)


def test_the_tube_keeps_the_paths_apart_in_proportion_to_its_width(found: Comparison) -> None:
    row, widths = row_of(found, "gc"), found.cylinder.radii.mean(axis=1)
    assert row.spread_mid_m is not None

    assert row.spread_mid_m == pytest.approx(spread(found.starts) * widths[100] / widths[0], rel=0.2)


@needs_gmr
@needs_primitives
def test_primitives_and_mixtures_merge_the_paths(found: Comparison) -> None:
    left = [row_of(found, name).spread_mid_m for name in ("dmp-5", "gmr-5")]

    assert max(each for each in left if each is not None) < 0.1 * spread(found.starts)
    assert all(claim.holds for claim in claims(found))


def test_the_same_metrics_count_for_all(found: Comparison) -> None:
    row, runs = row_of(found, "ramp"), found.runs["ramp"]

    assert row.end_error_m == pytest.approx(0.0, abs=1e-9)
    assert row.jerk == pytest.approx(np.mean([metrics.jerk(run.positions, run.times) for run in runs]))


def test_claims_that_do_not_hold_are_said_not_to() -> None:
    cylinder = encode(demonstrations())
    rows = (
        Row("gc", spread_mid_m=0.001, spread_start_m=0.05),
        Row("gmr-5", spread_mid_m=0.05, spread_start_m=0.05),
        Row("dmp-5", failed="it cannot"),
    )

    told = claims(Comparison(starts_in(cylinder, 5), cylinder, rows))

    assert [(claim.method, claim.holds) for claim in told] == [("gc", False), ("gmr-5", False)]
    assert all("does not" in claim.sentence for claim in told)


def test_half_way_is_where_a_run_crosses_the_middle_slice() -> None:
    cylinder = encode(demonstrations())
    middle = cylinder.directrix[100] + 0.01 * cylinder.frames[100, :, 1]
    along = cylinder.frames[100, :, 0]
    path = middle + np.outer([-0.03, -0.01, 0.02], along)

    np.testing.assert_allclose(half_way(Run(np.arange(3.0), path), cylinder), middle, atol=1e-12)


def test_a_run_that_never_gets_half_way_counts_where_it_came_nearest() -> None:
    cylinder = encode(demonstrations())
    path = cylinder.directrix[100] - np.outer([0.05, 0.02, 0.04], cylinder.frames[100, :, 0])

    np.testing.assert_array_equal(half_way(Run(np.arange(3.0), path), cylinder), path[1])


def test_a_method_that_fails_says_why_and_the_others_go_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gmr", None)
    failed, done = compare(Task(tuple(demonstrations())), methods(["gmr-5", "ramp"]), 2).rows

    assert failed.failed is not None
    assert "needs the package gmr" in failed.failed
    assert failed.spread_mid_m is None
    assert done.failed is None


def test_runs_that_touch_a_thing_are_counted(found: Comparison) -> None:
    clear, hit = Sphere("far", (0.0, 0.0, 9.0), radius=0.1), found.runs["ramp"][0].positions[100]
    thing = Sphere("ball", (float(hit[0]), float(hit[1]), float(hit[2])), radius=0.002)
    row, free = (
        compare(Task(tuple(demonstrations()), things=things), methods(["ramp"])).rows[0]
        for things in ((clear, thing), (clear,))
    )

    assert row.contacts == 1
    assert row.clearance_m == pytest.approx(-0.002)
    assert free.contacts == 0
    assert free.clearance_m is not None
    assert free.clearance_m > 8.0
    assert row_of(found, "ramp").contacts is None


def test_the_command_prints_the_promised_keys(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(tmp_path / "skill.csv", demonstrations())
    main(["compare", str(tmp_path / "skill.csv"), "--starts", "3", "--methods", "gc", "ramp", "--json"])

    rows = json.loads(capsys.readouterr().out)
    assert [row["method"] for row in rows] == ["gc", "ramp"]
    assert set(rows[0]) >= PROMISED
    assert all(row["failed"] is None and row["fit_ms"] > 0.0 for row in rows)


def test_the_command_says_the_same_in_a_table_and_sentences(capsys: pytest.CaptureFixture[str]) -> None:
    main(["compare", "reaching", "--methods", "gc", "ramp"])

    said = capsys.readouterr().out
    for part in (
        "5 starts in the first slice",
        "gc keeps the paths apart",
        "ramp: half way",
        "take the tube",
    ):
        assert part in said


@pytest.mark.parametrize(
    ("given", "told"),
    [("nothing.csv", "nothing.csv"), ("reeching", "reaching"), ("reaching --methods", "Choose gc, ramp, or")],
)
def test_what_cannot_be_compared_is_one_sentence(
    given: str, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main(["compare", *given.split()])

    said = capsys.readouterr().err
    assert told in said
    assert said.count("\n") == 1
