"""Correcting by replay: from the button through the pulls to the answer.

At most one replay runs and at most one correction waits. Both end cleanly whatever
happens: nothing reaches the document but by `Amending.answer`, as one undo step.
"""

from dataclasses import replace
from typing import Final

from app import compliance, correcting, linepull
from app.actions import Drag
from app.document import Document, FloatArray, View
from app.linepull import LinePull
from app.model import Model
from app.outlining import Outlining
from app.progress import Progress
from app.proposal import CHOOSE_ONE, DISCARDED, FIRST_ANSWER, LOST, UNDO, Choice, Pending, Proposal
from app.replaying import Replaying
from app.stage import Stage
from app.store import Store
from app.subject import subject_of
from gc_core import GcError

CHOOSE: Final = "There is nothing to replay yet. Choose a demonstration or a run."
PULL_IT: Final = "Pull the hand where the motion should be otherwise; let go, and it eases back."
ONLY_THE_HAND: Final = (
    "Take the hand itself: nothing else can be pulled while it replays. Press Stop to work on something else."
)
GONE: Final = "This line is not there any more. Choose another one."
SLIP: Final = 0.001
"""What is pulled by less than this was pulled by a slip of the hand, and stays as it is [m]."""
FIRST: Final = "/demonstrations/0"
"""What is replayed when the motion that was chosen is not there any more."""
_FEELS: Final = {feel.name: feel for feel in compliance.FEELS}

Said = tuple[str, bool]
"""A sentence, and whether it says that something is wrong."""


