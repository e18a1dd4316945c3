"""What a change does to the runs that are shown, in words."""

from typing import Any, Final

import numpy as np
from scipy.spatial import KDTree  # pyright: ignore[reportMissingTypeStubs]  # SciPy has none

from app import bending
from app.document import FloatArray
from app.model import Model
from gc_core.arrays import interpolated

CHANGED_BY: Final = 0.001
"""A run that moves less than this does not change [m]."""
FINELY: Final = 8
"""Places a sample of a line to which the distance is measured."""


def on_runs(before: Model, after: Model) -> str:
    """Say how many of the shown runs change, and by how much: a part of a sentence, empty without runs."""
    former, runs = before.runs, after.runs
    if not former or len(former) != len(runs):
        return ""
    pairs = zip(former, runs, strict=True)
    moved = [_apart(a.reproduction.positions, b.reproduction.positions) for a, b in pairs]
    count = sum(length > CHANGED_BY for length in moved)
    if count == 0:
        return "no run changes"
    noun, verb = "run" if len(runs) == 1 else "runs", "changes" if count == 1 else "change"
    return f"{count} of {len(runs)} {noun} {verb}, by up to {bending.length(max(moved))}"


def _apart(one: FloatArray, other: FloatArray) -> float:
    """How far paths (N, 3), (M, 3) are apart at most [m]: at the same time, or from the nearest place."""
    if len(one) == len(other):
        return float(np.linalg.norm(one - other, axis=1).max())
    return max(_farthest(one, other), _farthest(other, one))


def _farthest(path: FloatArray, line: FloatArray) -> float:
    finely = np.linspace(0.0, len(line) - 1.0, FINELY * len(line))
    known = np.arange(len(line), dtype=np.float64)
    dense = np.stack([interpolated(finely, known, line[:, axis]) for axis in range(3)], axis=1)
    tree: Any = KDTree(dense)
    return float(np.max(tree.query(path)[0]))
