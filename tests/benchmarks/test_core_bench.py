"""Times of the core's public calls; printed by `make bench`, skipped otherwise."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gc_core import Demonstration, GeneralizedCylinder, Landmark, encode, generalize, register, reproduce
from tests.core.shapes import bundle

pytestmark = pytest.mark.benchmark


@pytest.fixture(scope="module")
def cylinder() -> GeneralizedCylinder:
    return encode(bundle(0, 5, 1500))


@pytest.mark.parametrize("align_by", ["time", "arc_length"])
@pytest.mark.parametrize("section", ["circle", "ellipse", "closed_spline", "hull"])
def test_encode_five_demonstrations_of_1500_samples(benchmark: Any, section: str, align_by: str) -> None:
    shown = bundle(0, 5, 1500)

    benchmark(encode, shown, section=section, align_by=align_by)


def test_encode_five_demonstrations_of_300_samples(benchmark: Any) -> None:
    benchmark(encode, bundle(0, 5, 300))


def test_encode_again_when_one_of_five_demonstrations_changed(benchmark: Any) -> None:
    shown = bundle(0, 5, 300)
    encode(shown)

    def again() -> GeneralizedCylinder:
        return encode([Demonstration(shown[0].times, shown[0].positions + 0.001), *shown[1:]])

    benchmark(again)


@pytest.mark.parametrize("count", [1, 5, 1000])
def test_reproduce(benchmark: Any, cylinder: GeneralizedCylinder, count: int) -> None:
    ray = cylinder.surface()[0, np.arange(count) % 64] - cylinder.directrix[0]
    starts = cylinder.directrix[0] + np.random.default_rng(0).uniform(0.0, 1.0, (count, 1)) * ray

    benchmark(reproduce, cylinder, starts)


@pytest.mark.parametrize("count", [1, 2, 4])
def test_generalize_by_landmarks(benchmark: Any, cylinder: GeneralizedCylinder, count: int) -> None:
    source = cylinder.directrix[np.linspace(0, 199, count).astype(int)]
    target = source + np.random.default_rng(1).normal(scale=0.05, size=(count, 3))

    benchmark(lambda: generalize(cylinder, register(source, target)))


def test_generalize_by_two_frames(benchmark: Any, cylinder: GeneralizedCylinder) -> None:
    ends = cylinder.directrix[[0, -1]]
    source = [Landmark(end, np.array([1.0, 0.0, 0.0, 0.0])) for end in ends]
    target = [
        Landmark(ends[0] + 0.05, np.array([1.0, 0.2, 0.0, 0.0])),
        Landmark(ends[1], np.array([1.0, 0, 0.3, 0])),
    ]

    benchmark(lambda: generalize(cylinder, register(source, target)))


def test_locate_a_thousand_points(benchmark: Any, cylinder: GeneralizedCylinder) -> None:
    benchmark(cylinder.locate, cylinder.surface()[::10, ::2].reshape(-1, 3))
