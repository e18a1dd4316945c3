"""The dip and the lid: what a correction of a demonstration teaches, and what a rule asks of runs."""

from pathlib import Path

import numpy as np
import pytest

from app import edits
from app.document import SECTION_KINDS, FloatArray
from app.model import Model, learn
from app.skills import load_card, load_skill
from gc_core import (
    Constraint,
    Demonstration,
    GeneralizedCylinder,
    Reproduction,
    as_demonstration,
    constrain,
    encode,
    refined,
    reproduce,
    soft_correction,
)
from gc_core.constraints import planes_at

FOLDER = Path(__file__).parents[2] / "static" / "skills"
DIP, LID = (load_card(FOLDER, name) for name in ("the_dip", "the_lid"))
SHOWN = [item.demonstration for item in load_skill(FOLDER, "the_dip").demonstrations]
KINDS = (*SECTION_KINDS, "hull")
DOWN = np.array([0.0, 0.0, -1.0])


def middle(path: FloatArray) -> int:
    """The sample half-way along a path."""
    gone = np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))
    return int(np.searchsorted(gone, 0.5 * gone[-1]))


def corrected(index: int) -> tuple[Demonstration, ...]:
    """The dip's demonstrations with one of them pulled down in its middle."""
    path = SHOWN[index].positions
    pulled = soft_correction(path, middle(path), DIP.law["pull_m"] * DOWN, DIP.law["width_m"])
    return refined(SHOWN, index, pulled)


def learned(shown: list[Demonstration] | tuple[Demonstration, ...], section: str) -> GeneralizedCylinder:
    return encode(shown, section=section, align_by="arc_length")


def level(cylinder: GeneralizedCylinder) -> int:
    """The corner of the first section that is level with the middle line."""
    return int(np.argmax(np.abs(cylinder.surface()[0] - cylinder.directrix[0]) @ [1.0, 1.0, -9.0]))


def towards(cylinder: GeneralizedCylinder, corner: int, ratio: float) -> Reproduction:
    """A run from a ratio, in the direction of a corner of the sections."""
    centre, rim = cylinder.directrix[0], cylinder.surface()[0, corner]
    return reproduce(cylinder, centre + ratio * (rim - centre))


def depth(before: FloatArray, after: FloatArray) -> float:
    """How far a path went down where it went down most [m]."""
    return float(((after - before) @ DOWN).max())


def test_the_dip_appears_in_the_corrected_demonstration_alone() -> None:
    after = corrected(0)

    assert depth(SHOWN[0].positions, after[0].positions) >= DIP.law["dip_m"]
    ends = np.linalg.norm(after[0].positions[[0, -1]] - SHOWN[0].positions[[0, -1]], axis=1)
    assert ends.max() < DIP.law["others_m"]
    assert all(other is shown for other, shown in zip(after[1:], SHOWN[1:], strict=True))
    np.testing.assert_array_equal(after[0].times, SHOWN[0].times)


@pytest.mark.parametrize("section", KINDS)
@pytest.mark.parametrize("index", range(len(SHOWN)))
def test_the_middle_line_dips_by_the_demonstrations_share(section: str, index: int) -> None:
    before, after = learned(SHOWN, section).directrix, learned(corrected(index), section).directrix

    share = DIP.law["pull_m"] / len(SHOWN)
    assert depth(before, after) == pytest.approx(share, rel=DIP.law["of_the_mean"])
    assert np.linalg.norm(after[[0, -1]] - before[[0, -1]], axis=1).max() < DIP.law["others_m"]


@pytest.mark.parametrize("section", KINDS)
@pytest.mark.parametrize("ratio", [0.0, 0.25, 0.5])
@pytest.mark.parametrize("side", [0.0, 0.5])
def test_a_run_beside_the_middle_line_dips_by_the_demonstrations_share(
    section: str, ratio: float, side: float
) -> None:
    before, after = learned(SHOWN, section), learned(corrected(0), section)
    corner = (level(before) + round(side * len(before.angles))) % len(before.angles)
    runs = [towards(one, corner, ratio).positions for one in (before, after)]

    share = DIP.law["pull_m"] / len(SHOWN)
    assert depth(*runs) == pytest.approx(share, rel=DIP.law["of_the_mean"])


