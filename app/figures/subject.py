"""What figures are about: a skill, its tube, and where its starts and landmarks may be moved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from app.document import Document, FloatArray, SectionKind
from app.figures.errors import NothingToDrawError
from app.model import encode_as, reproduce_whole
from gc_core import Demonstration, GeneralizedCylinder, Reproduction, soft_correction
from gc_core.frames import arc_length

ASIDE: Final = 0.3
"""How far a landmark is moved where the skill does not say whereto, by the size of the motion [-]."""
PULL_WIDTH: Final = 0.3
"""How far to either side a pull reaches, by the length of the path [-]."""
OFF_CENTRE: Final = 0.7
"""Ratio at which runs begin where the skill does not say [-]."""


@dataclass(frozen=True, eq=False)
class Subject:
    """A skill, and what is learned from it once."""

    document: Document

    @cached_property
    def demonstrations(self) -> tuple[Demonstration, ...]:
        """Those that are learned from."""
        found = tuple(each.demonstration for each in self.document.demonstrations if not each.muted)
        if not found:
            raise NothingToDrawError(self.document.title, "nothing was shown. Show at least one motion.")
        return found

    @property
    def paths(self) -> list[FloatArray]:
        """Of the demonstrations, each (T, 3) [m]."""
        return [each.positions for each in self.demonstrations]

    @cached_property
    def cylinder(self) -> GeneralizedCylinder:
        """What is learned of them."""
        return encode_as(self.demonstrations, self.document.settings)

    def in_section(self, section: SectionKind) -> GeneralizedCylinder:
        """Learn with another kind of section."""
        return encode_as(self.demonstrations, replace(self.document.settings, section=section))

    @property
    def starts(self) -> FloatArray:
        """(S, 3) where runs begin: the skill's own, or one on either side of the middle line [m]."""
        return np.array(self.document.starts) if self.document.starts else self.above_and_below

    @property
    def above_and_below(self) -> FloatArray:
        """(2, 3) starts on either side of the middle line [m]."""
        rim = self.cylinder.surface()[0]
        return around(self.cylinder, OFF_CENTRE, (int(rim[:, 2].argmax()), int(rim[:, 2].argmin())))

    @property
    def ends(self) -> FloatArray:
        """(2, 3) start and goal, where they were while it was taught [m]."""
        goal = next((each.taught for each in self.document.landmarks if each.kind == "goal"), None)
        last = self.cylinder.directrix[-1] if goal is None else goal
        return np.stack([self.cylinder.directrix[0], last])

    def moved(self, kind: str, count: int) -> list[FloatArray]:
        """Places (count, 3) for the start or the goal: those that the skill names, or made up ones [m]."""
        named = [each.now for each in self.document.tries if each.kind == kind and each.now is not None]
        if len(named) >= count:
            return named[:count]
        start, goal = self.ends
        place, away = (start, start - goal) if kind == "start" else (goal, goal - start)
        size = float(np.ptp(self.cylinder.directrix, axis=0).max())
        ahead = away / max(float(np.linalg.norm(away)), 1e-9)
        level: FloatArray = np.array([ahead[1], -ahead[0], 0.0])
        if np.linalg.norm(level) < 0.1:  # straight up or down: every level direction is beside it
            level = np.array([1.0, 0.0, 0.0])
        beside = level / float(np.linalg.norm(level))
        steps: list[FloatArray] = [beside, -beside, ahead - beside, ahead + beside]
        return [place + ASIDE * size / float(np.linalg.norm(step)) * step for step in steps[:count]]


def pulled(path: FloatArray, part: float) -> FloatArray:
    """Pull a path (T, 3) softly down in its middle, by a part of its length; its ends stay [m]."""
    along = arc_length(path)
    length = float(along[-1])
    middle = int(np.searchsorted(along, 0.5 * length))
    return soft_correction(path, middle, (0.0, 0.0, -part * length), PULL_WIDTH * length)


def around(cylinder: GeneralizedCylinder, ratio: float, corners: Sequence[int] | slice) -> FloatArray:
    """Places (S, 3) in the first slice of a tube at a ratio, towards corners of its boundary [m]."""
    centre = cylinder.directrix[0]
    return centre + ratio * (cylinder.surface()[0, corners] - centre)


def runs(cylinder: GeneralizedCylinder, starts: FloatArray) -> list[Reproduction]:
    """Run a skill from starts (S, 3), each from beginning to end."""
    return [reproduce_whole(cylinder, start) for start in starts]
