"""How long methods take: learning by the quickest of a few times, runs by all of them."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from importlib import import_module
from time import perf_counter
from typing import Any, Final

from app.baselines import Method, Run, Skill
from app.document import FloatArray
from gc_core import Demonstration

REPEATS: Final = 3
"""Fits that are timed at most; the quickest counts."""
ENOUGH: Final = 0.2
"""No fit is repeated once this was spent [s]."""


@dataclass(frozen=True, eq=False)
class Timed:
    """What a method did, and how long it took."""

    runs: tuple[Run, ...]
    """One a start."""
    fit_ms: float
    """Learning [ms]."""
    reproduce_ms: float
    """One run [ms]."""


def timed(
    method: Method, demonstrations: Sequence[Demonstration], starts: FloatArray, repeats: int = REPEATS
) -> Timed:
    """Learn and run from all starts, with linear algebra on one thread.

    Parameters
    ----------
    method : Method
        Its packages are imported before the clock starts.
    demonstrations : sequence of Demonstration
    starts : (S, 3) array
        [m].
    repeats : int
        Fits at most, at least 1.

    Raises
    ------
    BaselineError
        If the method fails.
    """
    method.ready()
    with one_thread():
        skill, quickest = fitted(method, demonstrations)
        spent = quickest
        for _ in range(repeats - 1):
            if spent > ENOUGH:
                break
            skill, seconds = fitted(method, demonstrations)
            quickest, spent = min(quickest, seconds), spent + seconds
        began = perf_counter()
        runs = tuple(skill.reproduce(start) for start in starts)
        return Timed(runs, 1000.0 * quickest, 1000.0 * (perf_counter() - began) / len(starts))


def fitted(method: Method, demonstrations: Sequence[Demonstration]) -> tuple[Skill, float]:
    """Fit once, and say how long it took [s]."""
    # Copies, since what was computed of a demonstration before would be remembered with it.
    fresh = [replace(each) for each in demonstrations]
    began = perf_counter()
    skill = method.fit(fresh)
    return skill, perf_counter() - began


def one_thread() -> AbstractContextManager[object]:
    """Keep linear algebra to one thread: small matrices are shared out at a multiple of their cost."""
    try:
        limit: Any = import_module("threadpoolctl").threadpool_limits
    except ImportError:
        return nullcontext()
    return limit(1)
