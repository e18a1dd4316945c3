"""Has every run checked by the arm, one after the other in a worker; the one that is played comes first."""

from collections.abc import Callable
from concurrent.futures import Executor

from app.actor import Actor, Latest
from app.arm.conditions import Conditions
from app.arm.protocol import Arm
from app.desk import Desk
from app.planning import plan_run
from app.store import Plan, State
from gc_core import Reproduction


class Plans:
    """Asks for what the desk lacks, while nothing is dragged."""

    def __init__(self, desk: Desk, executor: Executor, actor: Actor, make_arm: Callable[[], Arm]) -> None:
        self._desk, self._make_arm = desk, make_arm
        self._jobs = Latest(executor, actor)
        self._asked: tuple[Reproduction, Conditions] | None = None

    def follow(self, state: State) -> None:
        """Have the next run checked that was not yet."""
        model, stage = state.model, self._desk.stage
        waiting = () if state.dragging is not None else stage.unplanned(model)
        if not waiting:
            return
        run, conditions, near = waiting[0], stage.playing_conditions, stage.begins_near()
        asked = (model.runs[run].reproduction, conditions)
        if self._asked == asked:
            return
        self._asked = asked

        def job() -> Plan:
            arm = self._make_arm()
            try:
                return plan_run(arm, model, run, conditions, near)
            finally:
                arm.close()

        self._jobs.submit(job, lambda plan: self._planned(plan, asked))

    def _planned(self, plan: Plan, asked: tuple[Reproduction, Conditions]) -> None:
        if self._asked == asked:  # a job that failed stays asked for: it would fail again
            self._asked = None
        self._desk.accept_plan(plan)
