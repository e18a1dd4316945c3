"""A run in a physical world: under way, or what happened."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import (  # pyright: ignore[reportMissingTypeStubs]  # SciPy has none
    Rotation,
)

from app.arm.physics_report import Playback
from app.arm.protocol import FloatArray
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
    """The run, or what is around, has changed since."""

    def holds(self, model: Model) -> bool:
        """Whether a model has the same run among the same things, whatever else was changed."""
        if model is self.source:
            return True
        return (
            self.run < len(model.runs)
            and model.runs[self.run].reproduction is self.source.runs[self.run].reproduction
            and model.source.things is self.source.source.things
            and model.source.landmarks is self.source.source.landmarks
        )

    def moved(self, things: tuple[Shape, ...]) -> tuple[Shape, ...]:
        """Give things where physics put them at the time that is shown; the same where none is."""
        if self.time is None or self.played is None or not self.played.objects:
            return things
        at = self.index()
        return tuple(_put(thing, self.played.objects, at) for thing in things)

    def index(self) -> int:
        """Which step of `played` is shown."""
        assert self.played is not None
        at = np.searchsorted(self.played.times, self.time or 0.0, side="right") - 1
        return int(np.clip(at, 0, len(self.played.times) - 1))


def _put(thing: Shape, poses: Mapping[str, FloatArray], at: int) -> Shape:
    if thing.name not in poses:
        return thing
    pose = poses[thing.name][at]
    x, y, z = pose[:3, 3].tolist()
    turn = Rotation.from_matrix(pose[:3, :3]).as_quat(scalar_first=True).tolist()
    return replace(thing, position=(x, y, z), wxyz=(turn[0], turn[1], turn[2], turn[3]))