class Amending:
    """The replay and the correction on one desk."""

    def __init__(self, stage: Stage, store: Store) -> None:
        self._stage, self._store = stage, store
        self._replay: Replaying | None = None
        self._pending: Pending | None = None
        self._aside: Pending | None = None
        self._outlining: Outlining | None = None
        self._contradicting: frozenset[tuple[str, ...]] = frozenset()

    @property
    def replays(self) -> bool:
        """Whether a replay runs."""
        return self._replay is not None

    @property
    def waits(self) -> bool:
        """Whether a correction waits for its answer."""
        return self._pending is not None

    @property
    def holds(self) -> str | None:
        """Scene name of what is held in a replay."""
        return "/hand" if self._replay is not None and self._replay.held else None

    @property
    def progress(self) -> Progress | None:
        """How far the replay is, and what it would change so far."""
        if self._replay is None or self._outlining is None:
            return None
        outlook = self._outlining.of(self._replay.so_far())
        return replace(self._replay.progress(), outline=outlook.cylinder, effect=outlook.effect)

    @property
    def undo_name(self) -> str | None:
        """What undo would take back before anything else."""
        return None if self._pending is None else UNDO

    @property
    def proposal(self) -> Proposal | None:
        """The correction that waits."""
        return None if self._pending is None else self._pending.proposal

    def shown(self, document: Document) -> Document:
        """Give the document as the previewed choice would make it."""
        return document if self._pending is None else self._pending.shown(document)

    # --- a replay ----------------------------------------------------------------------

    def start(self, view: View, model: Model, now: float) -> Said:
        """Replay what the view names, or the first demonstration, unless a correction waits."""
        if (asked := self.settle("/hand", now)) is not None:
            return asked
        subject = subject_of(view.replay, model) or subject_of(FIRST, model)
        if subject is None:
            return CHOOSE, True
        self._stage.pause()
        feel, speed = _FEELS[view.replay_feel], view.replay_speed
        self._replay = Replaying(self._stage.arm, subject, self._stage.hand, now, feel=feel, speed=speed)
        self._outlining = Outlining(subject)
        return PULL_IT, False

    def drag(self, drag: Drag) -> Said | None:
        """Pull the hand of the replay; nothing else can be pulled while it runs."""
        replay = self._replay
        if replay is None or drag.node != "/hand":
            return self.missed() if drag.phase == "start" else None
        replay.follow(drag)
        self._stage.driver.pulled(replay.hand)
        return (PULL_IT, False) if drag.phase == "start" else None

    def missed(self) -> Said | None:
        """Say what can be pulled while it replays, to somebody who does not hold it."""
        return None if self._replay is None or self._replay.held else (ONLY_THE_HAND, True)

    def tick(self, now: float) -> bool:
        """Replay on; returns whether it is at its end."""
        replay = self._replay
        if replay is None:
            return False
        replay.advance(now)
        self._stage.driver.pulled(replay.hand)
        return replay.done

    def end(self, now: float) -> Said | None:
        """End the replay, if one runs, and offer what was corrected."""
        replay, self._replay, self._outlining = self._replay, None, None
        if replay is None:
            return None
        corrected = replay.finish(now)
        self._stage.driver.pulled(replay.hand)
        self._stage.rewind()
        if corrected is None:
            return correcting.NOTHING, False
        return self.offer(correcting.proposed(replay.subject, corrected))

    # --- a correction ------------------------------------------------------------------

    def offer(self, proposal: Proposal) -> Said:
        """Let a correction wait for its answer, and show what it would do."""
        self._pending = Pending(proposal)
        return CHOOSE_ONE, False

    def preview(self, choice: int) -> None:
        """Show what another choice would do."""
        if self._pending is not None:
            self._pending.preview(choice)

    def grab(self, drag: Drag, model: Model, width: float) -> LinePull | None:
        """Take hold of a line; one whose correction waits is pulled further.

        Parameters
        ----------
        drag : Drag
            The press.
        model : Model
            What is shown.
        width : float
            How far the pull reaches along the line to either side [m].

        Returns
        -------
        LinePull or None
            None for what is no line.
        """
        waiting = None if self._pending is None else self._pending.proposal
        within = self._stage.arm.unreachable
        pull = linepull.take(drag.node, drag.grabbed, model, width, unreachable=within, waiting=waiting)
        if pull is not None:
            self._aside, self._pending = self._pending, None
        return pull

    def shift(self, node: str, share: float, by: FloatArray, model: Model, width: float) -> Said | None:
        """Pull a line without a pointer: grab it after a part of the way, move it (3,) [m] and let it go.

        See `grab`, `pulled` and `linepull.place_on`.
        """
        place = linepull.place_on(node, share, model, self.proposal)
        pull = None if place is None else self.grab(Drag(node, "start", place, place, 0.0), model, width)
        if pull is None:
            return GONE, True
        said = self.pulled(pull, by)
        stopped = pull.stopped(by)
        return said if said[1] or not stopped else (stopped, True)

    def pulled(self, pull: LinePull, by: FloatArray) -> Said:
        """Offer what became of a line, as far as it can be kept; a slip changes nothing."""
        self._pending, self._aside = self._aside, None
        if pull.reached(by).moved < SLIP:
            return "", False
        proposal = pull.proposal(by)
        fault, choices = self._possible(proposal.choices)
        if choices and (stays_off := linepull.unfollowable(self._stage.arm, proposal)):
            fault, choices = stays_off, tuple(choice for choice in choices if not choice.records)
        if not fault:
            return self.offer(proposal)
        if choices:
            self._pending = Pending(replace(proposal, choices=choices, previewed=0))
        return fault, True

    def _possible(self, choices: tuple[Choice, ...]) -> tuple[str, tuple[Choice, ...]]:
        """Leave out the choices that cannot be made now, and say why; empty where all can."""
        fault, possible = "", list[Choice]()
        for choice in choices:
            try:
                choice.apply(self._store.document)
            except GcError as error:
                fault = str(error)
            else:
                possible.append(choice)
        return fault, tuple(possible)

    def settle(self, node: str, now: float) -> Said | None:
        """Make room for another pull: whoever goes on accepts what there is only one thing to do with.

        Parameters
        ----------
        node : str
            What is grabbed.
        now : float
            Session time [s].

        Returns
        -------
        Said or None
            None where the pull may begin: no question is open, or only about the line that is grabbed.
        """
        if self._pending is None:
            return None
        proposal = self._pending.proposal
        if proposal.subject is not None and proposal.subject.node == node:
            return None
        if not all(choice.implied for choice in proposal.choices):
            return FIRST_ANSWER, True
        said = self.answer(0, now)
        return said if said is not None and said[1] else None

    def contradicting(self, model: Model) -> Said | None:
        """Say once that rules contradict each other: when one is made or switched on."""
        if model.coarse or self._pending is not None:
            return None
        new = [one for one in model.contradictions if one.names not in self._contradicting]
        self._contradicting = frozenset(one.names for one in model.contradictions)
        return (new[0].sentence(), True) if new else None

    def discard(self) -> Said | None:
        """Forget the correction that waits, if there is one."""
        pending, self._pending = self._pending, None
        return None if pending is None else (DISCARDED, False)

    def answer(self, choice: int | None, now: float) -> Said | None:
        """Do what a choice says, as one undo step; None discards."""
        pending = self._pending
        if pending is None or choice is None or not 0 <= choice < len(pending.proposal.choices):
            return self.discard()
        chosen = pending.proposal.choices[choice]
        kept = self._store.edit(chosen.apply, chosen.name, now=now)  # if it fails, it waits on
        self._pending = None
        return ("", False) if kept else (LOST, True)
