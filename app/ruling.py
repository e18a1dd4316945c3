"""Rules among moved landmarks: they are kept as they were taught, and go with the map as the tube does."""

from typing import Final

import numpy as np

from app.document import Document
from app.inverse import places_before
from gc_core import Constraint, GcError, GeneralizedCylinder, ThinPlateSpline

LOST: Final = 1e-3
"""A place of a rule that cannot be taken back nearer than this is lost [m]."""


class FoldedRuleError(GcError):
    """A rule is made where the moved landmarks fold space, so that there is nothing to keep."""

    def __init__(self, part: float) -> None:
        super().__init__(
            "The landmarks are moved so far that space folds where you correct this run "
            f"(about {100.0 * part:.0f} % of the way). Move them nearer to where they were, and make the "
            "rule then."
        )
        self.part = part


def enabled(document: Document) -> tuple[Constraint, ...]:
    """Rules that are on, as they were taught."""
    return tuple(rule.constraint for rule in document.rules if rule.enabled)


def names(document: Document) -> tuple[str, ...]:
    """How the rules that are on are called."""
    return tuple(rule.name for rule in document.rules if rule.enabled)


def carried(
    constraints: tuple[Constraint, ...], registration: ThinPlateSpline | None
) -> tuple[Constraint, ...]:
    """Rules where the landmarks stand now."""
    if registration is None:
        return constraints
    return tuple(constraint.carried(registration) for constraint in constraints)


def taken_back(
    constraint: Constraint, registration: ThinPlateSpline | None, taught: GeneralizedCylinder | None
) -> Constraint:
    """Undo what moved landmarks do to a rule that was made among them.

    Parameters
    ----------
    constraint : Constraint
        Made with a run as it is shown.
    registration : ThinPlateSpline, optional
        From taught to present landmarks; None: nothing was moved.
    taught : GeneralizedCylinder, optional
        The tube where it was taught, near which the way back is looked for.

    Returns
    -------
    Constraint
        As it is kept: `carried` gives the rule that was made.

    Raises
    ------
    FoldedRuleError
        If one of its planes has no way back.
    """
    if registration is None or taught is None:
        return constraint
    places, misses = places_before(registration, constraint.points, taught.directrix)
    lost = np.flatnonzero(constraint.active & (misses > LOST))
    if lost.size:
        raise FoldedRuleError(float(constraint.parts[lost[0]]))
    return constraint.taken_back(registration, places)
