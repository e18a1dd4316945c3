"""What an arm heeds besides its target: obstacles around it, and how its tool is held."""

from __future__ import annotations

import math
from dataclasses import dataclass

from app.arm.errors import ArmInputError
from app.arm.shapes import Quadruple, Shape


@dataclass(frozen=True)
class Conditions:
    """Given to an arm by `Arm.under`; equal conditions are the same."""

    obstacles: tuple[Shape, ...] = ()
    """Bodies that the whole arm keeps off."""
    orientation: Quadruple | None = None
    """The tool is locked to this, w x y z, any length but zero; None: it is free and rather points down."""

    def __post_init__(self) -> None:
        if self.orientation is None:
            return
        length = math.hypot(*self.orientation)
        if len(self.orientation) != 4 or not (math.isfinite(length) and length > 0.0):
            raise ArmInputError("an orientation", "w, x, y and z, not all zero", self.orientation)


FREE = Conditions()
"""No obstacles; the tool turns as it likes."""
