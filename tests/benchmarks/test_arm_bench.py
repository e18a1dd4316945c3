"""How long the arm takes: a drag update, a path, opening one more arm."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.arm import Conditions, FloatArray, Jaco
from app.arm.shapes import Box, Ring
from app.arm.timing import retime
from app.servo import advance, begin


@pytest.fixture(scope="module")
def jaco() -> Jaco:
    return Jaco()


def loop(jaco: Jaco, n_points: int) -> FloatArray:
    angle = np.linspace(0.0, 2.0 * math.pi, n_points)
    offsets = [0.15 * np.sin(angle), 0.1 * np.cos(angle) - 0.1, 0.1 * np.sin(2.0 * angle)]
    return jaco.tool_pose(jaco.home)[:3, 3] + np.stack(offsets, axis=1)


@pytest.mark.benchmark(group="arm")
def test_a_drag_update_of_fifty_milliseconds(benchmark: BenchmarkFixture, jaco: Jaco) -> None:
    path = loop(jaco, 30)
    events = np.column_stack([1.0 + 0.05 * np.arange(30), path])
    servo, _ = advance(begin(jaco, jaco.home, 1.0), jaco, events, 1.7)

    _, motion = benchmark(advance, servo, jaco, np.empty((0, 4)), 1.75)

    assert len(motion.times) == 5


@pytest.mark.benchmark(group="arm")
@pytest.mark.parametrize("n_points", [200, 500])
def test_a_path(benchmark: BenchmarkFixture, jaco: Jaco, n_points: int) -> None:
    path = benchmark(jaco.follow, loop(jaco, n_points))

    assert path.errors.max() < 1e-3


@pytest.mark.benchmark(group="arm")
def test_the_poses_of_all_links(benchmark: BenchmarkFixture, jaco: Jaco) -> None:
    poses = benchmark(jaco.link_poses, jaco.home, 0.5)

    assert len(poses) == 11


@pytest.mark.benchmark(group="arm")
def test_one_more_arm(benchmark: BenchmarkFixture) -> None:
    def open_and_close() -> None:
        Jaco().close()

    benchmark(open_and_close)


@pytest.mark.benchmark(group="arm")
@pytest.mark.parametrize("around", ["nothing", "box", "ring"])
def test_a_drag_tick(benchmark: BenchmarkFixture, jaco: Jaco, around: str) -> None:
    """With self-collision avoidance the issue allows 1 ms in the median."""
    shapes = {
        "nothing": (),
        "box": (Box("box", (0.0, -0.5, 0.1), (0.12, 0.12, 0.2)),),
        "ring": (Ring("ring", (0.2, -0.4, 0.3), 0.1, 0.015),),
    }
    arm = jaco.under(Conditions(shapes[around]))
    begin_at = jaco.tool_pose(jaco.home)[:3, 3]
    joints = [jaco.home]
    for tick in range(200):
        joints.append(arm.step(joints[-1], begin_at + np.array([0.003 * tick, 0.0, 0.1]), 0.01))
    ticks = iter(range(10**9))

    def step() -> None:
        tick = next(ticks) % 200
        arm.step(joints[tick], begin_at + np.array([0.003 * tick, 0.0, 0.1]), 0.01)

    benchmark(step)

    if benchmark.stats and around == "nothing":
        assert benchmark.stats.stats.median < 1e-3


@pytest.mark.benchmark(group="arm")
def test_timing_a_path(benchmark: BenchmarkFixture, jaco: Jaco) -> None:
    joints = jaco.follow(loop(jaco, 500)).joints

    timed = benchmark(retime, joints, jaco.velocity_limits, jaco.acceleration_limits)

    assert timed.duration > 1.0
