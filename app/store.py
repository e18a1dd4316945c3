"""The committed document with its history, and the snapshot that is drawn.

Undo is a list of versions (`app.history`): nothing has to know how to reverse itself. Edits with the
same key within a second are one step, because sliders never say when they are let go.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

from app import edits
from app.arm.conditions import Conditions
from app.arm.protocol import JointPath, Shortfall
from app.arm.shapes import Quadruple
from app.arm.verdict import Verdict
from app.compared import Compared
from app.document import Document, FloatArray, View
from app.files import Frame, Unit
from app.history import History, begin
from app.library import Summary
from app.model import Model
from app.parcel import Parcel
from app.progress import Progress
from app.proposal import Correction, Proposal
from app.quality import Postures
from app.shapes import Shapes
from app.trial import Trial
from gc_core import Reproduction

MERGE_WITHIN: Final = 1.0
"""Edits of one key closer together than this are one undo step [s]."""
Saving: TypeAlias = Literal["saved", "saving", "late"]
LONGER: Final = 1.1
"""An arm that needs more than this times the taught duration is said to be slower."""


@dataclass(frozen=True, eq=False)
class Plan:
    """What the arm makes of one reproduction, under the conditions it was made for."""

    source: Model
    run: int
    """Which reproduction."""
    conditions: Conditions
    """What the arm heeded."""
    verdict: Verdict
    """Its joints, how fast and how clear it is, and what it cannot do."""
    clock: FloatArray
    """(K,) when the arm passes each sample as taught, slower where it must [s]; increasing from 0."""
    ratios: FloatArray
    """(K,) where the hand really is in the tube: 0 on the middle line, 1 on the edge."""

    @property
    def path(self) -> JointPath:
        """Joints at the samples of the reproduction."""
        return self.verdict.path

    @property
    def reproduction(self) -> Reproduction:
        """The run that was planned."""
        return self.source.runs[self.run].reproduction

    @property
    def taught(self) -> float:
        """How long the run takes as taught [s]."""
        return float(self.reproduction.times[-1])

    @property
    def slowed(self) -> bool:
        """Whether the arm needs clearly longer than it was taught."""
        return float(self.clock[-1]) > LONGER * self.taught


@dataclass(frozen=True, eq=False)
class Task:
    """A run that a worker shall play in a physical world, and what it must know for that."""

    model: Model
    run: int
    """Which reproduction."""
    conditions: Conditions
    """What is around the arm."""
    near: FloatArray
    """(J,) joints near which a joint path begins, where there is no plan yet [rad]."""
    plan: Plan | None
    """How the arm plays the run, where it is known."""


@dataclass(frozen=True, eq=False)
class Hand:
    """The arm as it is drawn."""

    joints: FloatArray
    """(J,) [rad]."""
    position: FloatArray
    """(3,) tool tip [m]."""
    gripper: float = 0.0
    """0 open .. 1 closed."""
    wanted: FloatArray | None = None
    """(3,) where the pointer wants the tool while it cannot follow [m]."""
    shortfall: Shortfall | None = None
    """Why it cannot follow."""
    recording: FloatArray | None = None
    """(T, 3) the demonstration drawn so far [m]."""
    returns_to: FloatArray | None = None
    """(3,) where the hand goes back to after the release [m]; while recording and returning."""
    aim: FloatArray | None = None
    """(3,) where buttons and numbers lead it [m]; None: they do not."""
    unturned: str = ""
    """What keeps the tool from being turned as it shall be; empty: nothing does."""
    turned: Quadruple = (0.0, 1.0, 0.0, 0.0)
    """How the tool is turned, w x y z."""


@dataclass(frozen=True)
class Playback:
    """Where the playhead stands."""

    time: float = 0.0
    """On the clock of the reproduction [s]."""
    duration: float = 0.0
    """Of the reproduction that is played [s]; 0 when there is none."""
    playing: bool = False
    run: int = 0
    """Which reproduction is played."""


@dataclass(frozen=True, eq=False)
class Offer:
    """An uploaded file, looked into but not accepted yet."""

    name: str
    """Of the file."""
    summary: str
    """What is in it, in a teacher's words."""
    unit: Unit
    """The guess, to be confirmed."""
    unit_reason: str
    frame: Frame
    """The guess, to be confirmed."""
    frame_reason: str


@dataclass(frozen=True)
class Card:
    """A saved skill as the list shows it."""

    summary: Summary
    drawing: str
    """An ``<svg>`` element; empty for a skill without a tube."""


