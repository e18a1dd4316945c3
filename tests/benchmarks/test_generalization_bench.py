"""Times of moving a tube with its landmarks; printed by `make bench`, skipped otherwise."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gc_core import GeneralizedCylinder, Landmark, ThinPlateSpline, encode, generalize, register
from tests.core.shapes import bundle

QUATERNION = np.array([1.0, 0.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def cylinder() -> GeneralizedCylinder:
    return encode(bundle(0, 5, 1500))


def by_points(cylinder: GeneralizedCylinder, count: int) -> ThinPlateSpline:
    source = cylinder.directrix[np.linspace(0, 199, count).astype(int)]
    return register(source, source + np.random.default_rng(1).normal(scale=0.05, size=(count, 3)))


def by_start_and_frame(cylinder: GeneralizedCylinder) -> ThinPlateSpline:
    start, goal = cylinder.directrix[[0, -1]]
    return register(
        [Landmark(start), Landmark(goal, QUATERNION)],
        [Landmark(start + 0.05), Landmark(goal + np.array([0.0, 0.05, 0.0]), np.array([1.0, 0.0, 0.0, 0.3]))],
    )


@pytest.mark.benchmark(group="a drag: register and generalize at 200 stations x 64 angles, planes not tilted")
@pytest.mark.parametrize("count", [1, 2, 3, 4, 6])
def test_drag_a_landmark(benchmark: Any, cylinder: GeneralizedCylinder, count: int) -> None:
    moved = benchmark(lambda: generalize(cylinder, by_points(cylinder, count), repair=False))

    assert not moved.diagnostics.tilt.any()


@pytest.mark.benchmark(group="a drag: register and generalize at 200 stations x 64 angles, planes not tilted")
def test_drag_a_start_and_an_object_s_frame(benchmark: Any, cylinder: GeneralizedCylinder) -> None:
    moved = benchmark(lambda: generalize(cylinder, by_start_and_frame(cylinder), repair=False))

    assert not moved.diagnostics.tilt.any()


@pytest.mark.benchmark(group="a release: the same, planes tilted where sections cross")
@pytest.mark.parametrize("count", [2, 4])
def test_release_a_landmark(benchmark: Any, cylinder: GeneralizedCylinder, count: int) -> None:
    upright = generalize(cylinder, by_points(cylinder, count), repair=False)
    moved = benchmark(lambda: generalize(cylinder, by_points(cylinder, count)))

    assert moved.diagnostics.crossing.sum() <= upright.diagnostics.crossing.sum()


@pytest.mark.benchmark(group="register")
@pytest.mark.parametrize("count", [1, 2, 4, 14, 50])
def test_register(benchmark: Any, count: int) -> None:
    source = np.random.default_rng(0).uniform(-0.5, 0.5, (count, 3))

    spline = benchmark(register, source, source + 0.1 * np.sin(7.0 * source))

    assert spline.residual < 1e-6
