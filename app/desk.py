"""The work on one skill: what every action, pull and moment does.

No viser, no threads, no clock: time comes in with each call, so that a test can play
a whole session in no time. The session calls it from its mailbox and draws `state`.
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from app import attention, edits, gesture, handpull, player, sentences
from app.actions import Drag
from app.arm.protocol import Arm
from app.document import Document, FloatArray, View
from app.driver import Driver, Lead, lead_at
from app.files import Frame, Reading, Unit
from app.gesture import Pull
from app.grasp import Grasp
from app.handpull import HandPull
from app.model import Model, learn
from app.store import Hand, Offer, Plan, Playback, State, Store

SLIP: Final = 0.001
"""A pull shorter than this was a slip of the hand and changes nothing [m]."""
SHORTEST: Final = 0.03
"""A demonstration shorter than this was a slip of the hand [m]."""
PATIENCE: Final = 0.08
"""A pulled hand moves with the events of the pull; after a longer silence it moves on by itself [s]."""
LONGEST_WAY: Final = 3.0
"""A hand that is moved by numbers is given this time to arrive, which takes it anywhere [s]."""
GLIDE: Final = 0.7
"""In a loop the arm goes back to the start in what is left of the rest after this part of it."""


class Desk:
    """One skill being worked on, with the arm that plays it."""

    def __init__(self, document: Document, arm: Arm) -> None:
        """Open a document; its first reproduction plays."""
        self.store = Store(document)
        self.view = View()
        self.model = learn(document)
        self.plan: Plan | None = None
        self.offer: Offer | None = None
        self.message, self.warning = document.about, False
        self.playback = Playback(playing=True)
        self._arm = arm
        self._driver = Driver(arm)
        self._held: Grasp | None = None
        self.saved = self.saving = document
        self._reading: Reading | None = None
        self._refresh()

    # --- what is drawn -----------------------------------------------------------------

    def state(self) -> State:
        """Take a snapshot for panels and scene."""
        document = self._learned()
        message, warning = self._words()
        return State(
            document=document,
            view=self.view,
            model=self.model,
            hand=self._driver.hand,
            playback=replace(self.playback, time=min(self.playback.time, self.playback.duration)),
            plan=self.plan if self.plan is not None and self.plan.source is self.model else None,
            dragging=None if self._held is None else self._held.node,
            undo_name=self.store.undo_name,
            redo_name=self.store.redo_name,
            message=message,
            warning=warning,
            offer=self.offer,
            saved=self.saved is self.store.document,
        )

    def _learned(self) -> Document:
        """Give what is shown, and see to it that it is learned."""
        document = self.store.document
        if self._held is not None:
            document = self._held.shown(document)
        if self.model.source is not document:
            self.model = learn(document, self.model, coarse=self._held is not None)
            self._refresh()
        return document

    def _words(self) -> tuple[str, bool]:
        said = attention.urgent(self._driver.hand, self._held, self.model, self._arm)
        return (self.message, self.warning) if said is None else said

    def say(self, message: str, *, warning: bool = False) -> None:
        """Show a sentence."""
        self.message, self.warning = message, warning

    def _refresh(self) -> None:
        """Fit the playback to the runs of the present model."""
        runs = self.model.runs
        run = min(self.playback.run, max(len(runs) - 1, 0))
        duration = float(runs[run].reproduction.times[-1]) if runs else 0.0
        self.playback = player.with_duration(replace(self.playback, run=run), duration)

    # --- edits -------------------------------------------------------------------------

    def edit(
        self, f: Callable[[Document], Document], name: str, *, now: float, key: str | None = None
    ) -> None:
        """Make one undo step."""
        self.let_go(now)
        if self.store.edit(f, name, now=now, key=key):
            self.say("")

    def undo(self, now: float) -> None:
        """Take the last step back."""
        self.let_go(now)
        name = self.store.undo()
        self.say("There is nothing to undo." if name is None else f"Undone: {name}.")

    def redo(self, now: float) -> None:
        """Do the last undone step again."""
        self.let_go(now)
        name = self.store.redo()
        self.say("There is nothing to redo." if name is None else f"Done again: {name}.")

    def open(self, document: Document, now: float) -> None:
        """Put another skill on the desk; can be undone. In an empty one the hand goes home."""
        self.let_go(now)
        self.store.replace(document, f"open {document.title}", now=now)
        self.playback = Playback(playing=bool(document.demonstrations))
        if document.demonstrations:
            self._driver.lead()
        else:
            self._driver.released(self._driver.hand, self._arm.home, now)
        self.say(document.about)

    def look(self, **changes: Any) -> None:
        """Change what is looked at."""
        self.view = replace(self.view, **changes)

    def toggle_gripper(self) -> None:
        """Open or close the hand; recorded while it is pulled."""
        self.look(gripper_closed=not self.view.gripper_closed)
        gripper = float(self.view.gripper_closed)
        if self._held is not None and isinstance(self._held.pull, HandPull):
            self._held.pull.set_gripper(gripper)
        self._driver.grip(gripper)

    # --- files -------------------------------------------------------------------------

    def offer_reading(self, reading: Reading) -> None:
        """Show what is in an uploaded file."""
        self._reading = reading
        self.offer = Offer(
            reading.name,
            reading.summary,
            reading.unit,
            reading.unit_reason,
            reading.frame,
            reading.frame_reason,
        )
        self.say(f"Check what is in {reading.name}, then accept it.")

    def accept_file(self, unit: Unit, frame: Frame, now: float) -> None:
        """Take over the demonstrations of the offered file.

        They join a skill of one's own; next to a built-in one they open as a new skill.
        """
        reading = self._reading
        if reading is None:
            return
        demonstrations = reading.accepted(unit, frame)
        self.decline_file()
        if self.store.document.built_in:
            self.open(edits.skill_of(Path(reading.name).stem, demonstrations), now)
        else:
            self.edit(lambda d: edits.add_demonstrations(d, demonstrations), f"add {reading.name}", now=now)
        self.say(f"{reading.name}: {reading.summary_in(unit)}")

    def decline_file(self) -> None:
        """Forget the offered file."""
        self._reading = self.offer = None
        self.say("")

    # --- playback ----------------------------------------------------------------------

    def play(self, playing: bool) -> None:
        """Start or pause."""
        self.playback = player.play(self.playback, playing)
        self._driver.lead()

    def pause(self) -> None:
        """Stop playing because nobody is there."""
        self.playback = player.play(self.playback, False)

    def accept_plan(self, plan: Plan) -> None:
        """Take over a joint path from the worker; says where the arm cannot follow."""
        self.plan = plan
        words = sentences.unreached(plan.path)
        if words is not None and plan.source is self.model:
            self.say(words, warning=True)

    def seek(self, time: float) -> None:
        """Move the playhead; the arm goes there."""
        self.playback = player.seek(self.playback, time)
        self._driver.lead()

    def choose_run(self, run: int) -> None:
        """Play another reproduction from its beginning."""
        if 0 <= run < len(self.model.runs):
            self.playback = replace(self.playback, run=run, time=0.0)
            self._refresh()
            self._driver.lead()

    # --- pulls -------------------------------------------------------------------------

    def drag(self, drag: Drag) -> None:
        """Begin, continue or end a pull."""
        held = self._held
        if drag.phase == "start" and (held is None or not held.goes_on(drag)):
            self.let_go(drag.time)
            self._learned()  # an edit or a release may not be learned yet
            held = self._held = self._grab(drag)
        elif held is not None and held.node == drag.node:
            held.follow(drag)
        if held is not None and isinstance(held.pull, HandPull):
            self._driver.pulled(held.pull.advance(drag.time))

    def _grab(self, drag: Drag) -> Grasp | None:
        pull: Pull | HandPull | None
        if drag.node == "/hand":
            pull = self._take_hand(drag.time, records=not drag.aside)
            self.playback = replace(self.playback, playing=False)
        else:
            pull = gesture.pull_on(drag.node, drag.grabbed, self.model, self.view.pull_width)
        if pull is None:
            return None
        self.say("")
        if drag.node.startswith("/start/"):
            run = int(drag.node.rpartition("/")[2])
            self.playback = replace(self.playback, playing=False, time=0.0, run=run)
            self._refresh()
            self._driver.lead()
        held = Grasp(pull, gesture.begin(drag), self.model, drag.time)
        held.aim(drag)
        return held

    def _take_hand(self, now: float, *, records: bool) -> HandPull:
        """Take the hand, open or closed as it is shown; what was played may have left it otherwise."""
        hand = replace(self._driver.hand, gripper=float(self.view.gripper_closed))
        return HandPull(self._arm, hand, now, records=records)

    def let_go(self, now: float) -> None:
        """End whatever is pulled, and keep what it did."""
        held, self._held = self._held, None
        if held is None:
            return
        pull = held.pull
        if isinstance(pull, HandPull):
            self._let_hand_go(pull, pull.finish(), now, held.before)
        elif held.moved >= SLIP:
            self.store.edit(lambda d: pull.apply(d, held.track.displacement), pull.name, now=now)
            if pull.node.startswith("/start/"):
                self.playback = player.play(replace(self.playback, time=0.0), True)

    def _let_hand_go(self, pull: HandPull, hand: Hand, now: float, among: Model) -> None:
        self._driver.released(hand, pull.begins_at.joints if pull.records else None, now)
        if not pull.records:
            self.say("The next demonstration begins here.")
            return
        drawn = pull.drawn()
        if drawn.length < SHORTEST:
            self.say(sentences.too_short(drawn), warning=True)
            return
        shown = handpull.taken_back(handpull.demonstration(drawn), among)
        self.store.edit(lambda d: handpull.added(d, shown), "demonstrate", now=now)
        learned_from = sum(not shown.muted for shown in self.store.document.demonstrations)
        self.say(sentences.demonstrated(drawn, learned_from, shown), warning=shown.muted)

    def move_hand(self, position: FloatArray, now: float) -> None:
        """Move the hand, and the start of the next demonstration, without recording."""
        self.let_go(now)
        self.playback = replace(self.playback, playing=False)
        pull = self._take_hand(now, records=False)
        pull.aim(now, edits.point(position))
        self._let_hand_go(pull, pull.finish(LONGEST_WAY), now, self.model)

    # --- time --------------------------------------------------------------------------

    def tick(self, now: float, dt: float) -> bool:
        """Move on what moves by itself; returns whether something still moves."""
        held = self._held
        if held is not None and held.ends is not None and now >= held.ends:
            self.let_go(now)
            held = None
        if held is not None and isinstance(held.pull, HandPull):
            if held.ends is None and now - held.followed > PATIENCE:
                self._driver.pulled(held.pull.advance(now))
            return True
        self.playback = player.advance(self.playback, dt, speed=self.view.speed, loop=self.view.loop)
        moving = self._driver.tick(now, dt, self._lead())
        return moving or held is not None or self.playback.playing

    def _lead(self) -> Lead | None:
        """Find where the playhead wants the arm; in the rest of a loop it glides back to the start."""
        runs, playback = self.model.runs, self.playback
        if not runs:
            return None
        fits = self.plan is not None and self.plan.source is self.model and self.plan.run == playback.run
        path = self.plan.path if self.plan is not None and fits else None
        time = 0.0 if playback.time > playback.duration + GLIDE * player.REST else playback.time
        return lead_at(time, runs[playback.run].reproduction, path)
