"""An uploaded file on a desk: looked into, and not accepted yet."""

from dataclasses import dataclass
from pathlib import Path

from app import edits
from app.document import Document
from app.files import Frame, Reading, Unit
from app.store import Offer
from gc_core import Demonstration


@dataclass(frozen=True, eq=False)
class Accepted:
    """What was in a file that is taken over."""

    name: str
    summary: str
    demonstrations: list[Demonstration]

    def skill(self) -> Document:
        """Make a skill of it."""
        return edits.skill_of(Path(self.name).stem, self.demonstrations)

    def join(self, document: Document) -> Document:
        """Add it to a skill."""
        return edits.add_demonstrations(document, self.demonstrations)


class Offering:
    """At most one file that waits to be accepted."""

    def __init__(self) -> None:
        self.offer: Offer | None = None
        """What a person is asked; None: nothing waits."""
        self._reading: Reading | None = None

    def take_in(self, reading: Reading) -> str:
        """Offer what is in a file; returns what to say."""
        self._reading = reading
        self.offer = Offer(
            reading.name,
            reading.summary,
            reading.unit,
            reading.unit_reason,
            reading.frame,
            reading.frame_reason,
        )
        return f"Check what is in {reading.name}, then accept it."

    def accepted(self, unit: Unit, frame: Frame) -> "Accepted | None":
        """Give what is in the file, and offer it no more; None: there is none."""
        reading = self._reading
        if reading is None:
            return None
        demonstrations = reading.accepted(unit, frame)
        self.forget()
        return Accepted(reading.name, reading.summary_in(unit), demonstrations)

    def forget(self) -> None:
        """Offer nothing any more."""
        self._reading = self.offer = None
