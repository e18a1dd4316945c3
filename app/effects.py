"""What a change does to the runs that are shown, in words."""

from typing import Final

import numpy as np

from app import bending
from app.model import Model

CHANGED_BY: Final = 0.001
"""A run that moves less than this does not change [m]."""


def on_runs(before: Model, after: Model) -> str:
    """Say how many of the shown runs change, and by how much: a part of a sentence, empty without runs."""
    former, runs = before.runs, after.runs
    if not former or len(former) != len(runs):
        return ""
    moved = [
        float(np.linalg.norm(a.reproduction.positions - b.reproduction.positions, axis=1).max())
        if len(a.reproduction.positions) == len(b.reproduction.positions)
        else np.inf
        for a, b in zip(former, runs, strict=True)
    ]
    count = sum(length > CHANGED_BY for length in moved)
    if count == 0:
        return "no run changes"
    by = f", by up to {bending.length(max(moved))}" if np.isfinite(max(moved)) else ""
    noun, verb = "run" if len(runs) == 1 else "runs", "changes" if count == 1 else "change"
    return f"{count} of {len(runs)} {noun} {verb}{by}"
