"""What a person is shown of a file before it is accepted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.document import FloatArray
from app.files.recording import ASSUMED_RATE, Checked, Unit
from app.files.units import METRES, Frame, FrameGuess, UnitGuess, bounds, converted, guess_frame, guess_unit
from gc_core import Demonstration


@dataclass(frozen=True, eq=False)
class Reading:
    """A file's demonstrations as they stand in it, and what they probably mean."""

    name: str
    """The file's name, without its folder."""
    demonstrations: tuple[Demonstration, ...]
    """In the file's own unit, which ``unit`` only guesses."""
    unit: Unit
    unit_reason: str
    frame: Frame
    """Where they should stand, for the guessed unit."""
    frame_reason: str
    size: FloatArray
    """(3,) extent along x, y, z in the file's unit."""
    samples: tuple[int, ...]
    """One count a demonstration."""
    durations: tuple[float, ...]
    """One a demonstration [s]."""
    times_in_file: bool
    """Otherwise 100 samples a second are assumed."""
    repeated: int
    """Samples left out because their time was that of the sample before."""

    @property
    def summary(self) -> str:
        """One line for a teacher, for the guessed unit."""
        return self.summary_in(self.unit)

    def summary_in(self, unit: Unit) -> str:
        """One line for a teacher, for a unit."""
        n = len(self.demonstrations)
        what = "1 demonstration" if n == 1 else f"{n} demonstrations"
        centimetres = " x ".join(f"{100.0 * METRES[unit] * extent:.0f}" for extent in self.size)
        assumed = f" (no times in the file: {ASSUMED_RATE:.0f} samples a second assumed)"
        clock = "" if self.times_in_file else assumed
        left_out = f", {self.repeated} repeated samples left out" if self.repeated else ""
        return (
            f"{what} of {_span(self.durations)} s{clock}, {_span(self.samples)} samples each{left_out}; "
            f"{centimetres} cm, read as {unit}."
        )

    def accepted(self, unit: Unit | None = None, frame: Frame | None = None) -> list[Demonstration]:
        """Bring the demonstrations into metres and the wanted frame.

        Parameters
        ----------
        unit, frame : optional
            What the person chose; None: what was guessed.
        """
        return converted(self.demonstrations, unit or self.unit, frame or self.frame)


def describe(name: str, found: Checked, stated: Unit | None, times_in_file: bool) -> Reading:
    """Say what a file's demonstrations are."""
    low, high = bounds(found.demonstrations)
    unit: UnitGuess = guess_unit(high - low, stated)
    frame: FrameGuess = guess_frame(converted(found.demonstrations, unit.unit, "as recorded"))
    return Reading(
        name=name,
        demonstrations=found.demonstrations,
        unit=unit.unit,
        unit_reason=unit.reason,
        frame=frame.frame,
        frame_reason=frame.reason,
        size=high - low,
        samples=tuple(len(d.times) for d in found.demonstrations),
        durations=tuple(float(d.times[-1]) for d in found.demonstrations),
        times_in_file=times_in_file,
        repeated=found.repeated,
    )


def _span(values: tuple[float, ...] | tuple[int, ...]) -> str:
    low, high = np.min(values), np.max(values)
    return f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
