"""Methods side by side on a skill: under way, or what came of it; and how each of them looks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from app.arm.conditions import FREE, Conditions
from app.arm.shapes import Shape
from app.comparison import Comparison
from app.document import FloatArray, View
from app.model import Model
from app.surroundings import conditions_of


@dataclass(frozen=True)
class Look:
    """How a method is called and drawn, in the scene and in panels."""

    label: str
    color: tuple[int, int, int]
    """Red, green, blue, each 0..255."""
    dashed: bool = False
    """Colour is never the only code."""

    @property
    def hex(self) -> str:
        """The colour as CSS has it."""
        return "#{:02x}{:02x}{:02x}".format(*self.color)


TUBE: Final = "gc"
LOOKS: Final[Mapping[str, Look]] = {
    TUBE: Look("Tube", (224, 75, 220)),
    "dmp-5": Look("DMP 5", (63, 203, 207), dashed=True),
    "dmp-10": Look("DMP 10", (31, 85, 122)),
    "gmr-5": Look("GMR 5", (225, 152, 45), dashed=True),
    "gmr-10": Look("GMR 10", (76, 14, 1)),
    "promp-10": Look("ProMP 10", (60, 184, 101)),
    "ramp": Look("Ramp", (92, 92, 86), dashed=True),
}
"""By the names of `app.baselines.methods`, in the order in which they are compared. The colours were searched
for: they, the directrix's blue and the demonstrations' red differ to all eyes, whichever cones these have."""


@dataclass(frozen=True, eq=False)
class Compared:
    """What is known so far of methods on a skill as it was when it was asked for."""

    source: Model
    """What they learned from."""
    names: tuple[str, ...]
    """Methods, the tube among them."""
    starts: FloatArray | None = None
    """(S, 3) those of Try [m]; None: spread over the first slice."""
    heeded: Conditions = FREE
    """What the arm heeds."""
    found: Comparison | None = None
    """None: nothing is known yet."""
    picture: str = ""
    """One ``<svg>`` element with a small drawing a method."""
    doing: str = ""
    """What is done now, for instance ``DMP 10: 3 of 5``; empty: nothing more."""
    share: float = 0.0
    """How much is done, 0 to 1."""
    problem: str = ""
    """Why nothing can be compared, or why it ended early, in a sentence."""
    outdated: bool = False
    """The skill, or what stands around, has changed since."""

    def about(self, model: Model) -> bool:
        """Whether a model is of the same skill, however it was edited since."""
        return any(one is other for one in model.demonstrations for other in self.source.demonstrations)

    @property
    def drawn(self) -> bool:
        """Whether there are runs that can be drawn in the scene."""
        return self.found is not None and not self.outdated

    def holds(self, model: Model, view: View) -> bool:
        """Whether the same methods would give the same on a model, however it is looked at."""
        one, other, heeded = self.source.source, model.source, conditions_of(model, view)
        return (
            len(self.source.demonstrations) == len(model.demonstrations)
            and all(a is b for a, b in zip(self.source.demonstrations, model.demonstrations, strict=True))
            and one.settings == other.settings
            and _fixed(one.things) == _fixed(other.things)
            and (heeded == self.heeded or not (heeded.obstacles or self.heeded.obstacles))
            and (self.starts is None or one.starts is other.starts)
        )


def _fixed(things: tuple[Shape, ...]) -> tuple[Shape, ...]:
    return tuple(thing for thing in things if thing.mass == 0.0)
