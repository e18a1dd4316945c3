"""Pulling on the line of a demonstration or a run: what it becomes, and how far the arm can go along.

The pull fades out along the line to both sides; its width can be changed while it lasts. Nothing
is kept by it: letting go makes a `Proposal`.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final

import numpy as np

from app import correcting
from app.arm.protocol import Arm
from app.document import Document, FloatArray
from app.model import Model
from app.proposal import Correction, Proposal
from app.subject import Subject, subject_of
from gc_core import soft_correction
from gc_core.arrays import evenly
from gc_core.frames import arc_length

NARROWEST: Final = 0.02
WIDEST: Final = 0.60
"""Of a pull, along the line to either side [m]."""
WIDER: Final = 1.25
"""One press of a key makes a pull wider, or narrower, by this factor."""
HALVINGS: Final = 8
"""So often is halved between what the arm reaches and what it does not."""
LOOKED_AT: Final = 40
"""Places along a line that the arm is led to when it is let go."""
OFF: Final = 0.005
"""A hand this far from where the line wants it does not follow it [m]."""


@dataclass(frozen=True, eq=False)
class Reach:
    """A line as far as the arm can go along with a pull."""

    positions: FloatArray
    """(K, 3) [m]."""
    moved: float
    """How far the place that is held was moved [m]."""
    why: str = ""
    """What keeps the arm from going further, for instance ``12 cm beyond reach``."""


@dataclass(frozen=True, eq=False)
class LinePull:
    """A line that is held at one of its places."""

    subject: Subject
    """What is corrected, as it was before."""
    path: FloatArray
    """(K, 3) the line when it was grabbed [m]; a correction that waits for its answer can be pulled again."""
    index: int
    """The sample that is held."""
    width: float
    """How far the pull reaches to either side [m of arc length]."""
    unreachable: Callable[[FloatArray], str | None]
    """Says at once why the arm cannot go along a path; see `Arm.unreachable`."""
    previewed: int = 0
    """Which choice of the correction is shown."""
    _last: dict[bytes, Reach] = field(default_factory=dict[bytes, Reach])

    @property
    def node(self) -> str:
        """Scene name of what is held."""
        return self.subject.node

    @property
    def name(self) -> str:
        """Of the undo step."""
        return f"correct {self.subject.name}"

    @cached_property
    def _free(self) -> bool:
        """Whether the line was beyond the arm's reach before it was pulled: then nothing is held back."""
        return self.unreachable(self.path) is not None

    def widened(self, width: float) -> "LinePull":
        """Let the same pull reach farther, or less far, along the line [m]."""
        return replace(self, width=float(np.clip(width, NARROWEST, WIDEST)), _last={})

    def reached(self, by: FloatArray) -> Reach:
        """Pull the line by a displacement (3,) [m], as far as the arm can go along."""
        key = by.tobytes()
        if key not in self._last:
            self._last.clear()
            self._last[key] = self._reach(by)
        return self._last[key]

    def _reach(self, by: FloatArray) -> Reach:
        pulled = soft_correction(self.path, self.index, by, self.width)
        why = self.unreachable(pulled)
        if why is None or self._free:
            return Reach(pulled, float(np.linalg.norm(by)), why or "")
        low, high = 0.0, 1.0
        for _ in range(HALVINGS):
            share = 0.5 * (low + high)
            inside = self.unreachable(self.path + share * (pulled - self.path)) is None
            low, high = (share, high) if inside else (low, share)
        return Reach(self.path + low * (pulled - self.path), low * float(np.linalg.norm(by)), why)

    def stopped(self, by: FloatArray) -> str:
        """Say what keeps the line from being pulled this far (3,) [m]; empty: nothing does."""
        why = self.reached(by).why
        return f"The arm cannot follow there: {why}. The line stays where the arm can go." if why else ""

    def correction(self, by: FloatArray) -> Correction:
        """Give the line as it was and as it is pulled."""
        return Correction(self.subject.path.positions, self.reached(by).positions, self.subject.among)

    def proposal(self, by: FloatArray) -> Proposal:
        """Say what was pulled, and offer what can be done with it."""
        made = correcting.reshaped(self.subject, self.reached(by).positions)
        return replace(made, previewed=min(self.previewed, len(made.choices) - 1))

    def apply(self, document: Document, by: FloatArray) -> Document:
        """Give the document with the choice that is shown, for this displacement (3,) [m]."""
        proposal = self.proposal(by)
        return proposal.choices[proposal.previewed].apply(document)


def take(
    node: str,
    grabbed: FloatArray,
    model: Model,
    width: float,
    *,
    unreachable: Callable[[FloatArray], str | None],
    waiting: Proposal | None = None,
) -> LinePull | None:
    """Take hold of a line.

    Parameters
    ----------
    node : str
        Scene name, for instance ``/demonstrations/1`` or ``/reproductions/0``.
    grabbed : (3,) array
        Where [m]; the nearest sample is held.
    model : Model
        What is shown.
    width : float
        How far the pull reaches to either side [m of arc length].
    unreachable : callable
        `Arm.unreachable`.
    waiting : Proposal, optional
        A correction of this very line, which is pulled further.

    Returns
    -------
    LinePull or None
        None for what is no line, or is not there any more.
    """
    subject = subject_of(node, model) if waiting is None else waiting.subject
    if subject is None:
        return None
    path = subject.path.positions if waiting is None else waiting.after
    nearest = int(np.argmin(np.linalg.norm(path - grabbed, axis=1)))
    shown = 0 if waiting is None else waiting.previewed
    return LinePull(subject, path, nearest, width, unreachable, shown)


def place_on(node: str, share: float, model: Model, waiting: Proposal | None) -> FloatArray | None:
    """Find the place after a part of the way along a line, where the line is now.

    Parameters
    ----------
    node : str
        Scene name of the line.
    share : float
        Part of the line's length before it was corrected, 0 .. 1: pulling it leaves the same sample there.
    model : Model
        What is shown.
    waiting : Proposal, optional
        A correction that waits for its answer.

    Returns
    -------
    (3,) array or None
        One of the line's samples [m]; None where there is no such line.
    """
    pulled = None if waiting is None else waiting.subject
    if waiting is not None and pulled is not None and pulled.node == node:
        return waiting.after[_sample(waiting.before, share)]
    subject = subject_of(node, model)
    return None if subject is None else subject.path.positions[_sample(subject.path.positions, share)]


def _sample(path: FloatArray, share: float) -> int:
    gone = arc_length(path)
    return int(np.argmin(np.abs(gone - np.clip(share, 0.0, 1.0) * gone[-1])))


def unfollowable(arm: Arm, proposal: Proposal) -> str:
    """Lead the arm along a corrected line; returns why that does not work, empty where it does.

    A line that the arm could not follow before either says nothing.
    """
    said = _fault(arm, proposal.after)
    return said if said and not _fault(arm, proposal.before) else ""


def _fault(arm: Arm, path: FloatArray) -> str:
    kept = evenly(len(path), LOOKED_AT)
    errors = arm.follow(path[kept]).errors
    worst = int(np.argmax(errors))
    if errors[worst] <= OFF:
        return ""
    part = 100.0 * kept[worst] / max(len(path) - 1, 1)
    return (
        f"The arm cannot follow the line: after {part:.0f} % of the way its hand stays "
        f"{100.0 * errors[worst]:.1f} cm off. Pull it less far, or elsewhere."
    )
