"""The hand led without a pointer: by buttons, numbers and the rings that turn the tool.

What a led hand does is the same `HandPull` as that of a pointer, so it moves by the servo and is
recorded alike. Unless it records it ends by itself, when the hand has come to where it is wanted.
"""

from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from app import drawn, edits, sentences, turning
from app.document import FloatArray
from app.gesture import Track
from app.grasp import Grasp
from app.handpull import HandPull
from app.inquiry import Answer, Inquiry
from app.model import Model
from app.servo import Motion
from app.store import Hand

if TYPE_CHECKING:
    from app.desk import Desk

SHORTEST: Final = 0.03
"""A demonstration shorter than this was a slip of the hand [m]."""
SLIGHT: Final = 0.25
"""A demonstration shorter than this part of what was shown is hardly one: it is kept, and muted."""
LARGEST_NUDGE: Final = 0.5
"""No press of a button moves the hand farther [m]."""


class Leading:
    """What buttons, numbers and rings do with the hand of a desk."""

    def __init__(self, desk: "Desk") -> None:
        self._desk = desk
        self._way: Inquiry | None = None
        self._stuck_at: FloatArray | None = None

    @property
    def inquiry(self) -> Inquiry | None:
        """What a worker should find out about the arm."""
        pull = self._desk.pulled_hand
        return self._way if pull is None else pull.inquiry

    @property
    def stuck(self) -> bool:
        """Whether another posture of the arm would help, or would have when the hand was let go."""
        short = self._desk.stage.hand.shortfall
        return self._way is None and (self._stuck_at is not None or (short is not None and short.stuck))

    # --- where it goes -----------------------------------------------------------------

    def move(self, position: FloatArray, now: float) -> None:
        """Lead the hand to a place (3,) [m]; the next demonstration begins there."""
        self._led(now).go(now, edits.point(position))

    def nudge(self, by: FloatArray, now: float) -> None:
        """Lead the hand on by a little (3,) [m], from where it is going already."""
        if np.isfinite(by).all() and np.linalg.norm(by) <= LARGEST_NUDGE:
            pull = self._led(now)
            pull.go(now, edits.point(pull.target + by))

    def move_line(self, node: str, share: float, by: FloatArray, now: float) -> None:
        """Pull a line after a part of the way along it, by a displacement (3,) [m], and let it go."""
        desk = self._desk
        if not (np.isfinite([share, *by]).all() and np.linalg.norm(by) <= LARGEST_NUDGE):
            return
        desk.let_go(now)
        if (asked := desk.amending.settle(node, now)) is not None:
            desk.say(asked[0], warning=asked[1])
            return
        desk.learned()
        width = desk.view.pull_width
        desk.amend(lambda amending: amending.shift(node, share, by, desk.model, width))

    def record(self, now: float) -> None:
        """Begin a demonstration by buttons and numbers, or end the one that is being recorded."""
        pull = self._desk.pulled_hand
        if pull is not None and not pull.pointed and pull.records:
            self._desk.let_go(now)
        else:
            self._desk.let_go(now)
            if (asked := self._desk.amending.settle("/hand", now)) is not None:
                self._desk.say(asked[0], warning=asked[1])
                return
            self._hold(now, records=True)
            self._desk.say("")

    # --- how the tool is turned --------------------------------------------------------

    def hold(self, held: bool) -> None:
        """Hold the tool as it is, or let it turn freely."""
        turned = self._desk.stage.hand.turned
        self._desk.look(tool=turned if held else None)
        self._desk.say(
            "The tool is held as it is now."
            if held
            else "The tool turns freely: it points down where it can."
        )

    def turn(self, wxyz: object, now: float) -> None:
        """Turn the tool to an orientation w, x, y, z, and hold it so."""
        wanted, pull = turning.checked(wxyz), self._desk.pulled_hand or self._led(now)
        pull.turns(now)
        self._desk.look(tool=wanted)

    def nudge_turn(self, by: FloatArray, now: float) -> None:
        """Turn the tool on about its own axes by angles (3,) [rad]."""
        desk = self._desk
        begin = desk.stage.hand.turned if desk.view.tool is None else desk.view.tool
        if np.isfinite(by).all():
            self.turn(turning.turned(begin, by), now)

    # --- how it ends -------------------------------------------------------------------

    def let_go(self, pull: HandPull, hand: Hand, now: float, among: Model) -> None:
        """Keep what a led hand has drawn; it goes back, or stays where it was put."""
        desk, short = self._desk, hand.shortfall
        self._stuck_at = pull.target if short is not None and short.stuck else None
        rests = replace(hand, unturned="")
        back = desk.stage.driver.released(rests, pull.begins_at.joints if pull.records else None, now)
        desk.say("The next demonstration begins here.")
        if hand.unturned:
            self._hold_as_it_is(pull, hand)
        if pull.records:
            self._keep(pull, now, among, back=back)

    def _keep(self, pull: HandPull, now: float, among: Model, *, back: bool) -> None:
        desk, part = self._desk, pull.drawn()
        if part.length < SHORTEST:
            desk.say(sentences.too_short(part), warning=True)
            return
        shown = drawn.taken_back(drawn.demonstration(part), among)
        motion = 0.0 if among.cylinder is None else float(among.cylinder.arc_length[-1])
        slight = part.length < SLIGHT * motion
        shown = replace(shown, muted=shown.muted or slight)
        there = [one.demonstration for one in desk.store.document.demonstrations]
        former = next((one for one in there if one is desk.view.redo), None)  # it may be deleted by now
        name = "demonstrate" if former is None else f"show {former.name} again"
        desk.store.edit(lambda d: drawn.added(d, shown, former), name, now=now)
        desk.look(redo=None)
        learned_from = [s.demonstration for s in desk.store.document.demonstrations if not s.muted]
        goal = next((anchor.now for anchor in among.anchors if anchor.kind == "goal"), None)
        said = (
            sentences.slight(part, motion)
            if slight
            else sentences.demonstrated(part, learned_from, shown, goal)
        )
        if former is not None:
            said = f"It took the place of {former.name}. {said}"
        desk.say(said if back else f"{said} {sentences.NO_WAY_BACK}", warning=shown.muted or not back)

    def _hold_as_it_is(self, pull: HandPull, hand: Hand) -> None:
        """The tool could not be turned as it should be."""
        desk = self._desk
        desk.look(tool=pull.held)
        desk.say(
            f"The tool cannot be turned any farther: {hand.unturned}. It is held as it is now.", warning=True
        )

    # --- another posture of the arm ----------------------------------------------------

    def reposition(self, now: float) -> None:
        """Bring a stuck hand to where it is wanted by another posture of the arm.

        A demonstration that is being recorded ends first, as if let go; the swing is never in it.
        """
        desk, pull = self._desk, self._desk.pulled_hand
        target = self._stuck_at if pull is None else pull.target
        if not self.stuck or target is None:
            desk.say("The arm is not stuck: pull the hand where you want it.")
            return
        desk.let_go(now)
        desk.stage.pause()
        stays = replace(desk.stage.hand, shortfall=None, wanted=None, returns_to=None)
        desk.stage.driver.pulled(stays)
        self._stuck_at = target
        self._way = Inquiry(stays.joints, target, desk.stage.arm.conditions, way=True)
        kept = pull is not None and pull.records and len(desk.message) > 0 and not desk.warning
        desk.say("What was recorded until here is kept. Looking for a posture …" if kept else LOOKING)

    def answered(self, inquiry: Inquiry, answer: Answer, now: float) -> None:
        """Take over what a worker has found out; what is not asked any more is forgotten."""
        desk, pull = self._desk, self._desk.pulled_hand
        if pull is not None:
            if not isinstance(answer, Motion):
                pull.answered(inquiry, answer)
        elif inquiry is self._way:
            self._way = None
            if desk.stage.playback.playing or not np.array_equal(desk.stage.hand.joints, inquiry.joints):
                desk.say(MOVED_ON)
            elif isinstance(answer, Motion):
                self._stuck_at = None
                desk.stage.driver.swings(answer, now)
                desk.say(SWINGS)
            else:
                desk.say(NO_WAY, warning=True)

    def forget(self) -> None:
        """Something else is done with the arm."""
        self._way = self._stuck_at = None

    # --- the pull ----------------------------------------------------------------------

    def _led(self, now: float) -> HandPull:
        """Give the hand that buttons lead already, or take it."""
        pull = self._desk.pulled_hand
        if pull is not None and not pull.pointed:
            return pull
        self._desk.let_go(now)
        return self._hold(now, records=False)

    def _hold(self, now: float, *, records: bool) -> HandPull:
        desk = self._desk
        desk.stage.pause()
        pull = desk.take_hand(now, records=records, pointed=False)
        nowhere = np.zeros(3)
        desk.hold(Grasp(pull, Track(nowhere, nowhere, nowhere), desk.model, -np.inf, desk.view.redo))
        return pull


LOOKING: Final = "Looking for another posture of the arm …"
SWINGS: Final = "The arm changes its posture and brings the hand there. The next demonstration begins there."
MOVED_ON: Final = "The arm was moved meanwhile, so its posture was not changed."
NO_WAY: Final = (
    "There is no clear way to another posture. Move the hand elsewhere first, or clear what is around it."
)
