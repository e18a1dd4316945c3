"""Rules that cannot all be obeyed at once: which ones, and where."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from gc_core.arrays import BoolArray, FloatArray
from gc_core.constraints import Constraint, planes_at
from gc_core.half_spaces import CORNERS, TOGETHER, left_behind, step_to_allowed

SAME_WAY = 0.2
"""Normals that all go so much (cosine) with their sum look the same way."""


@dataclass(frozen=True)
class Contradiction:
    """Rules that have no place in common along a part of the way."""

    names: tuple[str, ...]
    """Of the rules, in their order."""
    stations: tuple[int, int]
    """The first and the last station where it is so."""
    count: int
    """How many stations there are."""

    def sentence(self) -> str:
        """Say it to a person.

        Returns
        -------
        str
            Which rules, where, and what to do.
        """
        first, last = (round(100.0 * station / max(self.count - 1, 1)) for station in self.stations)
        where = f"at {first} %" if first == last else f"from {first} to {last} %"
        names = f"{', '.join(self.names[:-1])} and {self.names[-1]}"
        stations = "station {}" if self.stations[0] == self.stations[1] else "stations {} to {}"
        return (
            f"{names} contradict each other {where} of the way ({stations.format(*self.stations)}): no place "
            f"obeys {'both' if len(self.names) == 2 else 'all of them'}, so runs go between. "
            "Switch one of them off."
        )


def contradictions(
    constraints: Sequence[Constraint], stations: int = 200, names: Sequence[str] | None = None
) -> tuple[Contradiction, ...]:
    """Find rules that cannot all be obeyed at once.

    Parameters
    ----------
    constraints : sequence of Constraint
        Those that are on.
    stations : int
        How many stations along the way to look at, at least 2.
    names : sequence of str, optional
        How to call the rules, where not by their own names.

    Returns
    -------
    tuple of Contradiction
        One for each smallest set of two to four rules whose half-spaces have no place in common, or none that
        is near, at some station. Four are enough: by Helly's theorem half-spaces of which any four
        have a place in common all have one.
    """
    called = [one.name or f"Rule {number}" for number, one in enumerate(constraints, 1)]
    called = called if names is None else names
    parts = np.linspace(0.0, 1.0, stations)
    planes = [planes_at(constraint, parts) for constraint in constraints]
    known = np.zeros((stations, 0), dtype=bool)
    sets: list[frozenset[int]] = []
    found: list[Contradiction] = []
    for size in range(2, min(CORNERS + 1, len(planes)) + 1):
        for chosen in combinations(range(len(planes)), size):
            some = [planes[index] for index in chosen]
            apart = np.logical_and.reduce([one.active for one in some])
            smaller = [index for index, former in enumerate(sets) if former < set(chosen)]
            apart &= ~known[:, smaller].any(axis=1)
            apart[apart] = _without_common_place(
                np.stack([one.points[apart] for one in some], axis=1),
                np.stack([one.normals[apart] for one in some], axis=1),
            )
            if apart.any():
                where = np.flatnonzero(apart)
                span = (int(where[0]), int(where[-1]))
                found.append(Contradiction(tuple(called[index] for index in chosen), span, stations))
                sets.append(frozenset(chosen))
                known = np.column_stack((known, apart))
    return tuple(found)


def _without_common_place(points: FloatArray, normals: FloatArray) -> BoolArray:
    """Tell where half-spaces (P, C, 3) have no place in common (P,)."""
    # Where all planes look the same way there is a place ahead of all, and nothing to compute.
    total = normals.sum(axis=1)
    ahead = np.einsum("pci,pi->pc", normals, total).min(axis=1)
    apart = ahead < SAME_WAY * np.maximum(np.sqrt(np.einsum("pi,pi->p", total, total)), 1.0)
    if not apart.any():
        return apart
    points, normals = points[apart], normals[apart]
    behind = np.einsum("pci,pci->pc", points - points.mean(axis=1, keepdims=True), normals)
    apart[apart] = left_behind(step_to_allowed(behind, normals), behind, normals) > TOGETHER
    return apart
