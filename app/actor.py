"""One thing at a time: the mailbox that everything of a session runs in.

viser calls back on its event loop and on a pool of threads; nothing there may wait or
change anything. Callbacks post actions; one thread runs them in order, draws when no
newer action waits, and ticks while something moves. Slow jobs run in a worker and
come back as actions. Errors end here and nowhere else.
"""

import logging
import queue
import threading
import time
from collections.abc import Callable
from concurrent.futures import Executor
from typing import Final, TypeAlias, TypeVar

Action: TypeAlias = Callable[[], None]

TICK: Final = 0.04
"""Between two ticks while something moves [s]."""
STALEST: Final = 0.1
"""Under a flood of actions something is drawn at least this often [s]."""

_T = TypeVar("_T")
_log = logging.getLogger(__name__)


class Actor:
    """Runs a session's actions one after the other on a thread of its own."""

    def __init__(
        self, *, tick: Callable[[], bool], draw: Action, report: Callable[[Exception], None], name: str
    ) -> None:
        """Start the thread.

        Parameters
        ----------
        tick : callable
            Moves on what moves by itself; returns whether it wants to be called again.
        draw : callable
            Shows the outcome; called when the mailbox is empty after an action or a tick.
        report : callable
            Told every exception of an action, a tick or a drawing.
        name : str
            Of the thread.
        """
        self._tick, self._draw, self._report = tick, draw, report
        self._mailbox: queue.SimpleQueue[Action | None] = queue.SimpleQueue()
        self._drawn = 0.0
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def post(self, action: Action) -> None:
        """Run an action after those that were posted before; returns at once."""
        self._mailbox.put(action)

    def close(self, timeout: float = 5.0) -> None:
        """Run what was posted, then stop; waits for the thread unless called from it."""
        self._mailbox.put(None)
        if threading.current_thread() is not self._thread:
            self._thread.join(timeout)

    def _run(self) -> None:
        next_tick: float | None = None
        while True:
            try:
                wait = None if next_tick is None else max(0.0, next_tick - time.monotonic())
                action = self._mailbox.get(timeout=wait)
            except queue.Empty:
                action = _nothing
            if action is None:
                return
            self._guard(action)
            now = time.monotonic()
            if next_tick is None or now >= next_tick:
                moving = self._guard(self._tick)
                next_tick = now + TICK if moving else None
            if self._mailbox.empty() or now - self._drawn > STALEST:
                self._guard(self._draw)
                self._drawn = time.monotonic()

    def _guard(self, call: Callable[[], _T]) -> _T | None:
        try:
            return call()
        except Exception as error:  # the one place: a session goes on whatever went wrong
            try:
                self._report(error)
            except Exception:
                _log.exception("The error could not be reported.")
            return None


def _nothing() -> None:
    pass


class Latest:
    """Slow jobs of one kind in a worker: only the newest one that waits is run."""

    def __init__(self, executor: Executor, actor: Actor) -> None:
        self._executor, self._actor = executor, actor
        self._lock = threading.Lock()
        self._waiting: Action | None = None
        self._busy = False

    def submit(self, job: Callable[[], _T], done: Callable[[_T], None]) -> None:
        """Run ``job`` in the worker, then ``done`` with its result in the actor.

        A job that still waits when a newer one is submitted is forgotten.
        """
        with self._lock:
            self._waiting = _whole(self._actor, job, done)
            if self._busy:
                return
            self._busy = True
        self._executor.submit(self._work)

    def _work(self) -> None:
        while True:
            with self._lock:
                job, self._waiting = self._waiting, None
                if job is None:
                    self._busy = False
                    return
            job()


def run(executor: Executor, actor: Actor, job: Callable[[], _T], done: Callable[[_T], None]) -> None:
    """Run a slow job in a worker, then ``done`` with its result in the actor; none is forgotten."""
    executor.submit(_whole(actor, job, done))


def _whole(actor: Actor, job: Callable[[], _T], done: Callable[[_T], None]) -> Action:
    def whole() -> None:
        try:
            result = job()
        except Exception as error:
            failure = error  # the name is gone when the action runs
            actor.post(lambda: _raise(failure))
        else:
            actor.post(lambda: done(result))

    return whole


def _raise(error: Exception) -> None:
    raise error
