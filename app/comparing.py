"""Comparisons of methods, one at a time for a session: made in a worker, the newest wins."""

from __future__ import annotations

from collections.abc import Callable, Generator
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from app.actor import Actor, Latest
from app.arm.protocol import Arm
from app.baselines import methods
from app.compared import LOOKS, TUBE, Compared
from app.comparison import Comparison, comparing, task_of
from app.comparison_svg import comparison_svg
from app.desk import Desk
from app.document import View
from app.model import Model
from app.store import State
from app.surroundings import conditions_of
from gc_core import GcError

STOPPED: Final = "It was stopped, since the skill was being changed."


class Comparing:
    """Lets a worker compare methods, and knows how far it is and what came of it."""

    def __init__(self, executor: Executor, actor: Actor, make_arm: Callable[[], Arm]) -> None:
        self._jobs = Latest(executor, actor)
        self._actor, self._make_arm = actor, make_arm
        self._wanted: Compared | None = None
        self._known: Compared | None = None
        self._seen: tuple[Model, object] | None = None
        """The model, and how the tool was held, that were last seen beside what is known."""

    def begin(self, desk: Desk, now: float) -> None:
        """Compare on the skill of a desk what its view names; what is under way is given up."""
        desk.let_go(now)
        desk.learned()
        asked = self._wanted = self._known = asked_for(desk.model, desk.view)
        count = desk.view.compare_count

        def accept(known: Compared) -> None:
            if self._wanted is asked:
                self._known, self._seen = known, None

        def end() -> None:
            if (
                self._wanted is asked and self._known is not None and self._known.doing
            ):  # a bug, told elsewhere
                self._known = replace(self._known, doing="")

        def job() -> None:
            try:
                for known in steps(asked, count, self._make_arm):
                    if self._wanted is not asked:
                        return
                    self._actor.post(partial(accept, known))
            finally:
                self._actor.post(end)

        self._jobs.submit(job, lambda _: None)

    def follow(self, state: State) -> Compared | None:
        """Give what is to be shown beside a state; while something is pulled, nothing is computed."""
        known = self._known
        if known is None:
            return None
        if state.dragging is not None and known.doing:
            self.give_up()
            known = self._known = replace(known, doing="", problem=STOPPED)
        seen = state.model, state.view.tool
        if self._seen is None or any(a is not b for a, b in zip(seen, self._seen, strict=True)):
            self._seen = seen
            outdated = not known.holds(state.model, state.view)
            if outdated != known.outdated:
                known = self._known = replace(known, outdated=outdated)
        return known if known.about(state.model) else None

    def give_up(self) -> None:
        """Nobody waits any more."""
        self._wanted = None


def asked_for(model: Model, view: View) -> Compared:
    """Say what shall be compared: the methods that a view names, from the starts that it names."""
    names = (TUBE, *(name for name in LOOKS if name in view.methods and name != TUBE))
    starts = None
    if view.compare_count == 0 and model.runs:
        places = model.source.starts or [model.start_taken_back(run.start) for run in model.runs]
        starts = np.array(places)
    return Compared(model, names, starts, conditions_of(model, view), doing="…")


def steps(asked: Compared, count: int, make_arm: Callable[[], Arm]) -> Generator[Compared]:
    """Compare, and say after each step what is known.

    Parameters
    ----------
    asked : Compared
        What shall be compared.
    count : int
        Number of starts, where it names none.
    make_arm : callable
        Gives an arm to this thread; it is asked only where there are obstacles.

    Yields
    ------
    Compared
        The last one has nothing left to do.
    """
    arm, known = make_arm() if asked.heeded.obstacles else None, asked
    try:
        task = replace(
            task_of(asked.source.source),
            demonstrations=asked.source.demonstrations,
            arm=None if arm is None else arm.under(asked.heeded),
            starts=asked.starts,
        )
        rounds = 1 if arm is None else 2
        made = comparing(task, methods(asked.names, task.tube), count, repeats=1)
        for step, found in enumerate(made):
            known = _known(known, found, step, rounds)
            yield known
    except GcError as error:
        yield replace(known, problem=str(error), doing="")
    finally:
        if arm is not None:
            arm.close()


def _known(former: Compared, found: Comparison, step: int, rounds: int) -> Compared:
    """What is known after a step: the methods follow one another, then the arm along the runs of each."""
    names, drawn = former.names, former.found is not None and found.runs.keys() == former.found.runs.keys()
    return replace(
        former,
        found=found,
        picture=former.picture if drawn else comparison_svg(found, former.source.demonstrations, names),
        doing="" if step == rounds * len(names) else doing(names, step),
        share=step / (rounds * len(names)),
    )


def doing(names: tuple[str, ...], step: int) -> str:
    """Say which step is next."""
    number = step % len(names)
    what = LOOKS[names[number]].label
    whole = "" if step < len(names) else "the arm is led along it, "
    return f"{what}: {whole}{number + 1} of {len(names)}"
