"""Trials in a physical world, one at a time for a session: made in a worker, the newest wins."""

from collections.abc import Callable
from concurrent.futures import Executor

from app.actor import Actor, Latest
from app.arm.protocol import Arm
from app.desk import Desk
from app.simulating import SupersededError, simulate
from app.store import Task
from app.trial import Trial


class Trials:
    """Lets a worker play runs in a physical world, and shows on a stage how far it is and what came of it."""

    def __init__(self, executor: Executor, actor: Actor, make_arm: Callable[[], Arm]) -> None:
        self._jobs = Latest(executor, actor)
        self._actor, self._make_arm = actor, make_arm
        self._wanted: Task | None = None

    def begin(self, desk: Desk, now: float) -> None:
        """Play the run of a desk; one that is under way is given up."""
        desk.let_go(now)
        desk.learned()
        task = self._wanted = desk.stage.task(desk.model)
        if task is None:
            return
        desk.stage.accept_trial(Trial(task.model, task.run))

        def watch(share: float) -> None:
            if self._wanted is not task:
                raise SupersededError
            self._actor.post(lambda: accept(Trial(task.model, task.run, share)))

        def job() -> Trial | None:
            try:
                return simulate(task, self._make_arm, watch)
            except SupersededError:
                return None

        def accept(trial: Trial | None) -> None:
            if self._wanted is task and trial is not None:
                desk.stage.accept_trial(trial)

        self._jobs.submit(job, accept)

    def give_up(self) -> None:
        """Nobody waits any more."""
        self._wanted = None
