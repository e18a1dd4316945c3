"""One person's session: builds its parts and joins them; outlives its socket.

The desk does the work, the actor gives it one thing at a time to do, viewers show it,
workers plan the arm's path, read files and save. The code in the address names the
session, so that a reload finds it again.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Sequence, Set
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, TypeVar

import viser

from app import viewers
from app.actor import TICK, Actor, Latest, run
from app.arm.protocol import Arm
from app.comparing import Comparing
from app.desk import Desk
from app.document import Document, FloatArray
from app.examining import Examining
from app.exporting import Exporting
from app.inquiry import Inquirer
from app.keeping import Keeper
from app.lesson import tried
from app.library import Kept, Library
from app.plans import Plans
from app.seat import Seat
from app.shaping import Shaping
from app.shelving import Known, Prepare, Shelving
from app.store import State
from app.trials import Trials
from app.viewers import Viewer
from gc_core import GcError

FORGOTTEN_AFTER: Final = 60.0
"""A session without a tab is closed after this time [s]."""
LONGEST_TICK: Final = 0.2
"""After a longer time nothing was moving, and the clock starts anew [s]."""
IDLE_AFTER: Final = 180.0
"""Playback stops when nobody has done anything for this time [s]."""

T = TypeVar("T")
_log = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class Workshop:
    """What all sessions of one server share."""

    library: Library
    workers: Executor
    make_arm: Callable[[], Arm]
    skills_folder: Path
    skills: Sequence[tuple[str, str]]
    """Names and titles of the built-in skills."""


class Session:
    """A desk, its mailbox, and the tabs that look at it."""

    def __init__(self, code: str, opened: Kept | Document, workshop: Workshop, said: str = "") -> None:
        self.code: Final = code
        self.workshop: Final = workshop
        self.empty_since: float | None = time.monotonic()
        self._arm = workshop.make_arm()
        try:
            self._desk = Desk(opened.history if isinstance(opened, Kept) else opened, self._arm)
        except BaseException:
            self._arm.close()
            raise
        self._viewers: dict[int, Viewer] = {}
        self._works: int | None = None
        self._logged = ""
        if said:
            self._desk.say(said)
        self._tried = opened.tried if isinstance(opened, Kept) else frozenset[str]()
        self._drawn: Document | None = None
        self._known: dict[int, Known] = {}
        self._time = self._touched = self.clock()
        self._actor = Actor(tick=self._tick, draw=self._draw, report=self._report, name=f"session-{code}")
        self._plans = Plans(self._desk, workshop.workers, self._actor, workshop.make_arm)
        self._shelving = Shelving(code, workshop.library, workshop.workers, self._actor)
        jobs = (workshop.workers, self._actor)
        self._keeper = Keeper(
            code, self._desk, workshop.library, jobs, clock=self.clock, on_saved=self._shelving.look_up
        )
        self._files = Latest(workshop.workers, self._actor)
        self._shaping = Shaping(workshop.workers, self._actor)
        self.exporting = Exporting(workshop.workers, self._actor, workshop.make_arm)
        self._examining = Examining(workshop.workers, self._actor, workshop.make_arm)
        self.trials = Trials(workshop.workers, self._actor, workshop.make_arm)
        self.comparing = Comparing(workshop.workers, self._actor, workshop.make_arm)
        self._inquirer = Inquirer(Latest(workshop.workers, self._actor), workshop.make_arm)

    @staticmethod
    def clock() -> float:
        """Session time [s]."""
        return time.monotonic()

    # --- tabs --------------------------------------------------------------------------

    def attach(self, client: viser.ClientHandle, known: Known) -> None:
        """Show the session in a tab whose browser has these codes; the first one works, others watch."""
        self._actor.post(lambda: self._attach(client, known))

    def detach(self, client_id: int) -> None:
        """A tab has gone; what it was pulling is let go."""
        self._actor.post(lambda: self._detach(client_id))

    def reconcile(self, present: Callable[[], Set[int]]) -> None:
        """Forget tabs that are not connected any more, whatever was missed.

        ``present`` is asked in the mailbox: a tab that came since it was posted is not forgotten.
        """

        def action() -> None:
            for client_id in self._viewers.keys() - present():
                self._detach(client_id)
            if not self._viewers and self.empty_since is None:
                self.empty_since = time.monotonic()

        self._actor.post(action)

    def close(self) -> None:
        """Finish, save and stop."""
        self.trials.give_up()
        self.comparing.give_up()
        self._actor.post(lambda: self._keeper.finish(self._tried))
        self._actor.post(self._arm.close)  # there, so that nobody else gets it while it is still used
        self._actor.close()

    def _attach(self, client: viser.ClientHandle, known: Known) -> None:
        self.empty_since = None
        self._known[client.client_id] = known
        self._touched = self.clock()

        @client.camera.on_update
        async def _(camera: viser.CameraHandle) -> None:
            position = camera.position
            self._actor.post(lambda: self._look_from(client.client_id, position))

        if self._works is None:
            self._work(client)
        else:
            self._watch(client)

    def _work(self, client: viser.ClientHandle) -> None:
        self._works = client.client_id
        self._shelving.look_for(self._known[client.client_id])
        seat = Seat(self, client.client_id)
        self._show(viewers.working(client, seat, self._arm, self.clock, self.workshop.skills))

    def _watch(self, client: viser.ClientHandle) -> None:
        def take_over() -> None:
            self._actor.post(lambda: self._take_over(client))

        def copy(made: Callable[[str], None]) -> None:
            self._actor.post(lambda: self._copy(made))

        seat = Seat(self, client.client_id)
        self._show(viewers.watching(client, seat, self._arm, self.clock, take_over=take_over, copy=copy))

    def _copy(self, made: Callable[[str], None]) -> None:
        document = self._desk.store.document
        run(self.workshop.workers, self._actor, lambda: self._shelving.copy(document), made)

    def _show(self, viewer: Viewer) -> None:
        self._viewers[viewer.client.client_id] = viewer
        self._look_from(viewer.client.client_id, viewer.client.camera.position)

    def _look_from(self, client_id: int, position: FloatArray) -> None:
        viewer = self._viewers.get(client_id)
        if viewer is not None:
            viewer.scene.look_from(position)

    def _take_over(self, client: viser.ClientHandle) -> None:
        if client.client_id == self._works or client.client_id not in self._viewers:
            return
        former = None if self._works is None else self._viewers.get(self._works)
        self._desk.let_go(self.clock())
        if former is not None:
            self._watch(former.client)
        self._work(client)

    def _detach(self, client_id: int) -> None:
        self._viewers.pop(client_id, None)
        self._known.pop(client_id, None)
        if not self._viewers:
            self.empty_since = time.monotonic()
        if client_id == self._works:
            self._works = None
            waiting = next(iter(self._viewers.values()), None)
            if waiting is not None:
                self._work(waiting.client)
            self._desk.let_go(self.clock())  # last: it may say that what was pulled cannot be kept

    # --- what a tab asks for -----------------------------------------------------------

    def post(self, client_id: int, act: Callable[[Desk, float], None]) -> None:
        """Do something on the desk, if the tab is the one that works."""

        def action() -> None:
            if client_id == self._works:
                self._touched = self.clock()
                act(self._desk, self._touched)

        self._actor.post(action)

    def at(self, client_id: int, do: Callable[[Viewer], None]) -> None:
        """Do something in one tab, whether it works or watches."""

        def action() -> None:
            viewer = self._viewers.get(client_id)
            if viewer is not None:
                do(viewer)

        self._actor.post(action)

    def look_into(self, client_id: int, name: str, read: Callable[[], T], done: Callable[[T], None]) -> None:
        """Read an uploaded file in a worker."""

        def look(desk: Desk, _: float) -> None:
            desk.say(f"Reading {name} …")
            self._files.submit(read, done)

        self.post(client_id, look)

    def shelve(self, client_id: int, prepare: Prepare) -> None:
        """Let a worker do something with the saved skills, and say what came of it."""
        self.post(client_id, lambda desk, now: self._shelving.do(prepare(desk, now), desk.say))

    def tell(self, client_id: int, message: str) -> None:
        """Show a warning to the tab that works here, if it is this one."""
        self.post(client_id, lambda desk, _: desk.say(message, warning=True))

    # --- in the mailbox ----------------------------------------------------------------

    def _tick(self) -> bool:
        now = self.clock()
        dt, self._time = now - self._time, now
        if not self._viewers:
            return False
        if now - self._touched > IDLE_AFTER:
            self._desk.stage.pause()
        moving = self._desk.tick(now, dt if dt < LONGEST_TICK else TICK)
        return moving or self._keeper.saving != "saved"

    def _draw(self) -> None:
        try:
            self._show_state(self._state())
        finally:  # what cannot be learned or drawn is saved all the same
            self._keeper.follow(self._tried)

    def _show_state(self, state: State) -> None:
        try:
            for viewer in tuple(self._viewers.values()):
                viewer.draw(state)
        finally:
            leading = self._desk.leading
            self._inquirer.ask(leading.inquiry, lambda of, to: leading.answered(of, to, self.clock()))
            self._plans.follow(state)
            self._shaping.follow(state)
            self.exporting.follow(self._desk)
            self._examining.follow(state)

    def _state(self) -> State:
        state = self._desk.state()
        self._tried |= tried(self._drawn, state)
        self._drawn = state.document
        return replace(
            state,
            shapes=self._shaping.shapes,
            parcel=self.exporting.parcel,
            postures=self._examining.postures,
            compared=self.comparing.follow(state),
            saved=self._keeper.saving,
            shelf=self._shelving.shelf,
            tried=self._tried,
        )

    def _report(self, error: Exception) -> None:
        if isinstance(error, GcError):
            self._desk.say(str(error), warning=True)
        else:
            if repr(error) != self._logged:  # a drawing that fails, fails at every tick
                _log.error("session %s", self.code, exc_info=error)
            self._logged = repr(error)
            self._desk.say(
                "Something went wrong in the program, not in what you did. Your work is safe; go on, or "
                "reload the page if something looks wrong.",
                warning=True,
            )
