"""Figs 11 and 12: a run is corrected, and the correction rules later runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from app.document import FloatArray
from app.figures import sheet as fig
from app.figures.subject import Subject, pulled
from app.figures.views import seen_across
from app.model import reproduce_whole
from gc_core import Constraint, Reproduction, constrain

PRESS: Final = 0.085
"""How far the upper run is pressed down, by its length [-]."""
HEIGHTS: Final = (0.95, 0.6, 0.3)
"""Of later runs above: how far from the middle line towards the boundary [-]."""
EVERY: Final = 5
"""Each so many stations have an arrow."""


@dataclass(frozen=True, eq=False)
class Pressed:
    """A run from high up, pressed down in its middle, and the run below it."""

    upper: Reproduction
    lower: Reproduction
    """Before the rule, too."""
    corrected: FloatArray
    """(K, 3) [m]."""
    lid: Constraint
    """The rule that the correction makes."""


def draw_matrix(subjects: tuple[Subject, ...]) -> Any:
    """Draw what the teacher moved: the refinement matrix V as arrows from a run to its correction.

    The upper run (dashed) is pressed down in its middle (green); each column of V is an arrow. The
    lower run is from the same tube.
    """
    subject = subjects[0]
    pressed = pressed_run(subject)
    figure, where = _sheet(subject, pressed.lower, "lower run")
    _before(where, [pressed.upper.positions])
    places, moves = pressed.upper.positions[::EVERY], pressed.lid.moves[::EVERY]
    fig.arrows(where, places, moves, width=0.0022)
    where.plot(pressed.corrected, color=fig.REFINED, linewidth=2.0, label="corrected", zorder=2.5)
    most = 100.0 * float(np.linalg.norm(pressed.lid.moves, axis=1).max())
    where.title(f"The refinement matrix V: what the teacher moved, at most {most:.1f} cm")
    return _finished(figure, where, subject)


def draw_obeying(subjects: tuple[Subject, ...]) -> Any:
    """Draw later runs: those above the rule are moved to it, the one below is as it was.

    Whether the lower run is the very same as before is found out, not assumed; a run that passes the
    rule's planes somewhere else, as on a loop, is moved too.
    """
    subject = subjects[0]
    pressed = pressed_run(subject)
    tube = subject.cylinder
    rim = tube.surface()[0, tube.surface()[0, :, 2].argmax()]
    free = [reproduce_whole(tube, tube.directrix[0] + part * (rim - tube.directrix[0])) for part in HEIGHTS]
    obeying = [constrain(run, [pressed.lid]) for run in free]
    lower = constrain(pressed.lower, [pressed.lid])
    untouched = ", untouched" if lower is pressed.lower else ""
    figure, where = _sheet(subject, lower, f"lower run{untouched}")
    _before(where, [run.positions for run in free])
    after = [run.positions for run in obeying]
    fig.lines(where, after, "obeying the rule", color=fig.REFINED, linewidth=1.8, zorder=2.4)
    every, before = [*obeying, lower], [*free, pressed.lower]
    moved = sum(run is not former for run, former in zip(every, before, strict=True))
    where.title(f"Later runs: {moved} of {len(every)} are moved by the rule")
    return _finished(figure, where, subject)


def pressed_run(subject: Subject) -> Pressed:
    """Let a teacher press the upper one of two runs down in its middle."""
    starts = subject.starts if len(subject.starts) > 1 else subject.above_and_below
    runs = [reproduce_whole(subject.cylinder, start) for start in starts[:2]]
    upper, lower = sorted(runs, key=lambda run: -float(run.positions[:, 2].mean()))
    corrected = pulled(upper.positions, PRESS)
    lid = Constraint.from_correction(upper, corrected, name="Lid")
    return Pressed(upper, lower, corrected, lid)


def _sheet(subject: Subject, lower: Reproduction, words: str) -> tuple[Any, fig.Space]:
    figure = fig.sheet(7.6, 3.0)
    where = fig.space(figure, figure.add_gridspec(1, 1)[0], seen_across(subject.cylinder))
    fig.tube(where, subject.cylinder)
    where.plot(lower.positions, color=fig.REPRODUCTION, linewidth=1.6, label=words)
    return figure, where


def _before(where: fig.Space, paths: list[FloatArray]) -> None:
    fig.lines(where, paths, "before", color=fig.INK, linewidth=0.9, linestyle="--")


def _finished(figure: Any, where: fig.Space, subject: Subject) -> Any:
    fig.scale_bar(where, fig.bar_for(subject.cylinder))
    fig.legend(figure)
    return figure
