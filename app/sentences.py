"""What the desk says to a person: what happened, why, and what to do, in centimetres and seconds."""

from collections.abc import Sequence
from datetime import datetime
from typing import Final

import numpy as np

from app import bending
from app.document import FloatArray
from app.drawn import Drawn, TakenBack
from gc_core import Demonstration

SHORT_OF: Final = 0.10
"""A demonstration that ends farther from the goal was perhaps let go too early [m]."""
NO_WAY_BACK: Final = "The arm found no clear way back, so it stays here."


def too_short(drawn: Drawn) -> str:
    """A slip of the hand was not kept."""
    return (
        f"That was only {100 * drawn.length:.1f} cm, so it was not kept. Pull the hand through the whole "
        "motion and let go at its end."
    )


def slight(drawn: Drawn, motion: float) -> str:
    """A pull was kept that is hardly a demonstration of a motion [m]."""
    return (
        f"That was only {bending.length(drawn.length)} of the {bending.length(motion)} motion. It is kept, "
        "and not learned from until you switch it on (Teach)."
    )


def demonstrated(
    drawn: Drawn, learned_from: Sequence[Demonstration], kept: TakenBack, goal: FloatArray | None
) -> str:
    """A demonstration was kept, perhaps not where it was drawn, or it ended far from the goal (3,) [m]."""
    if kept.muted:
        return (
            "This demonstration is kept, but muted: where you drew it the tube is turned inside out, so it "
            "cannot be taken back to where the landmarks stood. Put them back (Move) and show it again."
        )
    if kept.carried:
        return (
            f"That was a demonstration of {drawn.times[-1]:.1f} s. Landmarks are moved, so it is kept where "
            "it would have been before (red line), and the tube takes it along to here."
        )
    more = "Show it once more, a little differently."
    if len(learned_from) >= 3:
        more = f"The tube holds {len(learned_from)} now."
    short = 0.0 if goal is None else float(np.linalg.norm(drawn.positions[-1] - goal))
    if short > SHORT_OF:
        more = (
            f"It ended {100.0 * short:.0f} cm from the goal, and the tube goes there, too. "
            "If that was not meant, undo it, and pull the hand all the way."
        )
    n_held = sum(shown.orientations is not None for shown in learned_from)
    if 0 < n_held < len(learned_from):
        more = (
            f"The tool was held in {n_held} of {len(learned_from)}: runs hold it once all were shown so. "
            "Mute or delete the others."
        )
    return f"That was a demonstration of {drawn.times[-1]:.1f} s. {more}"


def when(time: datetime, now: datetime) -> str:
    """Say when something was, on the server's clock: 14:05 of this day, 3 Nov 14:05 of another."""
    time, now = time.astimezone(), now.astimezone()
    if time.date() == now.date():
        return f"{time:%H:%M}"
    return f"{time.day} {time:%b %H:%M}" if time.year == now.year else f"{time.day} {time:%b %Y}"
