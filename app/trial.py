"""A run in a physical world: under way, or what happened."""

from dataclasses import dataclass

import numpy as np

from app.arm.physics_report import Playback
from app.arm.shapes import Shape
from app.model import Model


@dataclass(frozen=True, eq=False)
class Trial:
    """What physics makes of a run."""

    source: Model
    run: int
    """Which run of that model."""
    share: float = 0.0
    """How much of it is computed; 1: it is done."""
    said: tuple[str, ...] = ()
    """What happened, in sentences."""
    played: Playback | None = None
    """None: not computed yet, or it could not be."""
    things: tuple[Shape, ...] = ()
    """What could be pushed and carried."""
    time: float | None = None
    """What happened is shown at this time of `played`; None: it is not shown [s]."""
    stale: bool = False
    """The skill has changed since."""

    def index(self) -> int:
        """Which step of `played` is shown."""
        assert self.played is not None
        at = np.searchsorted(self.played.times, self.time or 0.0, side="right") - 1
        return int(np.clip(at, 0, len(self.played.times) - 1))
