"""Planes along a way, and what is left of them beyond the ends of their spans.

A plane that began abruptly would tear a run. Beyond a span it recedes from the run instead: every
run may go a little farther with each step, until the plane asks nothing of it any more.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from gc_core.arrays import BoolArray, FloatArray, fading
from gc_core.frames import arc_length
from gc_core.half_spaces import ALLOWED, step_to_allowed

FADE_LENGTH = 0.08
"""A plane recedes from where a run is held at the end of a span to where it asks nothing over this length,
or over as much as it recedes where that is more [m]."""

MOST_SPREAD = 4.0
"""Where an opposing plane pushes, over so many times that length as the edge of both goes faster than the
plane, up to this (planes at 165 degrees) [-]."""

_NEAREST = 1e-9
"""Least part of the way over which one of two ends gives way to the other [-]."""


@dataclass(frozen=True, eq=False)
class Planes:
    """The planes of one rule at K places along a skill."""

    points: FloatArray
    """(K, 3) [m]."""
    normals: FloatArray
    """(K, 3) unit, or 0 [-]."""
    lengths: FloatArray
    """(K,) how far the teacher moved the run [m]."""
    active: BoolArray
    """(K,) where there is a plane."""

    def behind(self, run: FloatArray) -> FloatArray:
        """Tell how far places (K, 3) lie behind the planes (K,), 0 where there is none [m]."""
        return np.where(self.active, self._depth(run), 0.0)

    def _depth(self, run: FloatArray) -> FloatArray:
        return np.einsum("ij,ij->i", self.points - run, self.normals)

    def ends(self, run: FloatArray) -> Iterator[_End]:
        """Go through the ends of the spans that have places beyond them."""
        gone, excess = arc_length(run), self._depth(run) - self.lengths
        edges = np.flatnonzero(np.diff(np.concatenate(([False], self.active, [False])).astype(np.int8)))
        for number, edge in enumerate(edges):
            begins = number % 2 == 0
            index = int(edge) if begins else int(edge) - 1
            before = int(edges[number - 1]) if number else 0
            after = int(edges[number + 1]) if number + 1 < len(edges) else len(run)
            beyond = slice(before, int(edge)) if begins else slice(int(edge), after)
            if beyond.start < beyond.stop:
                away = np.abs(gone[beyond] - gone[index])
                yield _End(self.normals[index], float(excess[index]), beyond, away)


@dataclass(frozen=True, eq=False)
class _End:
    """An end of a span, and the places beyond it."""

    normal: FloatArray
    """(3,) of the last plane [-]."""
    excess: float
    """How far the run is behind that plane, apart from what the teacher moved there [m]."""
    beyond: slice
    """Samples up to the next span."""
    away: FloatArray
    """(B,) how far these are along the run [m]."""

    def receding(self, others: FloatArray | None) -> tuple[FloatArray, FloatArray] | None:
        """Let the plane recede from where the run is held at the end to where it asks nothing.

        Parameters
        ----------
        others : (K, 3) array, optional
            Steps that other rules ask for; None: there are none [m].

        Returns
        -------
        two (B,) arrays or None
            How far the places are behind what is left of the plane [m], and how much counts of it, from 1 at
            the end to 0 [-]. None where nothing is asked.
        """
        slack, spread = (0.0, 1.0) if others is None else self._pushed(others[self.beyond])
        recedes = self.excess + slack
        if recedes <= 0.0:
            return None
        share = fading(np.minimum(self.away / (spread * max(FADE_LENGTH, recedes)), 1.0))
        return recedes * share - slack, share

    def _pushed(self, others: FloatArray) -> tuple[float, float]:
        """How far behind the plane others' steps (B, 3) near this end lead [m], and how narrow it is there.

        The second is by how many times the edge between the plane and theirs goes faster than the plane.
        """
        back = np.maximum(-others @ self.normal, 0.0)
        near = self.away <= MOST_SPREAD * max(FADE_LENGTH, self.excess + float(back.max(initial=0.0)))
        slack = float(back[near].max(initial=0.0))
        size = np.einsum("ij,ij->i", others, others)
        aside = np.sqrt(np.maximum(size - back**2, 0.0) / np.where(size > 0.0, size, 1.0))
        narrow = aside[near & (back > 0.0)].min(initial=1.0)
        return slack, float(1.0 / max(narrow, 1.0 / MOST_SPREAD))


def asked(run: FloatArray, planes: Sequence[Planes]) -> tuple[FloatArray, FloatArray]:
    """How far rules want the samples of a run moved, and in which directions.

    Parameters
    ----------
    run : (K, 3) array
        [m].
    planes : sequence of C Planes
        C >= 1.

    Returns
    -------
    behind : (K, C) array
        How far the samples are behind the planes; beyond the spans, behind what is left of these [m].
    normals : (K, C, 3) array
        Of the planes; 0 where there is none [-].

    Notes
    -----
    Where rules pull against each other, one that asks nothing of a run by itself may bind what the others
    moved. At its ends it would let go at once; so there it recedes as far as the others push.
    """
    alone = [_receding(run, one, None) for one in planes]
    behind = np.stack([depth for depth, _ in alone], axis=1)
    normals = np.stack([across for _, across in alone], axis=1)
    if not (behind > ALLOWED).any():
        return behind, normals
    against = [_against(run, planes, behind, normals, index) for index in range(len(planes))]
    for index, others in enumerate(against):
        if others is not None:
            behind[:, index], normals[:, index] = _receding(run, planes[index], others)
    return behind, normals


def _against(
    run: FloatArray, planes: Sequence[Planes], behind: FloatArray, normals: FloatArray, index: int
) -> FloatArray | None:
    """Steps (K, 3) that other rules ask for where one ends that they pull against; None: nowhere."""
    rest = [other for other in range(len(planes)) if other != index]
    depths, across = behind[:, rest], normals[:, rest]
    asks = depths > ALLOWED
    opposed = np.zeros(len(run), dtype=bool)
    if asks.any():
        for end in planes[index].ends(run):
            opposed[end.beyond] |= (asks[end.beyond] & (across[end.beyond] @ end.normal < 0.0)).any(axis=1)
    rows = np.flatnonzero(opposed)
    if not rows.size:
        return None
    steps = np.zeros_like(run)
    steps[rows] = step_to_allowed(depths[rows], across[rows])
    return steps


def _receding(run: FloatArray, planes: Planes, others: FloatArray | None) -> tuple[FloatArray, FloatArray]:
    """How far samples (K,) are behind the planes of one rule or what is left of them, and normals (K, 3)."""
    depth, normals = planes.behind(run), planes.normals.copy()
    weight, total, across = np.zeros(len(run)), np.zeros(len(run)), np.zeros_like(run)
    for end in planes.ends(run):
        receding = end.receding(others)
        if receding is None:
            continue
        left, share = receding
        mine = share / (1.0 - share + _NEAREST)
        weight[end.beyond] += mine
        total[end.beyond] += mine * left
        across[end.beyond] += mine[:, None] * end.normal
    size = np.sqrt(np.einsum("ij,ij->i", across, across))
    kept = size > 0.0
    depth[kept] = total[kept] / weight[kept]
    normals[kept] = across[kept] / size[kept, None]
    return depth, normals
