"""What a replay that still runs would make of the tube and of the runs, learned with few stations.

It is drawn and said beside what is shown: nothing of the shown model is learned or drawn anew for it.
"""

from dataclasses import dataclass, replace
from typing import Final

from app import correcting, effects
from app.document import Document
from app.model import Model, learn
from app.replaying import Corrected
from app.subject import Subject
from gc_core import GcError, GeneralizedCylinder

STATIONS: Final = 60
"""Of the outlined tube, at most: an outline has far fewer rings."""


@dataclass(frozen=True, eq=False)
class Outlook:
    """What would be learned if the hand were let go now."""

    cylinder: GeneralizedCylinder | None = None
    """The tube; None where it stays as it is."""
    effect: str = ""
    """How many of the shown runs change, and by how much: a part of a sentence."""


class Outlining:
    """The outlook on one replay."""

    def __init__(self, subject: Subject) -> None:
        """Learn what is there before the subject is corrected."""
        self._subject = subject
        self._before = _learned(subject.among.source)
        self._made: Corrected | None = None
        self._outlook = Outlook()

    def of(self, made: Corrected | None) -> Outlook:
        """Give the outlook on a recording; the same object for the same one."""
        if made is not self._made:
            self._made = made
            self._outlook = Outlook() if made is None else self._learn(made)
        return self._outlook

    def _learn(self, made: Corrected) -> Outlook:
        try:
            first = correcting.proposed(self._subject, made).choices[0]
            after = _learned(first.apply(self._subject.among.source), self._before)
        except GcError:  # said when it is offered
            return Outlook()
        same = after.cylinder is self._before.cylinder
        return Outlook(None if same else after.cylinder, effects.on_runs(self._before, after))


def _learned(document: Document, former: Model | None = None) -> Model:
    few = min(STATIONS, document.settings.stations)
    return learn(replace(document, settings=replace(document.settings, stations=few)), former, coarse=True)
