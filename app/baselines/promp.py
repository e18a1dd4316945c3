"""Probabilistic movement primitives: a Gaussian over motions, conditioned on where they start and end.

The primitives are those of the package `movement_primitives`.

References
----------
.. [1] A. Paraschos, C. Daniel, J. Peters, G. Neumann. Probabilistic Movement Primitives. NIPS 2013.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from app.baselines.protocol import (
    CannotLearnError,
    CannotReproduceError,
    Run,
    failing_as,
    finite_run,
    package,
    taught,
)
from app.document import Alignment, FloatArray
from gc_core import Demonstration

EXACTNESS: Final = 1e-4
"""Standard deviation with which a start or a goal is met [m]; a mean cannot be moved where nothing varied."""


@dataclass(frozen=True)
class Distribution:
    """A probabilistic movement primitive."""

    weights: int = 10
    """For each axis."""
    align_by: Alignment = "arc_length"

    @property
    def name(self) -> str:
        """How it is called in tables."""
        return f"promp-{self.weights}"

    def ready(self) -> None:
        """Import `movement_primitives`; see `Method.ready`."""
        package(self.name, "movement_primitives.promp")

    def fit(self, demonstrations: Sequence[Demonstration]) -> DistributionSkill:
        """Learn mean and covariance of the weights; see `Method.fit`."""
        shown = taught(demonstrations, self.align_by)
        with failing_as(CannotLearnError, self.name):
            learned = package(self.name, "movement_primitives.promp").ProMP(3, self.weights)
            learned.imitate(np.tile(shown.phase, (len(shown.paths), 1)), shown.paths)
        if not np.isfinite(learned.weight_cov).all():
            raise CannotLearnError(self.name, "the covariance of its weights is no number")
        return DistributionSkill(self.name, shown.times, learned)


@dataclass(frozen=True, eq=False)
class DistributionSkill:
    """A distribution over motions."""

    name: str
    times: FloatArray
    """(K,) [s]."""
    learned: Any
    """The library's primitive."""

    def reproduce(self, start: FloatArray, goal: FloatArray | None = None) -> Run:
        """Give the mean motion among those that begin at the start, and end at the goal when one is given."""
        phase = self.times / self.times[-1]
        exact = EXACTNESS**2 * np.eye(3)
        with failing_as(CannotReproduceError, self.name):
            motions = self.learned.condition_position(start, y_cov=exact, t=0.0)
            if goal is not None:
                motions = motions.condition_position(goal, y_cov=exact, t=1.0)
            path = np.asarray(motions.mean_trajectory(phase), dtype=np.float64)
        return finite_run(self.name, self.times, path)
