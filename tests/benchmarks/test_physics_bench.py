"""How long physics takes: opening a world, the clearance of a path, a playback; and a yielding replay."""

from __future__ import annotations

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.arm import FloatArray, Jaco
from app.arm.physics import World
from app.arm.physics_playback import play
from app.arm.shapes import Box, Cylinder, Ring, Shape, Sphere
from app.compliance import Pull, advance, begin
from app.route import Route
from tests.arm.physical import swing

pytest.importorskip("pybullet", reason="pybullet is not installed (the extra `physics`)")

SHAPES = [
    Sphere("sphere", (0.1, -0.45, 0.3), 0.06),
    Box("box", (-0.1, -0.4, 0.3), (0.12, 0.1, 0.2)),
    Cylinder("cylinder", (0.0, -0.5, 0.2), 0.05, 0.25),
    Ring("ring", (0.1, -0.45, 0.35), 0.1, 0.01),
]


@pytest.fixture(scope="module")
def jaco() -> Jaco:
    return Jaco()


@pytest.fixture(scope="module")
def path(jaco: Jaco) -> tuple[FloatArray, FloatArray]:
    times, places, _ = swing(200, 6.0)
    return times, jaco.follow(places, jaco.home).joints


@pytest.mark.benchmark(group="physics")
def test_opening_and_closing_a_world(benchmark: BenchmarkFixture) -> None:
    def open_and_close() -> None:
        with World(SHAPES, table=0.0):
            pass

    benchmark(open_and_close)


@pytest.mark.benchmark(group="physics")
@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.name)
def test_the_clearance_of_two_hundred_postures(
    benchmark: BenchmarkFixture, path: tuple[FloatArray, FloatArray], shape: Shape
) -> None:
    with World([shape]) as world:
        clearance = benchmark(world.clearance, path[1])

    assert np.isfinite(clearance.distances).all()


@pytest.mark.benchmark(group="physics")
def test_a_playback_of_six_seconds(benchmark: BenchmarkFixture, path: tuple[FloatArray, FloatArray]) -> None:
    with World() as world:
        played = benchmark(play, world, *path)

    assert played.errors.max() < 1e-3


@pytest.mark.benchmark(group="physics")
def test_fifty_milliseconds_of_a_yielding_replay(benchmark: BenchmarkFixture, jaco: Jaco) -> None:
    times, places, _ = swing(600, 6.0)
    replay = begin(jaco, Route(times, places), 0.0)
    replay, _ = advance(replay, jaco, (Pull(0.5, (0.0, 0.0, 0.08)),), 1.0)

    _, replayed = benchmark(advance, replay, jaco, (), 1.05)

    assert len(replayed.times) == 5
