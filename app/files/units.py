"""Units and frames of files: what they probably are, and the way into the arm's own.

The app works in metres in the arm's base frame. A file rarely says which unit it
is in and never whose frame, so both are guessed, with the reason, and shown.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias

import numpy as np

from app.document import FloatArray
from app.files.recording import Unit
from gc_core import Demonstration

Frame: TypeAlias = Literal["as recorded", "moved in front of the arm"]

METRES: Final[Mapping[Unit, float]] = {"m": 1.0, "cm": 0.01, "mm": 0.001}
FRAMES: Final[tuple[Frame, ...]] = ("as recorded", "moved in front of the arm")
IN_FRONT: Final = (0.0, -0.45, 0.35)
"""Where the middle of a set is put that comes from another robot [m]."""

_LONGEST_M: Final = 4.0
_LONGEST_CM: Final = 200.0
_SHOULDER: Final = np.array([0.0, 0.0, 0.2755])
_REACH: Final = (0.25, 0.96)
_LOWEST: Final = -0.02


@dataclass(frozen=True)
class UnitGuess:
    """A unit and the reason, as a sentence."""

    unit: Unit
    reason: str


@dataclass(frozen=True)
class FrameGuess:
    """A frame and the reason, as a sentence."""

    frame: Frame
    reason: str


def guess_unit(size: FloatArray, stated: Unit | None) -> UnitGuess:
    """Guess the unit from how far the motions reach.

    Parameters
    ----------
    size : (3,) array
        Extent of all demonstrations along x, y and z, in the file's unit.
    stated : "m", "cm", "mm" or None
        What the file's format fixes.
    """
    longest = float(np.linalg.norm(size))
    if stated is not None:
        return UnitGuess(stated, f"Files of this kind are in {_WORDS[stated]}.")
    unit: Unit = "m" if longest <= _LONGEST_M else "cm" if longest <= _LONGEST_CM else "mm"
    return UnitGuess(
        unit,
        f"The motion spans {longest:.3g}, and an arm's motion is a few centimetres to "
        f"two metres long: taken as {_WORDS[unit]}.",
    )


def guess_frame(demonstrations: Sequence[Demonstration]) -> FrameGuess:
    """Guess whether demonstrations [m] were recorded in the frame of an arm like ours."""
    points = np.concatenate([d.positions for d in demonstrations])
    distance = np.linalg.norm(points - _SHOULDER, axis=1)
    inside = (distance >= _REACH[0]) & (distance <= _REACH[1]) & (points[:, 2] >= _LOWEST)
    share = np.count_nonzero(inside) / len(points)
    if share >= 0.95:
        return FrameGuess("as recorded", "The arm can reach the motion where it was recorded.")
    return FrameGuess(
        "moved in front of the arm",
        f"Only {100.0 * share:.0f} % of it is within the arm's reach where it was recorded, "
        "so it probably comes from another robot's frame.",
    )


def converted(demonstrations: Sequence[Demonstration], unit: Unit, frame: Frame) -> list[Demonstration]:
    """Bring demonstrations from a file's unit into metres, and into the wanted frame.

    "moved in front of the arm" is one translation for all of them: the middle of
    their common bounding box goes to ``IN_FRONT``; nothing is turned.
    """
    scale = METRES[unit]
    offset = np.zeros(3)
    if frame == "moved in front of the arm":
        low, high = bounds(demonstrations)
        offset = np.array(IN_FRONT) - 0.5 * (low + high) * scale
    if scale == 1.0 and frame == "as recorded":
        return list(demonstrations)
    return [replace(d, positions=d.positions * scale + offset) for d in demonstrations]


def bounds(demonstrations: Sequence[Demonstration]) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest x, y, z of all demonstrations, each (3,)."""
    low = np.min([d.positions.min(axis=0) for d in demonstrations], axis=0)
    high = np.max([d.positions.max(axis=0) for d in demonstrations], axis=0)
    return low, high


_WORDS: Final[Mapping[Unit, str]] = {"m": "metres", "cm": "centimetres", "mm": "millimetres"}
