"""The numbered examples: each runs as it stands, draws its figure, and finds what the method promises."""

from __future__ import annotations

import runpy
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from app.comparison import claims
from gc_core import GeneralizedCylinder, Reproduction, metrics

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
DOCS = ROOT / "docs"
NAMES = sorted(path.stem for path in HERE.glob("[0-9]*.py"))
RED, BLUE, GREY, MAGENTA = (196, 22, 28), (31, 63, 168), (142, 150, 166), (224, 75, 220)
YELLOW, GREEN = (242, 186, 26), (26, 158, 115)
SHOWN = {
    "01_encode": (RED, BLUE, GREY),
    "02_reproduce": (BLUE, MAGENTA),
    "03_orientation": (RED, BLUE, MAGENTA),
    "04_starts_outside": (BLUE, GREY, MAGENTA),
    "05_section_kinds": (RED, BLUE, GREY),
    "06_new_goals": (BLUE, MAGENTA, YELLOW),
    "07_new_starts": (BLUE, MAGENTA, YELLOW),
    "08_both_ends": (BLUE, MAGENTA, YELLOW),
    "09_incremental_refinement": (RED, BLUE, MAGENTA, GREEN),
    "10_constraint": (MAGENTA, GREEN),
    "11_comparison": (RED, MAGENTA),
}
LARGEST_FIGURE = 150_000
"""Bytes of a figure in the docs."""
SAME_COLOUR = 20
"""Greatest difference of a channel, of 255: edges of lines are mixed with what is behind them."""
LEAST_INK = 100
"""Pixels that a line of a figure covers at the least."""

Runner = Callable[[str], dict[str, Any]]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Runner:
    """Run an example once, as a program, and keep all its variables."""
    done: dict[str, dict[str, Any]] = {}
    folder = tmp_path_factory.mktemp("figures")

    def run_once(name: str) -> dict[str, Any]:
        if name not in done:
            with pytest.MonkeyPatch.context() as patch:
                patch.syspath_prepend(str(HERE))
                patch.setattr(sys, "argv", [f"{name}.py", "--out", str(folder)])
                done[name] = runpy.run_path(str(HERE / f"{name}.py"), run_name="__main__")
        return done[name]

    return run_once


def inked(pixels: np.ndarray, colour: tuple[int, int, int]) -> int:
    return int((np.abs(pixels.astype(int) - colour).max(axis=2) <= SAME_COLOUR).sum())


@pytest.mark.parametrize("name", NAMES)
def test_an_example_draws_its_figure_in_the_colours_of_the_app(run: Runner, name: str) -> None:
    pixels = np.asarray(Image.open(run(name)["figure"]).convert("RGB"))

    assert {colour for colour in SHOWN[name] if inked(pixels, colour) < LEAST_INK} == set()


def test_an_example_runs_from_a_checkout_as_it_is_written_down(tmp_path: Path) -> None:
    command = [sys.executable, "tests/examples/01_encode.py", "--out", str(tmp_path)]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=120)

    assert ran.returncode == 0, ran.stderr
    assert (tmp_path / "01_encode.png").stat().st_size > 0


def test_the_encoded_tube_holds_what_was_shown(run: Runner) -> None:
    found = run("01_encode")
    crossings = found["cylinder"].effective_points.reshape(-1, 3)

    assert found["cylinder"].contains(crossings).all()
    assert found["inside"] == 1.0


def test_new_runs_stay_inside_and_the_convergent_ones_meet(run: Runner) -> None:
    found = run("02_reproduce")
    starts, fixed, convergent = found["starts"], found["fixed"], found["convergent"]

    np.testing.assert_array_equal(fixed.positions[:, 0], starts)
    assert [metrics.containment(found["cylinder"], path) for path in fixed.positions] == [1.0] * len(starts)
    ends = convergent.positions[:, -1]
    np.testing.assert_allclose(ends, np.broadcast_to(found["goal"], ends.shape), atol=1e-9)


def test_a_new_run_turns_the_hand_within_what_was_shown(run: Runner) -> None:
    found = run("03_orientation")
    begins, ends = found["habits"].T

    assert np.diff(found["below"]).min() > -1e-6
    assert begins.min() < np.deg2rad(found["below"][0]) < begins.max()
    assert ends.min() < np.deg2rad(found["below"][-1]) < ends.max()


