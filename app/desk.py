"""The work on one skill: what every action, pull and moment does.

No viser, no threads, no clock: time comes in with each call, so that a test can play
a whole session in no time. The session calls it from its mailbox and draws `state`.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Final

from app import attention, gesture, judgement
from app.actions import Drag
from app.amending import SLIP, Amending, Said
from app.arm.protocol import Arm
from app.document import Document, View
from app.files import Frame, Reading, Unit
from app.gesture import Pull
from app.grasp import Grasp
from app.handpull import HandPull
from app.history import History, opening
from app.leading import Leading
from app.linepull import LinePull
from app.model import learn
from app.offering import Offering
from app.stage import Stage
from app.store import Plan, State, Store
from app.surroundings import conditions_of
from gc_core import GcError

PATIENCE: Final = 0.08
"""A pulled hand moves with the events of the pull; after a longer silence it moves on by itself [s]."""


class Desk:
    """One skill being worked on, with the arm that plays it."""

    def __init__(self, opened: Document | History, arm: Arm) -> None:
        """Open a document, with its history or without; its first reproduction plays."""
        self.store = Store(opened)
        self.view = View()
        self.model = learn(self.store.document)
        self.stage = Stage(arm)
        self._offering = Offering()
        self.message, self.warning = self.store.document.about, False
        self._held: Grasp | None = None
        self.amending = Amending(self.stage, self.store)
        self.leading = Leading(self)
        """Buttons and numbers for the hand."""
        self._set_stage()

    # --- what is drawn -----------------------------------------------------------------

    def state(self) -> State:
        """Take a snapshot for panels and scene."""
        document = self.learned()
        urgent = attention.urgent(self.stage.hand, self._held, self.model, self.stage.arm)
        message, warning = urgent or (self.message, self.warning)
        return State(
            document=document,
            view=self.view,
            model=self.model,
            hand=self.stage.hand,
            playback=self.stage.shown,
            plan=self.stage.plan(self.model),
            plans=self.stage.plans(self.model),
            dragging=self.amending.holds if self._held is None else self._held.node,
            correction=None if self._held is None else self._held.correction,
            undo_name=self.amending.undo_name or self.store.undo_name,
            redo_name=None if self.amending.waits else self.store.redo_name,
            message=message,
            warning=warning,
            offer=self._offering.offer,
            replay=self.amending.progress,
            proposal=self.amending.proposal,
            trial=self.stage.trial(self.model),
            stuck=self.leading.stuck,
            history=self.store.history,
        )

    def learned(self) -> Document:
        """Give what is shown, and see to it that it is learned."""
        document = self.amending.shown(self.store.document)
        if self._held is not None:
            document = self._held.shown(document)
        if self.model.source is not document:
            self.model = learn(document, self.model, coarse=self._held is not None)
            self._set_stage()
        self.amend(lambda a: a.contradicting(self.model))
        return document

    def _set_stage(self) -> None:
        """Fit the arm and the playhead to the present model and view."""
        self.stage.heed(conditions_of(self.model, self.view))
        self.stage.fit(self.model)
        if self.pulled_hand is not None:
            self.pulled_hand.heed(self.stage.arm.conditions)

    @property
    def pulled_hand(self) -> HandPull | None:
        """The hand that is being led, by a pointer or by buttons."""
        pull = None if self._held is None else self._held.pull
        return pull if isinstance(pull, HandPull) else None

    def say(self, message: str, *, warning: bool = False) -> None:
        """Show a sentence."""
        self.message, self.warning = message, warning

    # --- edits -------------------------------------------------------------------------

    def edit(
        self, f: Callable[[Document], Document], name: str, *, now: float, key: str | None = None
    ) -> None:
        """Make one undo step."""
        self.let_go(now)
        if self.store.edit(f, name, now=now, key=key):
            self.say("")

    def undo(self, now: float) -> None:
        """Take the last step back; a correction that waits is the last step."""
        self.let_go(now)
        if self.amending.waits:
            return self.amend(lambda a: a.answer(None, now))
        name = self.store.undo()
        self.say("There is nothing to undo." if name is None else f"Undone: {name}.")

    def redo(self, now: float) -> None:
        """Do the last undone step again."""
        self.let_go(now)
        name = None if self.amending.waits else self.store.redo()
        self.say("There is nothing to redo." if name is None else f"Done again: {name}.")

    def open(self, document: Document, now: float) -> None:
        """Put another skill on the desk; can be undone. In an empty one the hand goes home."""
        self.let_go(now)
        self.amending.settle("", now)
        self.amending.discard()
        self.store.replace(document, opening(document))
        self.stage.open(playing=bool(document.demonstrations))
        if document.demonstrations:
            self.stage.driver.lead()
        else:
            self.stage.driver.released(self.stage.hand, self.stage.arm.home, now)
        self.say(document.about)

    def look(self, **changes: Any) -> None:
        """Change what is looked at."""
        self.view = replace(self.view, **changes)
        self._set_stage()
        if self._held is not None:
            self._held.widen(self.view.pull_width)

    def toggle_gripper(self) -> None:
        """Open or close the hand; recorded while it is pulled."""
        self.look(gripper_closed=not self.view.gripper_closed)
        gripper = float(self.view.gripper_closed)
        if self.pulled_hand is not None:
            self.pulled_hand.set_gripper(gripper)
        self.stage.driver.grip(gripper)

    # --- files -------------------------------------------------------------------------

    def offer_reading(self, reading: Reading) -> None:
        """Show what is in an uploaded file."""
        self.say(self._offering.take_in(reading))

    def accept_file(self, unit: Unit, frame: Frame, now: float) -> None:
        """Add the demonstrations of the offered file; next to a built-in skill they open as a new one."""
        accepted = self._offering.accepted(unit, frame)
        if accepted is None:
            return
        if self.store.document.built_in:
            self.open(accepted.skill(), now)
        else:
            self.edit(accepted.join, f"add {accepted.name}", now=now)
        self.say(f"{accepted.name}: {accepted.summary}")

    def decline_file(self) -> None:
        """Forget the offered file."""
        self._offering.forget()
        self.say("")

    # --- playback ----------------------------------------------------------------------

    def accept_plan(self, plan: Plan) -> None:
        """Take over what the arm makes of a run; says the worst of what it cannot do, one run at a time."""
        words = judgement.warning(plan) if self.stage.accept(plan, self.model) else None
        if words is not None and (plan.run == self.stage.playback.run or not self.warning):
            self.say(words, warning=True)

    def play(self, playing: bool, now: float) -> None:
        """Start or pause the playback."""
        self._end_shows(now)
        self.stage.play(playing)

    def seek(self, time: float, now: float) -> None:
        """Move the playhead [s]."""
        self._end_shows(now)
        self.stage.seek(time)

    def play_trial(self, playing: bool, now: float) -> None:
        """Show what the arm did in the physical world, or no longer."""
        self.let_go(now)
        self.stage.play_trial(playing)

    def _end_shows(self, now: float) -> None:
        """End what moves the arm in place of the playhead."""
        self.amend(lambda a: a.end(now))
        self.stage.play_trial(False)

    # --- replay and correct ------------------------------------------------------------

    def start_replay(self, now: float) -> None:
        """Replay what the view names, and let the hand be pulled aside."""
        self.let_go(now)
        self.learned()
        self.amend(lambda a: a.start(self.view, self.model, now))

    def amend(self, act: Callable[[Amending], Said | None]) -> None:
        """Do something with the replay or the correction that waits, and say what came of it, or why not."""
        try:
            if (said := act(self.amending)) is not None:
                self.say(said[0], warning=said[1])
        except GcError as error:
            self.say(str(error), warning=True)

    def choose_run(self, run: int, now: float) -> None:
        """Play another reproduction from its beginning."""
        if 0 <= run < len(self.model.runs):
            self._end_shows(now)
            self.stage.cue(run, self.model)

    # --- pulls -------------------------------------------------------------------------

    def drag(self, drag: Drag) -> None:
        """Begin, continue or end a pull."""
        if self.amending.replays:
            return self.amend(lambda a: a.drag(drag))
        held = self._held
        if drag.phase == "start" and (held is None or not held.goes_on(drag)):
            self.let_go(drag.time)
            if (asked := self.amending.settle(drag.node, drag.time)) is not None:
                return self.say(asked[0], warning=asked[1])
            self.learned()  # an edit or a release may not be learned yet
            held = self._held = self._grab(drag)
        elif held is not None and held.takes(drag):
            held.follow(drag)
        if held is not None and isinstance(held.pull, HandPull):
            self.stage.driver.pulled(held.pull.advance(drag.time))

    def _grab(self, drag: Drag) -> Grasp | None:
        pull: Pull | HandPull | LinePull | None
        if drag.node == "/hand":
            pull = self.take_hand(drag.time, records=not drag.aside)
            self.stage.pause()
        else:
            line = self.amending.grab(drag, self.model, self.view.pull_width)
            pull = line or gesture.pull_on(drag.node, drag.grabbed, self.model, drag.eye)
        if pull is None:
            return None
        self.say("")
        self.look(thing=gesture.thing_held(drag.node))
        if drag.node.startswith("/start/"):
            self.stage.cue(int(drag.node.rpartition("/")[2]), self.model, playing=False)
        held = Grasp(pull, gesture.begin(drag), self.model, drag.time, self.view.redo)
        held.aim(drag)
        return held

    def take_hand(self, now: float, *, records: bool, pointed: bool = True) -> HandPull:
        """Take the hand, open or closed as it is shown; what was played may have left it otherwise."""
        self.leading.forget()
        hand = replace(self.stage.hand, gripper=float(self.view.gripper_closed))
        return HandPull(self.stage.arm, hand, now, records=records, pointed=pointed)

    def hold(self, held: Grasp) -> None:
        """Take this for what is held from now on."""
        self._held = held

    def let_go(self, now: float) -> None:
        """End whatever is pulled, and keep what it did; what cannot be kept is said, and stops nobody."""
        self._end_shows(now)
        held, self._held = self._held, None
        try:
            if held is not None:
                self._keep(held, now)
        except GcError as error:
            self.say(str(error), warning=True)

    def _keep(self, held: Grasp, now: float) -> None:
        pull = held.pull
        if isinstance(pull, HandPull):
            self.leading.let_go(pull, pull.finish(), now, held.before)
        elif isinstance(pull, LinePull):
            self.amend(lambda a: a.pulled(pull, held.track.displacement))
        elif held.moved >= SLIP:
            self.store.edit(lambda d: pull.apply(d, held.track.displacement), pull.name, now=now)
            if pull.node.startswith("/start/"):
                self.stage.cue(self.stage.playback.run, self.model, playing=True)

    # --- time --------------------------------------------------------------------------

    def tick(self, now: float, dt: float) -> bool:
        """Move on what moves by itself; returns whether something still moves."""
        if self.amending.replays:
            if self.amending.tick(now):
                self.amend(lambda a: a.end(now))
            return True
        held = self._held
        if held is not None and held.ends is not None and now >= held.ends:
            self.let_go(now)
            held = None
        if held is not None and isinstance(held.pull, HandPull):
            if held.ends is None and now - held.followed > PATIENCE:
                self.stage.driver.pulled(held.pull.advance(now))
            if held.pull.arrived(now):
                self.let_go(now)
            return True
        moving = self.stage.tick(now, dt, self.model, self.view)
        return moving or held is not None
