"""What the arm makes of a run, in words: can it, when not and why, how fast, and how clear of what.

"The hand stays inside the tube" and "the whole arm clears the box" are two facts and two
sentences: the first is about one point and what was taught, the second about every link.
"""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from app.arm.physics_words import clear_of_nearest, inside_tube, length_in_words
from app.arm.verdict import Problem
from app.store import Plan

CROWDED: Final = 0.02
"""An arm that is nearer to itself than this is worth a word [m]."""

TURNED: Final = 10.0
"""A tool that is turned otherwise by more than this is worth a word [degrees]."""


def problems(plan: Plan) -> tuple[Problem, ...]:
    """Give what the arm cannot do, the worst first; being slower than taught is none of it."""
    return tuple(problem for problem in plan.verdict.problems if problem.kind != "speed")


def when(plan: Plan, problem: Problem) -> str:
    """Say when a problem lasts, on the clock of the run: ``1.2-1.8 s``."""
    first, last = (f"{plan.reproduction.times[index]:.1f}" for index in (problem.first, problem.last))
    return f"{first} s" if first == last else f"{first}\N{EN DASH}{last} s"


def worst_at(plan: Plan, problem: Problem) -> float:
    """Give the time of the run at which a problem is worst [s]."""
    return float(plan.reproduction.times[problem.worst])


def warning(plan: Plan) -> str | None:
    """Say the worst problem of a run, and that there are more; None where the arm can do it."""
    found = problems(plan)
    if not found:
        return None
    which = "this run" if len(plan.source.runs) == 1 else f"run {plan.run + 1}"
    more = "" if len(found) == 1 else f" More of it is told in Try ({len(found)} places in all)."
    worst = found[0]
    return f"The arm cannot do {which} as it is: {when(plan, worst)}, {worst.what}. {worst.remedy}{more}"


def headline(plan: Plan) -> str:
    """Say whether the arm can do a run."""
    count = len(problems(plan))
    if not count:
        return f"The arm can do run {plan.run + 1}."
    places = "one place" if count == 1 else f"{count} places"
    return f"The arm cannot do run {plan.run + 1} as it is: {places}."


def facts(plan: Plan) -> tuple[str, ...]:
    """Say the rest of what is known about a run: tube, things, itself, pace; one sentence each."""
    times, verdict = plan.reproduction.times, plan.verdict
    said = [inside_tube(plan.ratios, times)]
    if verdict.nearest is not None and verdict.nearest.distance > 0.0:
        said.append(clear_of_nearest(verdict.nearest, times))
    if math.isfinite(verdict.self_distance) and 0.0 < verdict.self_distance < CROWDED:
        said.append(f"It comes within {length_in_words(verdict.self_distance)} of itself.")
    turned = 0.0 if verdict.path.turns is None else float(np.degrees(verdict.path.turns.max()))
    if turned > TURNED:
        said.append(f"Its tool is turned by up to {turned:.0f} degrees otherwise than shown.")
    return (*said, pace(plan))


def pace(plan: Plan) -> str:
    """Say how long a run takes as taught, and how long the arm needs."""
    if any(problem.kind == "leap" for problem in plan.verdict.problems):
        return f"Taught in {plan.taught:.1f} s."
    if plan.slowed:
        return f"Taught in {plan.taught:.1f} s; the arm needs {plan.clock[-1]:.1f} s."
    best = plan.verdict.timed.duration
    return (
        f"Taught in {plan.taught:.1f} s; the arm plays it in {plan.clock[-1]:.1f} s, and can in {best:.1f} s."
    )


def others(plans: Sequence[Plan], run: int) -> tuple[str, ...]:
    """Say of every other run that it cannot be done; nothing of those that can."""
    return tuple(
        f"{headline(plan)} {when(plan, problems(plan)[0])}: {problems(plan)[0].what}."
        for plan in plans
        if plan.run != run and problems(plan)
    )