@pytest.mark.parametrize("section", KINDS)
@pytest.mark.parametrize("ratio", [0.25, 0.5, 0.9])
def test_a_run_follows_the_boundary_by_its_ratio_and_the_mean_by_the_rest(section: str, ratio: float) -> None:
    # Above and below the middle line the section changes its shape with the corrected demonstration, which
    # lies on its rim, and so a run of the same ratio dips by less or by more than the mean.
    before, after = learned(SHOWN, section), learned(corrected(0), section)
    mean, rim = after.directrix - before.directrix, after.surface() - before.surface()
    for corner in range(0, len(before.angles), len(before.angles) // 8):
        runs = [towards(one, corner, ratio) for one in (before, after)]
        moved = runs[1].positions - runs[0].positions
        np.testing.assert_allclose(moved, (1.0 - ratio) * mean + ratio * rim[:, corner], atol=1e-9)
        np.testing.assert_allclose(runs[1].ratios, runs[0].ratios, atol=1e-9)
        assert 0.0 < depth(runs[0].positions, runs[1].positions) < DIP.law["pull_m"]


def test_a_corrected_run_that_joins_the_set_is_learned_from() -> None:
    cylinder = learned(SHOWN, "circle")
    run = towards(cylinder, 0, 0.0)
    dipped = soft_correction(run.positions, 100, DIP.law["pull_m"] * DOWN, DIP.law["width_m"])
    extra = Demonstration(run.times, dipped, name="Corrected run")

    joined = learned([*SHOWN, extra], "circle")
    unchanged = learned([*SHOWN, as_demonstration(run, "Run")], "circle")
    share = DIP.law["pull_m"] / (len(SHOWN) + 1)
    assert depth(unchanged.directrix, joined.directrix) == pytest.approx(share, rel=DIP.law["of_the_mean"])


def pressed(run: Reproduction) -> Constraint:
    path = run.positions
    lower = soft_correction(path, middle(path), LID.law["press_m"] * DOWN, LID.law["width_m"])
    return Constraint.from_correction(run, lower, "Lid")


@pytest.fixture(scope="module")
def free() -> Model:
    return learn(load_skill(FOLDER, "the_lid"))


def test_the_lid_comes_with_a_run_above_and_a_run_below(free: Model) -> None:
    upper, lower = (run.free.positions[100, 2] for run in free.runs)

    assert upper > free.cylinder.directrix[100, 2] + 0.04
    assert lower < free.cylinder.directrix[100, 2] - 0.04


def test_the_upper_run_obeys_and_the_lower_is_untouched(free: Model) -> None:
    rule = pressed(free.runs[0].reproduction)
    ruled = learn(edits.add_rule(free.source, rule), free)

    upper, lower = ruled.runs
    above = np.einsum("ki,ki->k", rule.points - upper.reproduction.positions, rule.normals)
    assert above[rule.active].max() <= LID.law["obeys_m"]
    assert lower.reproduction is lower.free
    np.testing.assert_array_equal(lower.reproduction.positions, free.runs[1].reproduction.positions)


def test_the_rule_off_restores_the_former_run_bit_by_bit(free: Model) -> None:
    ruled = learn(edits.add_rule(free.source, pressed(free.runs[0].reproduction)), free)
    off = learn(edits.enable_rule(ruled.source, 0, False), ruled)

    np.testing.assert_array_equal(off.runs[0].reproduction.positions, free.runs[0].reproduction.positions)


@pytest.mark.parametrize("ratio", [0.5, 0.75, 1.0])
def test_every_run_above_the_lid_obeys_without_a_leap(free: Model, ratio: float) -> None:
    cylinder, rule = free.cylinder, pressed(free.runs[0].reproduction)
    centre, rim = cylinder.directrix[0], cylinder.surface()[0]
    above = rim[rim[:, 2] > centre[2]]
    for start in centre + ratio * (above - centre):
        run = reproduce(cylinder, start)
        obeying = constrain(run, [rule])
        lid = planes_at(rule, run.stations / run.stations[-1])
        steps = [np.linalg.norm(np.diff(one.positions, axis=0), axis=1) for one in (run, obeying)]
        assert lid.behind(obeying.positions).max() <= LID.law["obeys_m"]
        assert steps[1].max() <= LID.law["leap"] * steps[0].max()
