"""The mean of the demonstrations, bent to its ends by a linear ramp: the least that a method must beat."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.baselines.protocol import Run, Taught, finite_run, taught
from app.document import Alignment, FloatArray
from gc_core import Demonstration


@dataclass(frozen=True)
class Ramp:
    """The mean with a linear ramp."""

    align_by: Alignment = "arc_length"

    @property
    def name(self) -> str:
        """How it is called in tables."""
        return "ramp"

    def ready(self) -> None:
        """Need nothing."""

    def fit(self, demonstrations: Sequence[Demonstration]) -> Ramped:
        """Take the mean; see `Method.fit`."""
        return Ramped(taught(demonstrations, self.align_by))


@dataclass(frozen=True, eq=False)
class Ramped:
    """A mean to bend."""

    taught: Taught

    def reproduce(self, start: FloatArray, goal: FloatArray | None = None) -> Run:
        """Add to the mean what its ends are off, the start's share falling and the goal's rising linearly."""
        mean, phase = self.taught.mean, self.taught.phase[:, None]
        end = mean[-1] if goal is None else goal
        path = mean + (1.0 - phase) * (start - mean[0]) + phase * (end - mean[-1])
        return finite_run("ramp", self.taught.times, path)
