"""A study: the same bit by bit wherever it is run, never twice the same part, and what its numbers mean."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pyarrow.parquet
import pytest

from app.__main__ import main
from app.likeness import nearest_frechet
from app.study import executors
from app.study.errors import ClusterError, OtherVersionsError
from app.study.experiments import Job, work
from app.study.keeping import Shelf
from app.study.measures import Row, shape_change
from app.study.parts import Part, versions
from app.study.report import write_report
from app.study.running import Outcome, run_study
from app.study.sources import data_set
from app.study.spec import Plan
from app.study.summary import failures
from gc_core import metrics
from tests.baselines.makers import demonstrations, needs_gmr
from tests.study.makers import PARTS, SMALL, alone, small

pytestmark = needs_gmr
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("study")


@pytest.fixture(scope="module")
def done(folder: Path) -> Outcome:
    return alone(small(folder), folder / "out")


def rows_of(found: Outcome, experiment: str, method: str) -> list[Row]:
    return [
        row
        for part, done in found.found
        for row in done.rows
        if (part.experiment, part.method) == (experiment, method)
    ]


def table(out: Path) -> bytes:
    return (out / "results.parquet").read_bytes() + (out / "results.csv").read_bytes()


def parts_in(out: Path) -> dict[str, int]:
    return {path.name: path.stat().st_mtime_ns for path in (out / "parts").glob("*.json")}


@contextmanager
def nobody() -> Iterator[executors.Executor]:
    raise AssertionError("a finished part would be worked out again")
    yield executors.in_this_process


def test_a_cluster_makes_the_same_table_bit_by_bit(folder: Path, done: Outcome, tmp_path: Path) -> None:
    dask = pytest.importorskip("distributed")
    settings = {
        "n_workers": 2,
        "threads_per_worker": 1,
        "host": "127.0.0.1",
        "dashboard_address": "127.0.0.1:0",
    }
    with dask.LocalCluster(**settings, processes=True) as made:
        found = run_study(done.spec, tmp_path, executors.cluster(made.scheduler_address))

    assert found.skipped == 0
    assert table(tmp_path) == table(folder / "out")


def test_a_study_killed_in_the_middle_goes_on_and_processes_make_the_same_table(
    folder: Path, done: Outcome, tmp_path: Path
) -> None:
    command = [sys.executable, "-m", "app", "study", str(folder / "small.toml"), "--out", str(tmp_path)]
    with subprocess.Popen([*command, "--workers", "1"], cwd=ROOT, stderr=subprocess.DEVNULL) as running:
        while len(parts_in(tmp_path)) < 3 and running.poll() is None:
            time.sleep(0.01)
        os.kill(running.pid, signal.SIGKILL)
    before = parts_in(tmp_path)

    found = run_study(done.spec, tmp_path, executors.processes(2))

    after = parts_in(tmp_path)
    assert 3 <= found.skipped == len(before) < PARTS == len(after)
    assert before.items() <= after.items()
    assert table(tmp_path) == table(folder / "out")


def test_what_is_finished_is_not_done_again(folder: Path, done: Outcome, tmp_path: Path) -> None:
    before = parts_in(folder / "out")
    again = run_study(done.spec, folder / "out", nobody())

    assert again.skipped == len(again.found) == PARTS
    assert parts_in(folder / "out") == before
    assert write_report(again, tmp_path).read_bytes() == write_report(done, folder / "out").read_bytes()


def test_only_what_a_change_concerns_is_done_again(folder: Path, done: Outcome) -> None:
    more = alone(small(folder, "moves = 1"), folder / "out")
    other = alone(small(folder, 'methods = ["ramp"]\nseed = 8'), folder / "out")

    assert more.skipped == PARTS * 2 // 3
    assert other.skipped == 0
    assert rows_of(other, "starts", "ramp")[0].away_start_m != rows_of(done, "starts", "ramp")[0].away_start_m


def test_a_part_depends_on_no_other_part(folder: Path, done: Outcome, tmp_path: Path) -> None:
    few = alone(small(folder, 'methods = ["ramp"]'), tmp_path)

    for experiment in ("starts", "moves", "left_out"):
        assert rows_of(few, experiment, "ramp") == rows_of(done, experiment, "ramp")


def test_a_damaged_part_counts_for_nothing(tmp_path: Path, done: Outcome) -> None:
    shelf, (part, found) = Shelf(tmp_path), done.found[0]
    shelf.put("key", part, found)
    whole = shelf.path("key").read_bytes()

    assert shelf.get("key") == found
    for length in (0, len(whole) // 2):
        shelf.path("key").write_bytes(whole[:length])
        assert shelf.get("key") is None


def test_a_method_that_fails_is_a_cell_and_stops_nothing(tmp_path: Path) -> None:
    spec = small(tmp_path, 'methods = ["ramp", "gmr-150"]')
    found = alone(spec, tmp_path)

    failed = [row for each in ("starts", "moves", "left_out") for row in rows_of(found, each, "gmr-150")]
    assert len(failed) == found.failed == 8
    assert all("gmr-150 cannot learn these demonstrations" in str(row.failed) for row in failed)
    assert all(row.failed is None for row in rows_of(found, "starts", "ramp"))
    assert [(each.method, each.runs) for each in failures(found.found)] == [("gmr-150", 5), ("gmr-150", 3)]


def test_all_methods_run_from_the_same_starts_in_the_first_slice(done: Outcome) -> None:
    starts = [
        [row.away_start_m for row in rows_of(done, "starts", each)[:3]] for each in ("gc", "ramp", "gmr-5")
    ]

    assert starts[0] == starts[1] == starts[2]
    assert len(set(starts[0])) == 3


def test_numbers_keep_the_laws_of_the_methods(done: Outcome) -> None:
    tube, ramp, mixture = (rows_of(done, "starts", each) for each in ("gc", "ramp", "gmr-5"))

    assert all(row.contained_own == 1.0 for row in tube)
    np.testing.assert_allclose([row.end_error_m or 0.0 for row in ramp], 0.0, atol=1e-9)
    np.testing.assert_allclose([row.spread_kept or 0.0 for row in mixture], 0.0, atol=1e-6)


def test_a_moved_tube_and_ramp_meet_both_ends_and_regression_neither(done: Outcome) -> None:
    tube, ramp, mixture = (rows_of(done, "moves", each) for each in ("gc", "ramp", "gmr-5"))

    for row in (*tube, *ramp):
        np.testing.assert_allclose([row.start_error_m, row.end_error_m], 0.0, atol=1e-9)
    assert min(row.end_error_m or 0.0 for row in mixture) > 0.01


def test_leaving_one_out_makes_one_run_for_each_demonstration(done: Outcome) -> None:
    for method, count in (("gc", 6), ("ramp", 3)):
        rows = rows_of(done, "left_out", method)
        assert len(rows) == count
        assert min(row.frechet_m or 0.0 for row in rows) > 0.0


def test_one_of_equal_demonstrations_is_not_missed() -> None:
    equal = data_set("equal", 3 * demonstrations(1))
    part = Part("left_out", "equal", "arc_length", "ramp", "")
    found = work(Job(Plan(leave_one_out=True), part, versions()), equal)

    for row in found.rows:
        np.testing.assert_allclose([row.frechet_m, row.dtw_m, row.end_error_m], 0.0, atol=1e-9)


def test_the_tables_say_what_was_found_and_times_stand_apart(folder: Path, done: Outcome) -> None:
    alone(done.spec, folder / "out")
    results, timings = (
        pyarrow.parquet.read_table(folder / "out" / f"{name}.parquet") for name in ("results", "timings")
    )

    assert results.to_pylist() == [vars(row) for _, each in done.found for row in each.rows]
    assert not {name for name in results.column_names if "_ms" in name or "seconds" in name}
    assert timings.num_rows == PARTS
    assert min(timings["fit_ms"].to_pylist()) > 0.0


def test_the_nearest_path_is_found_without_walking_along_all() -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        path, *others = rng.normal(size=(6, 12, 3)).cumsum(axis=1)
        assert nearest_frechet(path, others) == min(metrics.frechet(path, other) for other in others)


def test_a_shape_that_is_turned_scaled_and_shifted_is_the_same() -> None:
    curve = np.random.default_rng(2).normal(size=(30, 3)).cumsum(axis=0)
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])

    assert shape_change(curve, 1.7 * curve @ quarter + 0.4) == pytest.approx(0.0, abs=1e-12)
    assert shape_change(curve, curve * [1.0, 1.0, -1.0]) > 0.01


def test_a_worker_with_other_versions_is_not_believed(done: Outcome) -> None:
    job = Job(done.spec.plan, done.found[0][0], dict(versions()) | {"numpy": "1.0"})

    with pytest.raises(OtherVersionsError, match=r"numpy .* in place of 1.0"):
        executors.calmly(job, done.data[0])


def test_a_scheduler_that_is_not_there_is_a_sentence_without_a_bar(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr(executors, "PATIENCE", 0.2)

    with pytest.raises(ClusterError, match="Start it with 'dask scheduler'"):
        run_study(small(tmp_path), tmp_path, executors.cluster("tcp://127.0.0.1:9"))

    assert "study" not in capsys.readouterr().err


def test_the_command_says_one_json_value_and_writes_a_page_that_needs_no_network(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    changes = 'title = "No <net>"\nmethods = ["gc", "gmr-150"]\nmoves = 0\nleave_one_out = false\n'
    changes += "data_sets = [{ name = '$<b>\\q$', files = 'bent.csv' }]"
    small(tmp_path, changes)
    main(["study", str(tmp_path / "small.toml"), "--out", str(tmp_path / "out"), "--workers", "1", "--json"])

    said = json.loads(capsys.readouterr().out)
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert [said[key] for key in ("rows", "failed", "parts", "skipped")] == [9, 3, 3, 0]
    assert "No &lt;net&gt;" in page
    assert "<b>" not in page
    assert ">$" not in page.replace(">$&lt;b", "")  # powers of ten are written as such
    assert page.count("$&lt;b&gt;\\q$") == 3 + 5  # in tables, and above each drawing
    assert "gmr-150 cannot learn these demonstrations" in page
    assert page.count("<svg") == 5
    assert "Random starts, Frechet: least for gc " in page
    assert all(each not in page for each in ("src=", "<link", "@import", "url(http"))


def test_a_wrong_command_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "bad.toml").write_text(SMALL.replace("starts", "stars"), encoding="utf-8")
    with pytest.raises(SystemExit):
        main(["study", str(tmp_path / "bad.toml"), "--out", str(tmp_path)])

    assert capsys.readouterr().err == (
        "bad.toml: there is no key 'stars'. Possible are: title, seed, data, data_sets, methods, sections, "
        "alignments, starts, moves, farthest_m, leave_one_out.\n"
    )
