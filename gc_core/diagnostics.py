"""What happened while a cylinder was made: facts ready to be put into words."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gc_core.arrays import BoolArray, FloatArray, IntArray, read_only_fields


@dataclass(frozen=True, eq=False)
class Diagnostics:
    """Facts about an encoding or a generalization; demonstrations in the order given."""

    names: tuple[str, ...]
    """How each demonstration is called."""
    align_by: str
    """How the demonstrations were put in correspondence."""
    trimmed_start: FloatArray
    """(n,) time cut at the start, where the tool stood still [s]."""
    trimmed_end: FloatArray
    """(n,) time cut at the end, where the tool stood still [s]."""
    duplicates: IntArray
    """(n,) samples that repeat the place before them."""
    missed: BoolArray
    """(N, n) where a demonstration does not cross the section plane near its station; projected there."""
    smoothed: BoolArray
    """(N,) where the directrix leaves out a small hook of the mean path."""
    centre_outside: BoolArray
    """(N,) where the directrix is outside of the effective points' hull; the section reaches to it."""
    minimum_half_width: float
    """Least distance of the boundary from the directrix [m]."""
    assumed_width: bool
    """Whether the width was stated rather than shown, because there is one demonstration only."""
    crossing: BoolArray
    """(N,) where a section cuts its neighbour: the tube is wider than its bend."""
    tilt: FloatArray
    """(N,) angle between section normal and tangent, 0 where nothing had to be repaired [rad]."""
    folded: BoolArray
    """(N,) where the map that bent the tube turns space inside out."""

    def __post_init__(self) -> None:
        read_only_fields(self)

    def sentences(self) -> tuple[str, ...]:
        """Say what a person should know.

        Returns
        -------
        tuple of str
            Nothing where all is well.
        """
        said = [
            f"{name}: {cut:.1f} s of standing still were left out."
            for name, cut in zip(self.names, self.trimmed_start + self.trimmed_end, strict=True)
            if cut >= 0.05
        ]
        if self.assumed_width:
            said.append(
                "One demonstration shows no width, so the tube is "
                f"{self.minimum_half_width * 200.0:.3g} cm wide everywhere. "
                "Show the motion again to tell where it may vary."
            )
        tilted = self.tilt > np.radians(1.0)
        for count, words in (
            (self.missed.any(axis=1).sum(), "slices are not reached by every demonstration"),
            (
                tilted.sum(),
                f"slices are tilted, by up to {np.degrees(self.tilt.max()):.0f}\N{DEGREE SIGN}, "
                "so as not to cut their neighbours",
            ),
            (self.crossing.sum(), "slices cut their neighbour, where the tube is wider than its bend"),
            (self.folded.sum(), "slices are turned inside out by the moved landmarks; move them less"),
        ):
            if count:
                said.append(f"{int(count)} of {len(self.missed)} {words}.")
        if self.smoothed.any():
            said.append("The middle line leaves out a small hook, where the hand went back and forth.")
        return tuple(said)
