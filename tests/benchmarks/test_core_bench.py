"""Times of the core's public calls; printed by `make bench`, skipped otherwise."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest

from gc_core import Demonstration, GeneralizedCylinder, encode
from gc_core.alignment import ALIGNMENTS
from gc_core.frames import arc_length
from gc_core.sections import SECTIONS
from tests.core.shapes import bundle
from tests.helpers_data import load

Arguments = tuple[tuple[list[Demonstration]], dict[str, Any]]


def fresh(shown: list[Demonstration]) -> Callable[[], Arguments]:
    """Makes the arguments of `encode` anew for each round: what was trimmed once is remembered."""
    return lambda: (([replace(demonstration) for demonstration in shown],), {})


def hairpin(count: int, samples: int) -> list[Demonstration]:
    """There and back round a bend of 2 cm, shown up to 3 cm apart: wider than the bend."""
    angle = np.linspace(-np.pi / 2.0, np.pi / 2.0, 60)
    bend = np.stack((0.3 + 0.02 * np.cos(angle), 0.02 * np.sin(angle), 0.0 * angle), axis=1)
    corners = np.vstack(([0.0, -0.02, 0.0], bend, [0.0, 0.02, 0.0]))
    length = arc_length(corners)
    gone = np.linspace(0.0, length[-1], samples)
    path = np.stack([np.interp(gone, length, column) for column in corners.T], axis=1)
    apart = np.random.default_rng(0).uniform(-0.015, 0.015, (count, 3))
    return [Demonstration(np.linspace(0.0, 4.0, samples), path + shift) for shift in apart]


@pytest.mark.benchmark(group="encode at 200 stations x 64 angles, demonstrations never seen before")
@pytest.mark.parametrize("align_by", ALIGNMENTS)
@pytest.mark.parametrize("section", sorted(SECTIONS))
def test_encode_five_demonstrations_of_1500_samples(benchmark: Any, section: str, align_by: str) -> None:
    shown = bundle(0, 5, 1500)
    ways = partial(encode, section=section, align_by=align_by)

    cylinder = benchmark.pedantic(ways, setup=fresh(shown), rounds=30, warmup_rounds=2)

    assert not cylinder.diagnostics.tilt.any()


@pytest.mark.benchmark(group="encode at 200 stations x 64 angles, planes tilted")
@pytest.mark.parametrize("section", sorted(SECTIONS))
def test_encode_five_demonstrations_of_a_hairpin(benchmark: Any, section: str) -> None:
    shown = hairpin(5, 1500)

    cylinder = benchmark.pedantic(
        partial(encode, section=section), setup=fresh(shown), rounds=15, warmup_rounds=1
    )

    assert cylinder.diagnostics.tilt.any() or cylinder.diagnostics.crossing.any()


@pytest.mark.benchmark(group="encode at 200 stations x 64 angles, planes tilted")
def test_encode_nine_recordings_of_pouring(benchmark: Any) -> None:
    benchmark.pedantic(encode, setup=fresh(load("pouring")), rounds=15, warmup_rounds=1)


@pytest.mark.benchmark(group="encode: other numbers of demonstrations and samples")
@pytest.mark.parametrize(("count", "samples"), [(5, 300), (100, 1500), (5, 100_000)])
def test_encode(benchmark: Any, count: int, samples: int) -> None:
    benchmark.pedantic(encode, setup=fresh(bundle(0, count, samples)), rounds=5, warmup_rounds=1)


@pytest.mark.benchmark(group="encode: demonstrations known")
def test_encode_the_same_five_of_1500_samples_again(benchmark: Any) -> None:
    benchmark(encode, bundle(0, 5, 1500))


@pytest.mark.benchmark(group="encode: demonstrations known")
def test_encode_again_when_one_of_five_demonstrations_changed(benchmark: Any) -> None:
    shown = bundle(0, 5, 300)
    encode(shown)

    def again() -> GeneralizedCylinder:
        return encode([Demonstration(shown[0].times, shown[0].positions + 0.001), *shown[1:]])

    benchmark(again)
