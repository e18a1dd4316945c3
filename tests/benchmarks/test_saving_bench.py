"""What saving after a gesture costs the thread of a session; a worker does the rest."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.actor import Actor
from app.arm import PlanarArm
from app.desk import Desk
from app.document import Document, Shown
from app.edits import replace_demonstration
from app.keeping import Keeper
from app.library import Library
from tests.app.makers import demonstration, taught

MOST = 0.005
"""[s]."""


def corrected(document: Document, seed: int) -> Document:
    """Shake one demonstration of the five."""
    former = document.demonstrations[seed % 5].demonstration
    shaken = former.positions + np.random.default_rng(seed).normal(0.0, 1e-4, former.positions.shape)
    return replace_demonstration(document, seed % 5, replace(former, positions=shaken))


@pytest.mark.benchmark(group="saving")
def test_a_save_after_a_gesture_costs_the_session_little(benchmark: BenchmarkFixture, tmp_path: Path) -> None:
    skill = replace(taught(), demonstrations=tuple(Shown(demonstration(i, 1500)) for i in range(5)))
    desk, library = Desk(skill, PlanarArm()), Library(f"sqlite:///{tmp_path / 'library.db'}")
    workers = ThreadPoolExecutor(2)
    actor = Actor(tick=lambda: False, draw=lambda: None, report=lambda _: None, name="saving")
    keeper = Keeper("code", desk, library, (workers, actor), clock=lambda: 0.0, on_saved=lambda: None)
    seeds = iter(range(10**6))

    def gesture() -> tuple[tuple[frozenset[str]], dict[str, object]]:
        desk.edit(lambda d: corrected(d, next(seeds)), "correct", now=0.0)
        desk.state()
        return (frozenset(),), {}

    benchmark.pedantic(keeper.follow, setup=gesture, rounds=60)

    assert benchmark.stats.stats.median < MOST
    actor.close()
    workers.shutdown()
    library.close()
