"""What a person holds, from the press to the release, and how the document would be if it were let go now."""

from dataclasses import dataclass

import numpy as np

from app import drawn, gesture
from app.actions import Drag
from app.document import Document
from app.gesture import Pull, Track
from app.handpull import HandPull
from app.linepull import LinePull
from app.model import Model
from app.proposal import Correction
from gc_core import Demonstration, GcError


@dataclass(eq=False)
class Grasp:
    """One pull in progress."""

    pull: Pull | HandPull | LinePull
    track: Track
    before: Model
    """What was shown when it was grabbed."""
    followed: float
    """When the last event arrived [s]."""
    replaces: Demonstration | None = None
    """The demonstration whose place a recording takes."""
    ends: float | None = None
    """The button was let go, and at this time the pull is over [s]."""
    problem: str = ""
    """Why it cannot be pulled any farther."""
    _basis: object = None
    _preview: Document | None = None
    _corrected: tuple[object, Track] | None = None
    _correction: Correction | None = None

    @property
    def node(self) -> str:
        """Scene name of what is held."""
        return self.pull.node

    @property
    def moved(self) -> float:
        """How far it was pulled [m]."""
        return float(np.linalg.norm(self.track.displacement))

    def takes(self, drag: Drag) -> bool:
        """Whether an event belongs to this pull."""
        return self.node == drag.node and (not isinstance(self.pull, HandPull) or self.pull.pointed)

    @property
    def correction(self) -> Correction | None:
        """The line that is pulled, before and now."""
        if not isinstance(self.pull, LinePull):
            return None
        if self._correction is None or self._corrected != (self.pull, self.track):
            self._corrected = self.pull, self.track
            self._correction = self.pull.correction(self.track.displacement)
        return self._correction

    def goes_on(self, drag: Drag) -> bool:
        """Whether a new part of the same pull begins: Shift was pressed or let go in mid-drag."""
        if self.node != drag.node or self.ends is None or drag.time > self.ends:
            return False
        return not isinstance(self.pull, HandPull) or self.pull.records != drag.aside

    def follow(self, drag: Drag) -> None:
        """Take one more event into account."""
        self.track = gesture.follow(self.track, drag)
        self.ends = drag.time + gesture.GRACE if drag.phase == "end" else None
        self.followed = drag.time
        self.aim(drag)

    def aim(self, drag: Drag) -> None:
        """Lead the hand, if that is what is held; the depth of a goal under the pointer attracts it."""
        if not isinstance(self.pull, HandPull):
            return
        target = self.pull.begins_at.position + self.track.displacement
        if drag.eye is not None and not drag.vertical:
            goals = [anchor.now for anchor in self.before.anchors if anchor.name != "start"]
            target = gesture.drawn_to(goals, target, drag.eye)
        self.pull.aim(drag.time, target)

    def widen(self, width: float) -> None:
        """Let a pull on a line reach farther, or less far, to either side [m of arc length]."""
        if isinstance(self.pull, LinePull) and width != self.pull.width:
            self.pull = self.pull.widened(width)

    def shown(self, document: Document) -> Document:
        """Give the document as it would be if this were let go now; the same object while nothing changed."""
        basis = self.pull.drawn() if isinstance(self.pull, HandPull) else (self.pull, self.track)
        if self._preview is None or self._basis != basis:
            self._basis = basis
            try:
                self._preview, self.problem = self._applied(document), ""
            except GcError as error:  # pulled too far: what was shown last stays
                self._preview, self.problem = self._preview or document, str(error)
        return self._preview

    def _applied(self, document: Document) -> Document:
        if not isinstance(self.pull, HandPull):
            return self.pull.apply(document, self.track.displacement)
        part = self.pull.preview(self.before.cylinder)
        if part is None:
            return document
        return drawn.added(document, drawn.taken_back(part, self.before), self.replaces)
