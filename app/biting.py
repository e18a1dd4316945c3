"""Which rules bite: the runs that would pass their planes, and where these are."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from app import bending, ruling
from app.document import FloatArray
from app.model import Model, Run
from gc_core import Constraint
from gc_core.arrays import remembered
from gc_core.constraints import planes_along

BITES: Final = 1e-6
"""A run this far behind a plane is held by it [m]."""


@dataclass(frozen=True, eq=False)
class Bite:
    """What one rule does to the runs that are shown."""

    rule: int
    """Its place in the document."""
    runs: tuple[int, ...]
    """Which runs would pass its planes; none where the rule is off."""
    depth: float
    """How far they would, at most [m]."""
    places: FloatArray
    """(P, 3) where they are held instead [m]."""
    normals: FloatArray
    """(P, 3) of the planes there, towards the allowed side [-]."""


@remembered
def bites(model: Model) -> tuple[Bite, ...]:
    """Find what each rule of a document does, in their order."""
    enabled = [index for index, rule in enumerate(model.source.rules) if rule.enabled]
    carried = dict(zip(enabled, model.constraints, strict=False))
    return tuple(_bite(index, carried.get(index), model.runs) for index in range(len(model.source.rules)))


def words(bite: Bite, model: Model) -> str:
    """Say what a rule does."""
    rule, count = model.source.rules[bite.rule], len(model.runs)
    runs = "run" if count == 1 else f"{count} runs"
    if not rule.enabled:
        return "It is off: runs go as if it were not there."
    if not bite.runs:
        none = "It does not touch the run" if count == 1 else f"It touches none of the {runs}"
        return f"{none}: nothing would pass its planes."
    which = "the run" if count == 1 else f"{len(bite.runs)} of the {runs}"
    return f"It holds {which} back, by up to {bending.length(bite.depth)}."


def where(rule: Constraint) -> str:
    """Say along which part of the way a rule holds."""
    parts = 100.0 * rule.parts[rule.active]
    return f"From {parts.min():.0f} % to {parts.max():.0f} % of the way." if len(parts) else ""


def shown(model: Model, rule: int | None) -> Constraint | None:
    """Give a rule where the landmarks stand, for its arrows; -1: the newest; None where there is none."""
    rules = model.source.rules
    if rule is None or not -len(rules) <= rule < len(rules):
        return None
    return ruling.carried((rules[rule].constraint,), model.registration)[0]


def _bite(index: int, constraint: Constraint | None, runs: tuple[Run, ...]) -> Bite:
    held: list[int] = []
    places, normals = [np.zeros((0, 3))], [np.zeros((0, 3))]
    deepest = 0.0
    for number, run in enumerate(runs):
        if constraint is None or run.reproduction is run.free:
            continue
        planes = planes_along(constraint, run.free.stations, run.free.positions)
        behind = planes.behind(run.free.positions)
        there = behind > BITES
        if there.any():
            held.append(number)
            deepest = max(deepest, float(behind.max()))
            places.append(run.reproduction.positions[there])
            normals.append(planes.normals[there])
    return Bite(index, tuple(held), deepest, np.concatenate(places), np.concatenate(normals))
