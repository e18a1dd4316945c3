"""From what the hand did in a replay to what can be done with it: pure functions."""

from dataclasses import replace
from typing import Final

import numpy as np
from scipy.spatial.transform import (  # pyright: ignore[reportMissingTypeStubs]  # SciPy has none
    Rotation,
    Slerp,
)

from app import bending, drawn, edits
from app.document import Document, FloatArray
from app.proposal import Choice, Proposal
from app.replaying import Corrected
from app.subject import Subject
from gc_core import Constraint, Demonstration, Reproduction
from gc_core import as_demonstration as demonstration_of

NOTHING: Final = "Nothing was corrected: the hand was not pulled during the replay."


def proposed(subject: Subject, corrected: Corrected) -> Proposal:
    """Say what was corrected, and offer what can be done with it.

    A corrected demonstration replaces its original. A corrected run becomes a rule, or a demonstration that
    joins the others.
    """
    path = subject.path
    name = path.name if isinstance(path, Demonstration) else f"Corrected {subject.name}"
    made = as_demonstration(path, corrected, name)
    return Proposal(
        title=f"Correction of {subject.name}",
        sentence=f"You moved the hand by up to {bending.length(corrected.farthest)}.",
        choices=(_replacing(subject, path, made),)
        if isinstance(path, Demonstration)
        else (_ruling(subject, path, as_run(path, corrected)), _teaching(subject, made)),
        among=subject.among,
        before=path.positions,
        after=corrected.positions,
    )


def reshaped(subject: Subject, positions: FloatArray) -> Proposal:
    """Offer what can be done with a line that was pulled; its timing stays.

    Parameters
    ----------
    subject : Subject
        What was pulled, as it was before, of K samples.
    positions : (K, 3) array
        Where its samples are now [m].

    Returns
    -------
    Proposal
        With the same choices as `proposed`.

    Raises
    ------
    GcError
        If that is no demonstration.
    """
    path = subject.path
    away = float(np.linalg.norm(positions - path.positions, axis=1).max())
    if isinstance(path, Demonstration):
        choices = (_replacing(subject, path, replace(path, positions=positions)),)
    else:
        moved = replace(path, positions=positions)
        shown = demonstration_of(moved, f"Corrected {subject.name}")
        choices = (_ruling(subject, path, moved), _teaching(subject, shown))
    return Proposal(
        title=f"Correction of {subject.name}",
        sentence=f"You pulled the line by up to {bending.length(away)}.",
        choices=choices,
        among=subject.among,
        before=path.positions,
        after=positions,
        subject=subject,
    )


def as_demonstration(path: Demonstration | Reproduction, corrected: Corrected, name: str) -> Demonstration:
    """Make a demonstration of a recording; what the hand held and how it was turned stays by its time."""
    times = corrected.times - corrected.times[0]
    index = np.clip(np.searchsorted(path.times, corrected.times, side="right") - 1, 0, len(path.times) - 1)
    return Demonstration(
        times,
        corrected.positions,
        orientations=None if path.orientations is None else _turned(path, path.orientations, corrected.times),
        gripper=None if path.gripper is None else path.gripper[index],
        name=name,
    )


def as_run(run: Reproduction, corrected: Corrected) -> Reproduction:
    """Move a run, sample by sample, by what the hand was moved at that time."""
    moved = corrected.positions - corrected.route
    at = [np.interp(run.times, corrected.times, moved[:, axis]) for axis in range(3)]
    return replace(run, positions=run.positions + np.stack(at, axis=1))


def _replacing(subject: Subject, original: Demonstration, made: Demonstration) -> Choice:
    def apply(document: Document) -> Document:
        for index, shown in enumerate(document.demonstrations):
            if shown.demonstration is original:
                return edits.replace_demonstration(document, index, made)
        return document

    return Choice(
        "Accept",
        "as corrected",
        f"This replaces {subject.name}, and the tube is learned anew. Going on accepts it, too.",
        f"correct {subject.name}",
        apply,
        implied=True,
    )


def _ruling(subject: Subject, run: Reproduction, moved: Reproduction) -> Choice:
    rule = Constraint.from_correction(run, moved)

    def apply(document: Document) -> Document:
        # A rule is kept as if nothing had been moved; landmarks carry it along.
        return edits.add_rule(document, subject.among.rule_taken_back(rule))

    return Choice(
        "Add a rule",
        "with the rule",
        "All runs keep to your side of it from now on; what was taught stays as it is.",
        f"add a rule from {subject.name}",
        apply,
        records=False,
    )


def _teaching(subject: Subject, made: Demonstration) -> Choice:
    kept = drawn.taken_back(made, subject.among)
    return Choice(
        "Teach it",
        "with it taught",
        "It joins the demonstrations, and the tube is learned anew with it.",
        f"teach the corrected {subject.name}",
        lambda document: drawn.added(document, kept),
    )


def _turned(path: Demonstration | Reproduction, orientations: FloatArray, times: FloatArray) -> FloatArray:
    """(T, 4) orientations w, x, y, z at other times, the shorter way between those that are known."""
    known = Rotation.from_quat(orientations, scalar_first=True)
    clipped = np.clip(times, path.times[0], path.times[-1])
    return Slerp(path.times, known)(clipped).as_quat(scalar_first=True)
