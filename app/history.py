"""What a skill was before: one version an undo step, and which of them is the present one.

A `History` never changes, as a `Document` never does; saving compares two of them by
the stamps of their versions.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Final

from app.document import Document, Shown

DEEPEST: Final = 300
"""Undo steps that are kept."""
DELETE: Final = "delete "
"""So begins the name of every edit that deletes a demonstration."""
BEGIN: Final = "begin "
"""So begins the name of every version in which a skill was opened that shows nothing yet."""


@dataclass(frozen=True, eq=False)
class Version:
    """A document that was the present one, and the edit that made it."""

    stamp: int
    """When it was made [us since 1970, UTC], and its name: no two versions of a skill share one."""
    name: str
    """Of the edit, for instance ``move goal``; empty for the first version."""
    source: Document | Callable[[], Document]
    """The document, or how it is read when it is asked for the first time."""

    @cached_property
    def document(self) -> Document:
        """The skill as it was; what cannot be read raises a `GcError` that says so."""
        return self.source if isinstance(self.source, Document) else self.source()

    @property
    def made(self) -> float:
        """When it was made [s since 1970, UTC]."""
        return 1e-6 * self.stamp


@dataclass(frozen=True, eq=False)
class History:
    """At least one version, oldest first."""

    versions: tuple[Version, ...]
    place: int
    """Of the present version; those before it can be undone, those after it redone."""

    @property
    def present(self) -> Version:
        """The version that is worked on."""
        return self.versions[self.place]

    @property
    def undo_name(self) -> str | None:
        """What `back` would take back."""
        return self.present.name if self.place > 0 else None

    @property
    def redo_name(self) -> str | None:
        """What `forth` would do again."""
        return self.versions[self.place + 1].name if self.place + 1 < len(self.versions) else None

    def after(self, document: Document, name: str, now: float, *, instead: bool = False) -> History:
        """Go on to a new document; what was undone is forgotten.

        Parameters
        ----------
        document : Document
        name : str
            Of the edit that made it.
        now : float
            [s since 1970, UTC]; a clock that goes backwards does no harm.
        instead : bool
            The new version takes the place of the present one: both edits are one step.
        """
        stamp = max(int(1e6 * now), 1 + max(version.stamp for version in self.versions))
        kept = self.versions[: self.place + (0 if instead and self.place > 0 else 1)]
        return _at_end((*kept[-DEEPEST:], Version(stamp, name, document)))

    def back(self) -> History:
        """Make the version before the present one; the same when there is none."""
        return self if self.place == 0 else replace(self, place=self.place - 1)

    def forth(self) -> History:
        """Make the version after the present one; the same when there is none."""
        return self if self.redo_name is None else replace(self, place=self.place + 1)


def begin(document: Document, now: float) -> History:
    """Make the history of a skill that was never edited, at a time [s since 1970, UTC]."""
    return History((Version(int(1e6 * now), "", document),), 0)


def opening(document: Document) -> str:
    """Name the step that opens another skill in the place of this one."""
    return f"{'open ' if document.demonstrations else BEGIN}{document.title}"


def version_of(history: History, stamp: int) -> Version | None:
    """Find a version by its stamp; None where it is no longer kept."""
    return next((version for version in history.versions if version.stamp == stamp), None)


def deleted_demonstrations(history: History) -> tuple[Shown, ...]:
    """List the demonstrations that were deleted and are not back, the last deleted first.

    A correction or another name is no deletion, nor is another skill in the place of this one.
    """
    present = history.present.document.demonstrations
    found: list[Shown] = []
    for former, later in pairwise(history.versions[: history.place + 1]):
        if not later.name.startswith(DELETE):  # documents that are not needed are not read
            continue
        before, after = former.document, later.document
        gone = [shown for shown in before.demonstrations if not _among(shown, after.demonstrations)]
        if len(gone) == 1 and len(after.demonstrations) == len(before.demonstrations) - 1:
            found += gone
    unique: list[Shown] = []
    for shown in reversed(found):
        if not _among(shown, present) and not _among(shown, unique):
            unique.append(shown)
    return tuple(unique)


def _among(shown: Shown, others: Sequence[Shown]) -> bool:
    return any(shown.demonstration is other.demonstration for other in others)


def _at_end(versions: tuple[Version, ...]) -> History:
    return History(versions, len(versions) - 1)
