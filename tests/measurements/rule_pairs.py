"""Random pairs of rules on real and made-up tubes: how far runs leap that obey both.

Run with ``python -m tests.measurements.rule_pairs``; a table goes to the screen.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gc_core import (
    Constraint,
    GeneralizedCylinder,
    Reproduction,
    constrain,
    contradictions,
    encode,
    reproduce,
    soft_correction,
)
from gc_core.arrays import FloatArray
from gc_core.constraints import planes_at
from tests.core.shapes import bundle
from tests.helpers_data import ALL_SETS, DATA, load

LEAP = 3.0
"""A step above this many times the former largest is a leap [-]."""
MADE_UP = 12
"""Tubes."""
PAIRS = 40
"""A tube."""
SIZE = 0.12
"""Corrections are up to this part of the length of the tube [-]."""


@dataclass(frozen=True)
class Pair:
    """What became of runs that obey two rules."""

    opposed: bool
    """Whether the rules' directions differ by more than 90 degrees."""
    contradict: bool
    """Whether the two have no place in common somewhere."""
    turned: bool
    """Whether their planes face each other by more than 150 degrees where the worst step is."""
    apart: bool
    """Whether the worst step is where neither rule begins or ends."""
    ratio: float
    """Longest step by the former longest, the worse of the two runs [-]."""
    behind: float
    """How far the runs still are behind a plane, where the two do not contradict each other [m]."""


def tubes() -> Iterator[tuple[str, GeneralizedCylinder]]:
    """Name and tube, made-up ones first."""
    for seed in range(MADE_UP):
        yield f"bundle {seed}", encode(bundle(seed))
    for name in ALL_SETS if DATA.is_dir() else ():
        yield name, encode(load(name), align_by="arc_length")


def start_in(cylinder: GeneralizedCylinder, rng: np.random.Generator) -> FloatArray:
    """Somewhere in the first section."""
    rim = cylinder.surface()[0, rng.integers(cylinder.surface().shape[1])]
    return cylinder.directrix[0] + np.sqrt(rng.uniform()) * (rim - cylinder.directrix[0])


def rule_of(run: Reproduction, length: float, rng: np.random.Generator) -> Constraint:
    """A run pulled somewhere in its middle."""
    by = rng.normal(size=3)
    by *= length * rng.uniform(0.02, SIZE) / np.linalg.norm(by)
    index = int(rng.uniform(0.2, 0.8) * len(run.times))
    pulled = soft_correction(run.positions, index, by, rng.uniform(0.1, 0.4) * length)
    return Constraint.from_correction(run, pulled)


def longest(run: Reproduction) -> tuple[float, int]:
    """Longest step [m], and where it begins."""
    steps = np.linalg.norm(np.diff(run.positions, axis=0), axis=1)
    return float(steps.max()), int(np.argmax(steps))


def pair_on(cylinder: GeneralizedCylinder, rng: np.random.Generator) -> Pair | None:
    """Two rules of two runs, obeyed by two other runs; None where they have no station in common."""
    length = float(cylinder.arc_length[-1])
    rules = [rule_of(reproduce(cylinder, start_in(cylinder, rng)), length, rng) for _ in range(2)]
    both = rules[0].active & rules[1].active
    if not both.any():
        return None
    facing = np.einsum("ki,ki->k", rules[0].normals, rules[1].normals)
    opposed = bool(np.median(facing[both]) < 0.0)
    clash = bool(contradictions(rules))
    worst, behind = (0.0, 0), 0.0
    for _ in range(2):
        run = reproduce(cylinder, start_in(cylinder, rng))
        ruled = constrain(run, rules)
        step, place = longest(ruled)
        worst = max(worst, (step / longest(run)[0], place))
        parts = ruled.stations / ruled.stations[-1]
        if not clash:
            behind = max(behind, *(float(planes_at(r, parts).behind(ruled.positions).max()) for r in rules))
    place = worst[1]
    same = all(rule.active[place] == rule.active[place + 1] for rule in rules)
    turned = bool(facing[place : place + 2].min() < np.cos(np.radians(150.0)))
    return Pair(opposed, clash, turned, same, worst[0], behind)


def main() -> None:
    """Print how many pairs of either kind make a run leap, and where."""
    found: list[Pair] = []
    for number, (_, cylinder) in enumerate(tubes()):
        rng = np.random.default_rng(number)
        pairs = (pair_on(cylinder, rng) for _ in range(PAIRS))
        found += [pair for pair in pairs if pair is not None]
    for title, kept in (
        ("less than 90 degrees", [p for p in found if not p.opposed]),
        ("more than 90 degrees", [p for p in found if p.opposed and not p.contradict]),
        ("contradicting each other", [p for p in found if p.opposed and p.contradict]),
    ):
        leaps = [pair for pair in kept if pair.ratio > LEAP]
        within = sum(pair.apart for pair in leaps)
        turned = sum(pair.turned for pair in leaps)
        ratios = sorted(pair.ratio for pair in kept)
        print(
            f"{title}: {len(kept)} pairs, {len(leaps)} leap (at no end of a span {within}, planes at more "
            f"than 150 degrees {turned}); ratio median {np.median(ratios):.2f}, 95 % "
            f"{np.quantile(ratios, 0.95):.2f}, worst {ratios[-1]:.1f}; behind a plane by up to "
            f"{max(pair.behind for pair in kept):.1e} m"
        )


if __name__ == "__main__":
    main()