@dataclass(frozen=True, eq=False)
class Shelf:
    """The saved skills that a person may open, the last saved first."""

    here: str
    """Code of the skill that is worked on."""
    cards: tuple[Card, ...]
    deleted: tuple[Summary, ...]


@dataclass(frozen=True, eq=False)
class State:
    """Everything that panels and scene draw; they read nothing else."""

    document: Document
    """The committed document, or a preview of it while something is dragged."""
    view: View
    model: Model
    """Of ``document``."""
    hand: Hand
    playback: Playback
    plan: Plan | None = None
    """Of the run that is played, once the worker has made it."""
    plans: tuple[Plan, ...] = ()
    """Of all runs of the model that the worker has come to."""
    dragging: str | None = None
    """Scene name of what is dragged."""
    undo_name: str | None = None
    """What undo would take back, for instance ``move goal``."""
    redo_name: str | None = None
    message: str = ""
    """One sentence about what just happened or what is wrong."""
    warning: bool = False
    """Whether the message says that something is wrong."""
    offer: Offer | None = None
    """A file that waits to be accepted."""
    parcel: Parcel | None = None
    """The skill as a file, looked at before it is taken."""
    correction: Correction | None = None
    """A line that is being pulled."""
    replay: Progress | None = None
    """A replay that lets itself be corrected."""
    proposal: Proposal | None = None
    """A correction that waits for an answer; ``document`` is as the previewed choice would make it."""
    trial: Trial | None = None
    """What physics made of a run, if it was asked."""
    shapes: Shapes | None = None
    """The skill in every kind of cross-section; of a former model until those of this one are made."""
    postures: Postures | None = None
    """How the arm holds itself along the demonstrations, as far as that is known."""
    compared: Compared | None = None
    """Methods side by side on this skill, if it was asked."""
    stuck: bool = False
    """Whether the hand is, or was when it was let go, where only another posture of the arm comes."""
    saved: Saving = "saved"
    """Whether the library holds the committed document."""
    history: History | None = None
    """The versions of this skill, one an undo step."""
    shelf: Shelf | None = None
    """The other skills that this person may open, once they have been looked up."""
    tried: frozenset[str] = frozenset()
    """Of the lesson, what was tried with this skill."""


class Store:
    """The document now, and the way back."""

    def __init__(self, opened: Document | History, clock: Callable[[], float] = time.time) -> None:
        """Begin a history, or go on with one; ``clock`` tells the time of day [s since 1970]."""
        self._clock = clock
        self.history = opened if isinstance(opened, History) else begin(opened, clock())
        self._merging: tuple[str, float] | None = None
        """Key and session time of the last edit, while it can be merged with."""

    @property
    def document(self) -> Document:
        """What is worked on."""
        return self.history.present.document

    def edit(
        self, f: Callable[[Document], Document], name: str, *, now: float, key: str | None = None
    ) -> bool:
        """Make the next document.

        Parameters
        ----------
        f : callable
            A pure edit; the same object back means that nothing changed.
        name : str
            What the undo button calls it, for instance ``move goal``.
        now : float
            Session time [s].
        key : str, optional
            Edits of equal key within `MERGE_WITHIN` are one step.

        Returns
        -------
        bool
            Whether the document changed.

        Raises
        ------
        GcError
            From the edit; the document stays as it was.
        """
        before = self.document
        after = edits.edit(before, f)
        if after is before:
            return False
        last = self._merging
        merged = key is not None and last is not None and last[0] == key and now - last[1] <= MERGE_WITHIN
        self.history = self.history.after(after, name, self._clock(), instead=merged)
        self._merging = None if key is None else (key, now)
        return True

    def replace(self, document: Document, name: str) -> None:
        """Put another document in the place of this one, as a step that can be undone."""
        self.history = self.history.after(document, name, self._clock())
        self._merging = None

    @property
    def undo_name(self) -> str | None:
        """What `undo` would take back."""
        return self.history.undo_name

    @property
    def redo_name(self) -> str | None:
        """What `redo` would do again."""
        return self.history.redo_name

    def undo(self) -> str | None:
        """Take the last edit back; returns its name, None when there is none.

        A version that cannot be read raises a `GcError`, and the present one stays.
        """
        name = self.history.undo_name
        self._go(self.history.back())
        return name

    def redo(self) -> str | None:
        """Do the last undone edit again; returns its name, None when there is none."""
        name = self.history.redo_name
        self._go(self.history.forth())
        return name

    def _go(self, history: History) -> None:
        _ = history.present.document  # read now: what cannot be read must not be worked on
        self.history, self._merging = history, None
