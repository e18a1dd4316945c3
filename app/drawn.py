"""What a led hand has drawn, and how it is kept: as a demonstration, where the landmarks stood at first."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app import edits
from app.document import Document, FloatArray
from app.model import Model
from gc_core import Demonstration, GeneralizedCylinder, reproduce
from gc_core.turns import turned

LOST: Final = 0.001
"""A sample that misses its way back by more than this has none [m]."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """A demonstration as far as it was recorded."""

    times: FloatArray
    """(T,) from 0 [s]."""
    positions: FloatArray
    """(T, 3) [m]."""
    gripper: FloatArray
    """(T,) 0 open .. 1 closed."""
    orientations: FloatArray | None = None
    """(T, 4) of the tool, w x y z; None unless it was held all the time."""

    @property
    def length(self) -> float:
        """Way of the hand [m]."""
        return float(np.sum(np.linalg.norm(np.diff(self.positions, axis=0), axis=1)))


def demonstration(drawn: Drawn) -> Demonstration:
    """Make a demonstration of what was recorded."""
    return Demonstration(drawn.times, drawn.positions, drawn.orientations, drawn.gripper)


@dataclass(frozen=True, eq=False)
class TakenBack:
    """A demonstration as it is kept: where the landmarks stood when the skill was taught."""

    demonstration: Demonstration
    carried: bool = False
    """Landmarks were moved, so that it is not where it was drawn."""
    muted: bool = False
    """There is no way back from where it was drawn, so that nothing can be learned from it."""


def taken_back(shown: Demonstration, among: Model) -> TakenBack:
    """Undo what moved landmarks do to a demonstration that is shown among them.

    The tube, bent as they bend it, then holds it where it was drawn. Where the map folds there is no such
    place; the demonstration is kept as it was drawn.
    """
    if among.registration is None:
        return TakenBack(shown)
    places, misses = among.taken_back(shown.positions)
    if misses.max() > LOST:
        return TakenBack(shown, muted=True)
    orientations = shown.orientations
    if orientations is not None:
        orientations = turned(orientations, _inverse(among.registration.jacobian(places)))
    return TakenBack(replace(shown, positions=places, orientations=orientations), carried=True)


def _inverse(jacobian: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.inv(jacobian), dtype=np.float64)


def added(document: Document, shown: TakenBack, instead_of: Demonstration | None = None) -> Document:
    """Add a demonstration as it is kept, or put it, learned from, in the place and name of another."""
    for index, former in enumerate(document.demonstrations):
        if former.demonstration is instead_of:
            made = replace(shown.demonstration, name=former.demonstration.name)
            document = edits.replace_demonstration(document, index, made)
            return edits.mute_demonstration(document, index, shown.muted)
    document = edits.add_demonstrations(document, [shown.demonstration])
    return edits.mute_demonstration(document, len(document.demonstrations) - 1, shown.muted)


def continued(part: Demonstration, cylinder: GeneralizedCylinder, station: int) -> Demonstration:
    """Continue a drawn part to the end of the cylinder by the ratio rule from a station on."""
    if station >= len(cylinder.directrix) - 2:
        return part
    rest = reproduce(cylinder, part.positions[-1], at=station, outside="boundary")
    times = part.times[-1] + rest.times[1:] - rest.times[0]
    return Demonstration(
        np.concatenate([part.times, times]), np.concatenate([part.positions, rest.positions[1:]])
    )
