"""Learning and five runs of the tube beside each peer's, in one run: a ratio, whatever the machine."""

from __future__ import annotations

from typing import Any

import pytest

from app.baselines import methods
from app.clocking import Timed, timed
from app.comparison import starts_in, task_of
from app.resources import static_folder
from app.skills import load_skill
from tests.baselines.makers import needs_gmr, needs_primitives

STARTS = 5


def spent(done: Timed) -> float:
    """Learning and all runs [ms]."""
    return done.fit_ms + STARTS * done.reproduce_ms


@needs_gmr
@needs_primitives
@pytest.mark.benchmark(group="compare")
@pytest.mark.parametrize("peer", ["dmp-5", "dmp-10", "promp-5", "promp-10", "gmr-5", "gmr-10"])
@pytest.mark.parametrize("skill", ["reaching", "around_an_obstacle"])
def test_learning_and_five_runs_take_the_tube_less_time_than_a_peer(
    benchmark: Any, skill: str, peer: str
) -> None:
    task = task_of(load_skill(static_folder() / "skills", skill))
    starts = starts_in(task.tube.fit(task.demonstrations).cylinder, STARTS)
    tube, other = methods(["gc", peer], task.tube)

    def ratio() -> float:
        own, its = (timed(method, task.demonstrations, starts) for method in (tube, other))
        return spent(its) / spent(own)

    ratios = [ratio() for _ in range(5)]
    benchmark.extra_info["ratio"] = sorted(ratios)[2]
    benchmark.pedantic(timed, (tube, task.demonstrations, starts, 1), rounds=5)

    assert sorted(ratios)[2] > 1.0
