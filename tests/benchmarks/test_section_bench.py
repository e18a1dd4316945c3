"""The closed spline of all stations at once, beside a plain implementation station by station."""

from __future__ import annotations

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from gc_core import encode
from gc_core.arrays import FloatArray
from gc_core.sections import SECTIONS
from tests.benchmarks import plain
from tests.core.shapes import bundle

ANGLES = 64
THINNEST = 1e-6
"""So thin that no section of these is thickened [m]."""
GROUP = "closed splines of 200 stations x 64 angles"


@pytest.fixture(scope="module")
def points() -> FloatArray:
    """(200, 5, 2) effective points of five demonstrations in their planes [m]."""
    cylinder = encode(bundle(0, 5, 1500), angles=ANGLES)
    return ((cylinder.effective_points - cylinder.directrix[:, None]) @ cylinder.frames)[..., 1:]


@pytest.mark.benchmark(group=GROUP)
def test_all_stations_at_once(benchmark: BenchmarkFixture, points: FloatArray) -> None:
    benchmark(SECTIONS["closed_spline"], points, ANGLES, THINNEST)


@pytest.mark.benchmark(group=GROUP)
def test_plain_scipy_station_by_station(benchmark: BenchmarkFixture, points: FloatArray) -> None:
    benchmark(plain.closed_spline, points, ANGLES)


def test_both_make_the_same_sections(points: FloatArray) -> None:
    """But where a corner is so flat that only the exact hull has it."""
    ours = SECTIONS["closed_spline"](points, ANGLES, THINNEST)
    same = np.isclose(ours, plain.closed_spline(points, ANGLES), rtol=1e-6).all(axis=1)

    assert same.mean() >= 0.95
