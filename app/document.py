"""What a person makes: the only thing that undo and saving know about.

A `Document` never changes; `app.edits` makes the next one. What a person merely
looks at (tabs, what is visible, how wide a pull is) is the `View`, which is neither
saved nor undone. Positions are in the robot's base frame [m].
"""

import unicodedata
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from app.arm.shapes import Box, Cylinder, Ring, Shape, Sphere
from gc_core import Constraint, Demonstration

__all__ = ("Box", "Cylinder", "Ring", "Shape", "Sphere")

FloatArray: TypeAlias = NDArray[np.float64]
SectionKind: TypeAlias = Literal["circle", "ellipse", "closed_spline"]
Alignment: TypeAlias = Literal["time", "arc_length", "dtw"]
LandmarkKind: TypeAlias = Literal["start", "goal", "via", "obstacle", "object"]
ThingKind: TypeAlias = Literal["box", "ball", "cylinder", "ring"]

SECTION_KINDS: Final[tuple[SectionKind, ...]] = ("circle", "ellipse", "closed_spline")
ALIGNMENTS: Final[tuple[Alignment, ...]] = ("time", "arc_length", "dtw")
LANDMARK_KINDS: Final[tuple[LandmarkKind, ...]] = ("start", "goal", "via", "obstacle", "object")
THING_KINDS: Final[tuple[Literal["box"], Literal["ball"], Literal["cylinder"], Literal["ring"]]] = (
    "box",
    "ball",
    "cylinder",
    "ring",
)


@dataclass(frozen=True, eq=False)
class Shown:
    """One demonstration in the list."""

    demonstration: Demonstration
    muted: bool = False
    """Kept and drawn, but not learned from."""


@dataclass(frozen=True, eq=False)
class Place:
    """A landmark: something the motion is tied to, where it was and where it is now."""

    name: str
    """Also its name in the scene: ``/landmarks/<name>``."""
    taught: FloatArray | None = None
    """(3,) where it stood while the skill was taught [m]; None: the end of the demonstrations
    (their beginning for ``start``)."""
    now: FloatArray | None = None
    """(3,) where it stands now [m]; None: it was not moved."""
    kind: LandmarkKind = "via"
    """Start and goal are a skill's ends; an object is a frame, which turns; the others are points."""
    turn: FloatArray | None = None
    """(3,) roll, pitch, yaw: how an object was turned since, about the base frame's x, then y, then z
    [rad]; None: it was not turned."""

    def __post_init__(self) -> None:
        # Older skills say by its name alone what a landmark is.
        if self.kind == "via" and self.name in {"start", "goal"}:
            object.__setattr__(self, "kind", self.name)


@dataclass(frozen=True, eq=False)
class Rule:
    """A correction of a reproduction, kept as a constraint that can be switched off."""

    constraint: Constraint
    name: str
    enabled: bool = True


@dataclass(frozen=True)
class Settings:
    """How the demonstrations are encoded."""

    section: SectionKind = "closed_spline"
    align_by: Alignment = "arc_length"
    stations: int = 200


@dataclass(frozen=True, eq=False)
class Document:
    """A skill: what was shown, how it is encoded, what was moved and corrected."""

    title: str
    about: str = ""
    """One sentence for the person who opens it."""
    demonstrations: tuple[Shown, ...] = ()
    settings: Settings = Settings()
    landmarks: tuple[Place, ...] = (Place("start"), Place("goal"))
    tries: tuple[Place, ...] = ()
    """Where landmarks of these names may be moved, ``now``, to see the skill follow."""
    smoothing: float = 0.0
    """How much less the space between moved landmarks is bent, at the price of missing them: lambda of the
    thin-plate spline; 0 meets them exactly [-]."""
    starts: tuple[FloatArray, ...] = ()
    """Where reproductions begin, each (3,) [m]."""
    rules: tuple[Rule, ...] = ()
    things: tuple[Shape, ...] = ()
    """What stands in the way of the arm, and what it can carry; each has a name of its own."""
    built_in: bool = False
    """A built-in skill; its first edit makes a copy."""


Pace: TypeAlias = Literal["taught", "fastest"]
Feel: TypeAlias = Literal["soft", "medium", "firm"]


@dataclass(frozen=True)
class View:
    """What a person looks at and works with; not saved, not undone."""

    show_tube: bool = True
    show_demonstrations: bool = True
    show_reproductions: bool = True
    pull_width: float = 0.20
    """How far along a line a pull reaches to either side [m of arc length]."""
    gripper_closed: bool = False
    """What the hand does during the next demonstration."""
    speed: float = 1.0
    """Playback speed; at 1 the arm moves in real time."""
    pace: Pace = "taught"
    """As taught, slower where the arm must; or as fast as the arm can."""
    loop: bool = True
    tool: tuple[float, float, float, float] | None = None
    """The tool is held like this while the hand is moved, w x y z; None: it points down by itself, and
    gives way only where the hand could not go otherwise."""
    rings: bool = False
    """Rings about the hand turn the tool."""
    replay: str = "/demonstrations/0"
    """Scene name of what is replayed to be corrected."""
    line: str = ""
    """Scene name of the line that is corrected by buttons and numbers; empty: none."""
    line_share: float = 0.5
    """After which part of its length it is moved, 0 .. 1."""
    replay_speed: float = 0.5
    """Of that replay, as a multiple of the taught one: 0.25 .. 1."""
    replay_feel: Feel = "medium"
    """How hard the hand is to pull aside then."""
    suggest: bool = True
    """Say and show what would help most next."""
    redo: Demonstration | None = None
    """The demonstration whose place the next recording takes."""
    rule: int | None = -1
    """Place in the list of the rule whose arrows are shown; -1: the newest; None: of none."""
    placing: LandmarkKind | ThingKind | None = None
    """The next click in the scene places a landmark, or a thing, of this kind."""
    thing: str = ""
    """Name of the thing that is worked on: it has handles to size it by."""
    methods: tuple[str, ...] = ("dmp-5", "dmp-10", "gmr-5", "gmr-10")
    """What the tube is compared with: names of `app.baselines.methods`; those of the paper's Fig. 9."""
    compare_count: int = 5
    """From so many starts in the first slice; 0: from those of Try."""
    show_compared: bool = True
    """Their runs are drawn in the scene."""


def plain(text: str) -> str:
    """Leave out what can neither be shown nor saved: control characters but line ends, halves of letters."""
    return "".join(c for c in text if c == "\n" or unicodedata.category(c) not in ("Cc", "Cs"))
