"""One thing at a time, in order, whatever goes wrong; no test here waits for a clock."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor

import pytest

from app.actor import STALEST, Actor, Latest

SOON = 5.0
"""Longer than anything here takes [s]."""


class Notebook:
    """What an actor did, and the moments at which to look."""

    def __init__(self) -> None:
        self.done: list[object] = []
        self.errors: list[Exception] = []
        self.reported = threading.Event()
        self.draws = 0
        self.ticks = 0
        self.ticks_left = 0
        self.drawing = self._nothing

    def tick(self) -> bool:
        self.ticks += 1
        self.ticks_left -= 1
        return self.ticks_left > 0

    def report(self, error: Exception) -> None:
        self.errors.append(error)
        self.reported.set()

    def draw(self) -> None:
        self.draws += 1
        self.drawing()

    def _nothing(self) -> None:
        pass


@pytest.fixture
def notes() -> Notebook:
    return Notebook()


@pytest.fixture
def actor(notes: Notebook) -> Iterator[Actor]:
    made = Actor(tick=notes.tick, draw=notes.draw, report=notes.report, name="test")
    yield made
    made.close()


def settle(actor: Actor) -> None:
    """Wait until all that was posted is done."""
    done = threading.Event()
    actor.post(done.set)
    assert done.wait(SOON)


def fail(error: Exception) -> Callable[[], None]:
    def action() -> None:
        raise error

    return action


def test_actions_run_in_the_order_in_which_they_were_posted(actor: Actor, notes: Notebook) -> None:
    for number in range(500):
        actor.post(lambda number=number: notes.done.append(number))

    settle(actor)
    assert notes.done == list(range(500))


def test_actions_of_many_threads_run_one_at_a_time(actor: Actor) -> None:
    counter = {"value": 0}

    def count() -> None:
        before = counter["value"]
        counter["value"] = before + 1

    threads = [threading.Thread(target=lambda: [actor.post(count) for _ in range(200)]) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()

    settle(actor)
    assert counter["value"] == 800


def test_an_exception_is_reported_and_the_next_action_runs(actor: Actor, notes: Notebook) -> None:
    error = ValueError("broken")
    actor.post(fail(error))
    actor.post(lambda: notes.done.append("after"))

    settle(actor)
    assert (notes.errors, notes.done) == ([error], ["after"])


def test_an_exception_in_the_drawing_is_reported_and_the_next_action_runs(
    actor: Actor, notes: Notebook
) -> None:
    error, drawn = ValueError("broken"), threading.Event()
    notes.drawing = fail(error)
    actor.post(lambda: None)
    settle(actor)
    notes.drawing = drawn.set
    settle(actor)

    assert drawn.wait(SOON)
    assert set(notes.errors) == {error}


def test_an_exception_in_the_report_itself_does_not_end_it() -> None:
    notes = Notebook()
    actor = Actor(tick=notes.tick, draw=notes.draw, report=lambda _: fail(OSError("too"))(), name="test")

    actor.post(fail(ValueError("broken")))
    settle(actor)
    actor.post(lambda: notes.done.append("after"))
    actor.close()

    assert notes.done == ["after"]


def test_it_ticks_until_nothing_moves(actor: Actor, notes: Notebook) -> None:
    quiet = threading.Event()
    notes.drawing = lambda: quiet.set() if notes.ticks_left <= 0 else None
    notes.ticks_left = 4

    actor.post(lambda: None)

    assert quiet.wait(SOON)
    assert notes.ticks >= 4


def test_nothing_is_drawn_while_newer_actions_wait(actor: Actor, notes: Notebook) -> None:
    began, go = threading.Event(), threading.Event()
    actor.post(lambda: (began.set(), go.wait(SOON)))
    assert began.wait(SOON)
    drawn_before: list[int] = []
    for _ in range(50):
        actor.post(lambda: drawn_before.append(notes.draws))

    go.set()
    settle(actor)

    # The first action may have waited long enough for a drawing; the fifty take no time.
    assert drawn_before[-1] - drawn_before[0] <= 1


def test_under_a_flood_of_actions_it_still_draws(
    actor: Actor, notes: Notebook, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = {"s": 1000.0}
    monkeypatch.setattr("app.actor.time.monotonic", lambda: now["s"])
    drawn_at: list[float] = []
    notes.drawing = lambda: drawn_at.append(now["s"])
    flooded = threading.Event()

    def act(left: int) -> None:
        now["s"] += 0.02
        actor.post(lambda: act(left - 1) if left else flooded.set())  # the mailbox is never empty

    actor.post(lambda: act(100))
    assert flooded.wait(SOON)

    during = [moment for moment in drawn_at if moment > 1000.0]
    assert len(during) >= 10
    gaps = [later - former for former, later in itertools.pairwise(during)]
    assert max(gaps) <= STALEST + 0.05


def test_closing_runs_what_was_posted(notes: Notebook) -> None:
    actor = Actor(tick=notes.tick, draw=notes.draw, report=notes.report, name="test")
    for number in range(100):
        actor.post(lambda number=number: notes.done.append(number))

    actor.close()

    assert notes.done == list(range(100))


def test_it_can_be_closed_from_within(notes: Notebook) -> None:
    actor = Actor(tick=notes.tick, draw=notes.draw, report=notes.report, name="test")
    closed = threading.Event()
    actor.post(lambda: (actor.close(), closed.set()))

    assert closed.wait(SOON)
    assert notes.errors == []


# --- slow jobs ----------------------------------------------------------------------


@pytest.fixture
def workers() -> Iterator[Executor]:
    with ThreadPoolExecutor(2) as executor:
        yield executor


def test_a_job_runs_in_the_worker_and_its_result_arrives_in_the_actor(
    actor: Actor, workers: Executor
) -> None:
    seen: list[tuple[str, str]] = []
    arrived = threading.Event()

    def done(worker: str) -> None:
        seen.append((worker, threading.current_thread().name))
        arrived.set()

    Latest(workers, actor).submit(lambda: threading.current_thread().name, done)

    assert arrived.wait(SOON)
    assert seen[0][1] == "test"
    assert seen[0][0] != "test"


def test_only_the_newest_of_the_waiting_jobs_is_run(actor: Actor, workers: Executor) -> None:
    latest, began, go, last = (
        Latest(workers, actor),
        threading.Event(),
        threading.Event(),
        threading.Event(),
    )
    ran: list[int] = []

    def job(number: int) -> int:
        ran.append(number)
        if number == 0:
            began.set()
            go.wait(SOON)
        return number

    latest.submit(lambda: job(0), lambda _: None)
    assert began.wait(SOON)
    for number in range(1, 10):
        latest.submit(lambda number=number: job(number), lambda n: last.set() if n == 9 else None)
    go.set()

    assert last.wait(SOON)
    assert ran == [0, 9]


def test_jobs_of_one_kind_never_overlap(actor: Actor, workers: Executor) -> None:
    latest, free = Latest(workers, actor), threading.Lock()
    overlapped: list[int] = []
    done = threading.Semaphore(0)

    def job() -> None:
        if not free.acquire(blocking=False):
            overlapped.append(1)
            return
        free.release()

    for _ in range(50):
        latest.submit(job, lambda _: done.release())
        assert done.acquire(timeout=SOON)

    assert overlapped == []


def test_a_job_that_fails_is_reported_and_the_next_one_runs(
    actor: Actor, notes: Notebook, workers: Executor
) -> None:
    latest, error, arrived = Latest(workers, actor), ValueError("broken"), threading.Event()

    latest.submit(fail(error), notes.done.append)
    assert notes.reported.wait(SOON)
    latest.submit(lambda: 1, lambda _: arrived.set())

    assert arrived.wait(SOON)
    assert (notes.errors, notes.done) == ([error], [])


class ByHand(Executor):
    """An executor that runs a job when told to."""

    def __init__(self) -> None:
        self.waiting: list[Callable[[], object]] = []

    def submit(self, fn: Callable[..., object], /, *args: object, **kwargs: object) -> Future:
        self.waiting.append(lambda: fn(*args, **kwargs))
        return Future()


def test_a_worker_is_asked_for_once_however_many_jobs_wait(actor: Actor, notes: Notebook) -> None:
    by_hand = ByHand()
    latest = Latest(by_hand, actor)

    for number in range(5):
        latest.submit(lambda number=number: number, notes.done.append)
    asked = len(by_hand.waiting)
    by_hand.waiting.pop()()
    settle(actor)

    assert (asked, notes.done) == (1, [4])
