"""The work on one skill: what every action, pull and moment does.

No viser, no threads, no clock: time comes in with each call, so that a test can play
a whole session in no time. The session calls it from its mailbox and draws `state`.
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from app import edits, gesture, handpull, player
from app.actions import Drag
from app.arm.protocol import Arm
from app.document import Document, FloatArray, View
from app.driver import Driver, Lead, lead_at
from app.files import Frame, Reading, Unit
from app.gesture import Pull, Track
from app.handpull import HandPull
from app.model import Model, learn
from app.store import Offer, Plan, Playback, State, Store
from gc_core import GcError

SLIP: Final = 0.001
"""A pull shorter than this was a slip of the hand and changes nothing [m]."""
SHORTEST: Final = 0.03
"""A demonstration shorter than this was a slip of the hand [m]."""
UNREACHED: Final = 0.001
"""The arm plays a sample exactly when it comes this close [m]."""


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
        self._track: Track | None = None
        self._pull: Pull | HandPull | None = None
        self._ends: float | None = None
        self._before: Model = self.model
        self._preview: tuple[object, Document] = (None, document)
        self.saved = self.saving = document
        self._reading: Reading | None = None
        self._refresh()

    # --- what is drawn -----------------------------------------------------------------

    def state(self) -> State:
        """Take a snapshot for panels and scene."""
        document = self._learned()
        pull = self._pull
        message, warning = self._words()
        return State(
            document=document,
            view=self.view,
            model=self.model,
            hand=self._driver.hand,
            playback=replace(self.playback, time=min(self.playback.time, self.playback.duration)),
            plan=self.plan if self.plan is not None and self.plan.source is self.model else None,
            dragging=None if pull is None else pull.node,
            undo_name=self.store.undo_name,
            redo_name=self.store.redo_name,
            message=message,
            warning=warning,
            offer=self.offer,
            saved=self.saved is self.store.document,
        )

    def _learned(self) -> Document:
        """Give what is shown, and see to it that it is learned."""
        document = self._shown()
        if self.model.source is not document:
            self.model = learn(document, self.model)
            self._refresh()
        return document

    def _shown(self) -> Document:
        """Give the document as it would be if what is pulled were let go now."""
        pull = self._pull
        if pull is None:
            return self.store.document
        basis = pull.drawn() if isinstance(pull, HandPull) else self._track
        if self._preview[0] is not basis:
            self._preview = basis, self._preview[1]
            try:
                self._preview = basis, self._preview_of(pull)
            except GcError as error:  # pulled too far: what was shown last stays
                self.say(str(error), warning=True)
        return self._preview[1]

    def _preview_of(self, pull: Pull | HandPull) -> Document:
        document = self.store.document
        if isinstance(pull, HandPull):
            part = pull.preview(self._before.cylinder)
            return document if part is None else edits.add_demonstrations(document, [part])
        return document if self._track is None else pull.apply(document, self._track.displacement)

    def _words(self) -> tuple[str, bool]:
        shortfall = self._driver.hand.shortfall
        if shortfall is not None:
            return f"The arm cannot follow: {shortfall.reason}.", True
        if self.model.problem is not None:
            return self.model.problem, True
        return self.message, self.warning

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
        """Put another skill on the desk; can be undone."""
        self.let_go(now)
        self.store.replace(document, f"open {document.title}", now=now)
        self.playback = Playback(playing=bool(document.demonstrations))
        self._driver.lead()
        self.say(document.about)

    def look(self, **changes: Any) -> None:
        """Change what is looked at."""
        self.view = replace(self.view, **changes)

    def toggle_gripper(self) -> None:
        """Open or close the hand; recorded while it is pulled."""
        self.look(gripper_closed=not self.view.gripper_closed)
        gripper = float(self.view.gripper_closed)
        if isinstance(self._pull, HandPull):
            self._pull.set_gripper(gripper)
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
        self.say(f"{reading.name}: {reading.summary}")

    def decline_file(self) -> None:
        """Forget the offered file."""
        self._reading = self.offer = None

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
        missed = plan.path.errors > UNREACHED
        if plan.source is self.model and bool(np.any(missed)):
            share, worst = 100 * float(np.mean(missed)), 100 * float(np.max(plan.path.errors))
            self.say(
                f"The arm cannot reach {share:.0f} % of this run; it comes within {worst:.1f} cm. "
                "Move the start or the goal nearer to the arm.",
                warning=True,
            )

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
        if drag.phase == "start":
            self._grab(drag)
        if self._track is None or self._pull is None or self._pull.node != drag.node:
            return
        if drag.phase != "start":
            self._track = gesture.follow(self._track, drag)
        if isinstance(self._pull, HandPull):
            self._pull.aim(drag.time, self._track.displacement)
            self._driver.pulled(self._pull.advance(drag.time))
        self._ends = drag.time + gesture.GRACE if drag.phase == "end" else None

    def _grab(self, drag: Drag) -> None:
        if self._track is not None and self._goes_on(drag):  # Shift was pressed or let go in mid-drag
            self._track = gesture.follow(self._track, drag)
            return
        self.let_go(drag.time)
        self._preview = None, self._learned()  # an edit or a release may not be learned yet
        self._pull = self._grasp(drag)
        if self._pull is None:
            return
        self._track = gesture.begin(drag)
        self._before = self.model
        self.say("")
        if drag.node.startswith("/start/"):
            run = int(drag.node.rpartition("/")[2])
            self.playback = replace(self.playback, playing=False, time=0.0, run=run)
            self._refresh()
            self._driver.lead()

    def _goes_on(self, drag: Drag) -> bool:
        pull = self._pull
        if pull is None or pull.node != drag.node or self._ends is None or drag.time > self._ends:
            return False
        return not isinstance(pull, HandPull) or pull.records != drag.aside

    def _grasp(self, drag: Drag) -> Pull | HandPull | None:
        if drag.node != "/hand":
            return gesture.pull_on(drag.node, drag.grabbed, self.model, self.view.pull_width)
        self.playback = replace(self.playback, playing=False)
        return HandPull(self._arm, self._driver.hand, drag.time, records=not drag.aside)

    def let_go(self, now: float) -> None:
        """End whatever is pulled, and keep what it did."""
        pull, track = self._pull, self._track
        self._pull = self._track = self._ends = None
        if isinstance(pull, HandPull):
            self._let_hand_go(pull, now)
        elif pull is not None and track is not None and np.linalg.norm(track.displacement) >= SLIP:
            self.store.edit(lambda d: pull.apply(d, track.displacement), pull.name, now=now)
            if pull.node.startswith("/start/"):
                self.playback = player.play(replace(self.playback, time=0.0), True)

    def _let_hand_go(self, pull: HandPull, now: float) -> None:
        hand = pull.finish()
        self._driver.released(hand, pull.begins_at.joints if pull.records else None, now)
        if not pull.records:
            self.say("The next demonstration begins here.")
            return
        drawn = pull.drawn()
        if drawn.length < SHORTEST:
            self.say(
                f"That was only {100 * drawn.length:.1f} cm, so it was not kept. Pull the hand through the "
                "whole motion and let go at its end.",
                warning=True,
            )
            return
        shown = handpull.demonstration(drawn)
        self.store.edit(lambda d: edits.add_demonstrations(d, [shown]), "demonstrate", now=now)
        count = sum(not shown.muted for shown in self.store.document.demonstrations)
        more = "Show it once more, a little differently." if count < 3 else f"The tube holds {count} now."
        self.say(f"That was a demonstration of {drawn.times[-1]:.1f} s. {more}")

    def move_hand(self, position: FloatArray, now: float) -> None:
        """Move the hand, and the start of the next demonstration, without recording."""
        self.let_go(now)
        self.playback = replace(self.playback, playing=False)
        pull = HandPull(self._arm, self._driver.hand, now, records=False)
        pull.aim(now, edits.point(position) - pull.begins_at.position)
        self._let_hand_go(pull, now)

    # --- time --------------------------------------------------------------------------

    def tick(self, now: float, dt: float) -> bool:
        """Move on what moves by itself.

        Returns
        -------
        bool
            Whether something still moves.
        """
        if self._ends is not None and now >= self._ends:
            self.let_go(now)
        if isinstance(self._pull, HandPull):
            if self._ends is None:
                self._driver.pulled(self._pull.advance(now))
            return True
        self.playback = player.advance(self.playback, dt, speed=self.view.speed, loop=self.view.loop)
        moving = self._driver.tick(now, dt, self._lead())
        return moving or self._pull is not None or self.playback.playing

    def _lead(self) -> Lead | None:
        """Find where the playhead wants the arm; in the rest of a loop it glides back to the start."""
        runs, playback = self.model.runs, self.playback
        if not runs:
            return None
        fits = self.plan is not None and self.plan.source is self.model and self.plan.run == playback.run
        path = self.plan.path if self.plan is not None and fits else None
        time = 0.0 if playback.time > playback.duration + 0.5 * player.REST else playback.time
        return lead_at(time, runs[playback.run].reproduction, path)
