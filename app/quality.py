"""What may be wrong with a demonstration, in words, and what would mend it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, Literal, TypeAlias

import numpy as np

from app.document import FloatArray
from app.mending import Pause, pauses, smoothed, tremble, trimmed
from gc_core import Demonstration, GeneralizedCylinder

Fix: TypeAlias = Literal["trim", "smooth", "redo"]
Fault: TypeAlias = Literal["pause", "shaky", "outlier", "joint_limit"]

SHAKY: Final = 3.0
"""A demonstration is shaky when it is this many times as jerky as the others [-]."""
APART: Final = 2.0
"""One is apart when the nearest other is this many times as far as these usually are from each other [-]."""
FAR: Final = 0.02
"""... and at least so far [m]."""
MARGIN: Final = np.radians(5.0)
"""A joint this near to its limit has hardly any way left [rad]."""


@dataclass(frozen=True, eq=False)
class Postures:
    """What is known of the arm along demonstrations."""

    lower: FloatArray
    """(J,) limits of the joints [rad]."""
    upper: FloatArray
    """(J,) [rad]."""
    joints: Mapping[Demonstration, FloatArray] = field(default_factory=dict[Demonstration, FloatArray])
    """(T, J) at the samples of each [rad]."""


@dataclass(frozen=True)
class Note:
    """One thing that may be wrong with one demonstration."""

    index: int
    """Which demonstration."""
    fault: Fault
    fix: Fix
    """``trim`` and ``smooth`` are made by `mended`; ``redo``: show it again."""
    sentence: str
    """What, where, and what to do."""
    at: float | None = None
    """When, since the demonstration began, where it is one moment [s]."""


def notes(
    demonstrations: Sequence[Demonstration],
    cylinder: GeneralizedCylinder | None = None,
    postures: Postures | None = None,
) -> tuple[Note, ...]:
    """Look for what may be wrong with demonstrations.

    Parameters
    ----------
    demonstrations : sequence of n Demonstration
        Those that are learned from.
    cylinder : GeneralizedCylinder, optional
        What was learned from them, for how far they are from each other.
    postures : Postures, optional
        How the arm holds itself along them, as far as that is known.

    Returns
    -------
    tuple of Note
        By demonstration; several for one are in the order in which mending helps.
    """
    found = [_pause(index, shown) for index, shown in enumerate(demonstrations)]
    found += _shaky(demonstrations)
    if cylinder is not None:
        found += _apart(demonstrations, cylinder)
    if postures is not None:
        found += [
            _at_its_limit(index, shown, postures.joints[shown], postures)
            for index, shown in enumerate(demonstrations)
            if shown in postures.joints
        ]
    return tuple(sorted((note for note in found if note is not None), key=lambda note: note.index))


def mended(demonstration: Demonstration, fix: Fix) -> Demonstration:
    """Apply a fix; the same object where it changes nothing, as when it must be shown again."""
    if fix == "trim":
        return trimmed(demonstration)
    return smoothed(demonstration) if fix == "smooth" else demonstration


def _called(index: int, demonstration: Demonstration) -> str:
    return demonstration.name or f"Demonstration {index + 1}"


def _pause(index: int, shown: Demonstration) -> Note | None:
    """The longest pause of a demonstration."""
    found = pauses(shown)
    if not found:
        return None
    longest = max(found, key=lambda pause: pause.seconds)
    sentence = (
        f"{_called(index, shown)} stands still for {longest.seconds:.1f} s {_when(longest)}. Cut that out: "
        "the path stays as it is."
    )
    return Note(index, "pause", "trim", sentence, longest.begins)


def _when(pause: Pause) -> str:
    if pause.where == "middle":
        return f"after {pause.begins:.1f} s"
    return f"at its {pause.where}"


def _shaky(demonstrations: Sequence[Demonstration]) -> list[Note | None]:
    """Demonstrations that are much jerkier than the others."""
    if len(demonstrations) < 2:
        return []
    jerky = np.array([tremble(shown) for shown in demonstrations])
    found: list[Note | None] = []
    for index, shown in enumerate(demonstrations):
        others = float(np.median(np.delete(jerky, index)))
        times = jerky[index] / max(others, 1e-9)
        if times > SHAKY:
            sentence = f"{_called(index, shown)} trembles {times:.0f} times as much as the others. Smooth it."
            found.append(Note(index, "shaky", "smooth", sentence))
    return found


def _apart(demonstrations: Sequence[Demonstration], cylinder: GeneralizedCylinder) -> list[Note | None]:
    """Demonstrations that are much further from the others than these are from each other."""
    paths = cylinder.aligned
    count = len(paths)
    if count < 3 or count != len(demonstrations):
        return []
    apart = np.asarray(np.linalg.norm(paths[:, None] - paths[None], axis=3), dtype=np.float64)
    found: list[Note | None] = []
    for index, shown in enumerate(demonstrations):
        others = [other for other in range(count) if other != index]
        away = apart[index, others].min(axis=0)
        among = [float(apart[a, b].mean()) for a in others for b in others if a < b]
        mean, usual = float(away.mean()), float(np.median(among))
        if mean > max(APART * usual, FAR):
            worst = int(np.argmax(away))
            far, part = 100.0 * away[worst], 100.0 * worst / (paths.shape[1] - 1)
            sentence = (
                f"{_called(index, shown)} goes another way than the others: {far:.0f} cm from the nearest of "
                f"them after {part:.0f} % of the way. Show it again, or mute it."
            )
            found.append(Note(index, "outlier", "redo", sentence))
    return found


def _at_its_limit(index: int, shown: Demonstration, joints: FloatArray, postures: Postures) -> Note | None:
    """The joint that comes nearest to its limit, where that is too near."""
    margins = np.minimum(joints - postures.lower, postures.upper - joints)
    sample, joint = np.unravel_index(int(np.argmin(margins)), margins.shape)
    left = float(margins[sample, joint])
    if left >= MARGIN:
        return None
    moment = float(shown.times[min(int(sample), len(shown.times) - 1)] - shown.times[0])
    how = f"within {np.degrees(left):.0f}° of its limit" if left > np.radians(0.5) else "to its limit"
    sentence = (
        f"{_called(index, shown)} brings joint {int(joint) + 1} {how} after {moment:.1f} s. Show it again, "
        "there a little nearer to the arm."
    )
    return Note(index, "joint_limit", "redo", sentence, moment)
