"""The generalized cylinder behind the same protocol as the methods it is compared with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.baselines.protocol import Run
from app.document import Alignment, FloatArray, Settings
from gc_core import Demonstration, GeneralizedCylinder, encode, generalize, register, reproduce


@dataclass(frozen=True)
class Tube:
    """The generalized cylinder with its settings."""

    section: str = Settings().section
    align_by: Alignment = Settings().align_by
    stations: int = Settings().stations

    @property
    def name(self) -> str:
        """How it is called in tables."""
        return "gc"

    def ready(self) -> None:
        """Need nothing."""

    def fit(self, demonstrations: Sequence[Demonstration]) -> TubeSkill:
        """Encode; see `Method.fit`."""
        cylinder = encode(
            demonstrations, section=self.section, stations=self.stations, align_by=self.align_by
        )
        return TubeSkill(cylinder)


@dataclass(frozen=True, eq=False)
class TubeSkill:
    """A cylinder to run through."""

    cylinder: GeneralizedCylinder

    def reproduce(self, start: FloatArray, goal: FloatArray | None = None) -> Run:
        """Apply the ratio rule; to another goal, through the cylinder bent to it."""
        cylinder = self.cylinder
        if goal is not None:
            ends = cylinder.directrix[[0, -1]]
            cylinder = generalize(cylinder, register(ends, np.stack([ends[0], goal])))
        run = reproduce(cylinder, start)
        return Run(run.times, run.positions)
