"""Times of runs and of locating points; printed by `make bench`, skipped otherwise."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gc_core import GeneralizedCylinder, encode, reproduce
from gc_core.arrays import FloatArray
from tests.core.shapes import bundle


@pytest.fixture(scope="module")
def cylinder() -> GeneralizedCylinder:
    return encode(bundle(0, 5, 1500))


def inside(cylinder: GeneralizedCylinder, stations: FloatArray) -> FloatArray:
    """Starts (S, 3) in sections of the given stations (S,)."""
    index = stations.astype(int)
    ray = cylinder.surface()[index, np.arange(len(index)) % 64] - cylinder.directrix[index]
    return cylinder.directrix[index] + np.random.default_rng(0).uniform(0.0, 1.0, (len(index), 1)) * ray


@pytest.mark.benchmark(group="reproduce")
@pytest.mark.parametrize("law", ["fixed", "convergent"])
@pytest.mark.parametrize("count", [1, 5, 1000])
def test_reproduce_from_the_first_section(
    benchmark: Any, cylinder: GeneralizedCylinder, count: int, law: str
) -> None:
    benchmark(reproduce, cylinder, inside(cylinder, np.zeros(count)), law=law)


@pytest.mark.benchmark(group="reproduce")
def test_reproduce_from_a_thousand_places_in_the_tube(benchmark: Any, cylinder: GeneralizedCylinder) -> None:
    benchmark(reproduce, cylinder, inside(cylinder, np.random.default_rng(1).uniform(0.0, 200.0, 1000)))


@pytest.mark.benchmark(group="reproduce")
@pytest.mark.parametrize("outside", ["keep", "boundary", "directrix"])
def test_reproduce_from_a_thousand_places_outside(
    benchmark: Any, cylinder: GeneralizedCylinder, outside: str
) -> None:
    off = np.random.default_rng(1).normal(scale=0.1, size=(1000, 3))

    benchmark(reproduce, cylinder, inside(cylinder, np.zeros(1000)) + off, outside=outside)


@pytest.mark.benchmark(group="locate")
@pytest.mark.parametrize("question", ["locate", "contains"])
@pytest.mark.parametrize("off", [0.0, 0.1])
def test_ask_about_a_thousand_points(
    benchmark: Any, cylinder: GeneralizedCylinder, off: float, question: str
) -> None:
    points = inside(cylinder, np.linspace(0.0, 199.0, 1000))

    benchmark(getattr(cylinder, question), points + np.random.default_rng(1).normal(size=(1000, 3)) * off)