def test_each_policy_leads_a_start_outside_where_it_says(run: Runner) -> None:
    found = run("04_starts_outside")
    final = {policy: runs.ratios[-1] for policy, runs in found["runs"].items()}

    assert [runs.start_inside for runs in found["runs"].values()] == [False] * 3
    assert all(np.array_equal(runs.positions[0], found["start"]) for runs in found["runs"].values())
    assert final == pytest.approx({"keep": 1.8, "boundary": 1.0, "directrix": 0.0}, abs=1e-6)


def test_an_ellipse_is_tighter_than_a_circle_and_the_hull_tighter_than_all(run: Runner) -> None:
    volumes = {kind: cylinder.volume for kind, cylinder in run("05_section_kinds")["cylinders"].items()}

    assert volumes["ellipse"] < volumes["circle"]
    assert min(volumes, key=volumes.__getitem__) == "hull"


def assert_generalized(tube: GeneralizedCylinder, run: Reproduction, after: np.ndarray) -> None:
    """The tube's ends are at the landmarks (2, 3), and the runs are in the tube."""
    assert np.linalg.norm(tube.directrix[[0, -1]] - after, axis=1).max() < 1e-3
    assert not (tube.diagnostics.folded | tube.diagnostics.crossing).any()
    assert [metrics.containment(tube, path) for path in run.positions] == [1.0] * len(run.positions)


@pytest.mark.parametrize(("name", "count"), [("06_new_goals", 3), ("07_new_starts", 4)])
def test_the_tube_follows_each_new_goal_and_each_new_start(run: Runner, name: str, count: int) -> None:
    found = run(name)

    assert len(found["tubes"]) == count
    for tube, runs, after in zip(found["tubes"], found["runs"], found["placings"], strict=True):
        assert_generalized(tube, runs, after)
        assert (np.linalg.norm(after - found["before"], axis=1) > 0.1).sum() == 1


def test_the_hand_closes_at_each_new_start_and_opens_at_the_goal(run: Runner) -> None:
    found = run("07_new_starts")

    for runs, after in zip(found["runs"], found["placings"], strict=True):
        closes, opens = np.flatnonzero(np.diff(runs.gripper)) + 1
        assert np.linalg.norm(runs.positions[:, [closes, opens]] - after, axis=2).max() < 0.03


def test_both_ends_are_moved_at_once(run: Runner) -> None:
    found = run("08_both_ends")

    for name, tube in found["tubes"].items():
        assert_generalized(tube, found["runs"][name], found["after"][name])
        assert np.linalg.norm(found["after"][name] - found["before"][name], axis=1).min() > 0.1


def test_one_corrected_demonstration_of_three_lowers_the_middle_line_by_a_third(run: Runner) -> None:
    found = run("09_incremental_refinement")

    assert found["sunk"].max() == pytest.approx(0.03, rel=0.1)
    fallen = (found["runs"][0] - found["runs"][1])[:, :, 2].max(axis=1)
    assert fallen == pytest.approx([0.03, 0.03], rel=0.1)


def test_runs_above_the_lid_obey_and_the_run_below_is_the_same_object(run: Runner) -> None:
    found = run("10_constraint")

    assert [ruled is free for free, ruled in zip(found["free"], found["obeying"], strict=True)] == [
        False,
        False,
        False,
        True,
    ]


def test_only_the_cylinder_keeps_five_starts_apart(run: Runner) -> None:
    found = run("11_comparison")["found"]
    told = claims(found)

    assert {row.method for row in found.rows if row.failed is None} >= {"gc", "ramp"}
    assert [claim.sentence for claim in told if not claim.holds] == []
    assert all(row.contacts == 0 for row in found.rows if row.method == "gc")


@pytest.mark.parametrize("name", NAMES)
def test_examples_are_short_and_their_figures_are_in_the_docs(name: str) -> None:
    shown = (DOCS / "examples.md").read_text(encoding="utf-8")

    assert len((HERE / f"{name}.py").read_text(encoding="utf-8").splitlines()) <= 60
    assert f"(figures/{name}.png)" in shown
    assert f"(../tests/examples/{name}.py)" in shown
    assert (DOCS / "figures" / f"{name}.png").stat().st_size < LARGEST_FIGURE
