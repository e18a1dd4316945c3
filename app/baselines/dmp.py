"""Dynamical movement primitives: a spring pulls to the goal, a learned force shapes the way.

The force is learned from the mean demonstration; the primitives are those of `movement_primitives`.

References
----------
.. [1] A. J. Ijspeert, J. Nakanishi, H. Hoffmann, P. Pastor, S. Schaal. Dynamical Movement Primitives:
   Learning Attractor Models for Motor Behaviors. Neural Computation 25(2), 2013. doi:10.1162/NECO_a_00393
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from app.baselines.protocol import (
    CannotLearnError,
    CannotReproduceError,
    Run,
    Taught,
    failing_as,
    finite_run,
    package,
    taught,
)
from app.document import Alignment, FloatArray
from gc_core import Demonstration


@dataclass(frozen=True)
class Primitive:
    """A dynamical movement primitive."""

    weights: int = 10
    """For each axis, at least 2."""
    align_by: Alignment = "arc_length"

    @property
    def name(self) -> str:
        """How it is called in tables."""
        return f"dmp-{self.weights}"

    def ready(self) -> None:
        """Import `movement_primitives`; see `Method.ready`."""
        package(self.name, "movement_primitives.dmp")

    def fit(self, demonstrations: Sequence[Demonstration]) -> PrimitiveSkill:
        """Learn the force along the mean demonstration; see `Method.fit`."""
        shown = taught(demonstrations, self.align_by)
        with failing_as(CannotLearnError, self.name):
            primitive = _primitive(self.name, self.weights, shown)
            primitive.imitate(shown.phase, shown.mean)
            learned = np.array(primitive.get_weights(), dtype=np.float64)
        return PrimitiveSkill(self, shown, learned)


@dataclass(frozen=True, eq=False)
class PrimitiveSkill:
    """A force that was learned."""

    method: Primitive
    taught: Taught
    weights: FloatArray
    """(3 w,) of the basis functions, axis by axis."""

    def reproduce(self, start: FloatArray, goal: FloatArray | None = None) -> Run:
        """Integrate the primitive from the start, at rest, to the goal."""
        name, shown = self.method.name, self.taught
        end = shown.mean[-1] if goal is None else goal
        with failing_as(CannotReproduceError, name):
            primitive = _primitive(name, self.method.weights, shown)
            primitive.set_weights(self.weights)
            primitive.configure(start_y=np.array(start), goal_y=np.array(end))
            _, path = primitive.open_loop()
        # A rounded step more or less: the grid is the taught one.
        return finite_run(name, shown.times, np.asarray(path, dtype=np.float64)[: len(shown.times)])


def _primitive(name: str, weights: int, shown: Taught) -> Any:
    """Make a primitive of duration 1: its equations do not depend on the unit of time."""
    return package(name, "movement_primitives.dmp").DMP(
        n_dims=3, execution_time=1.0, dt=1.0 / (len(shown.times) - 1), n_weights_per_dim=weights
    )
