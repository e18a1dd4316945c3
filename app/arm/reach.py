"""Where a tool can be at all: a shell about the shoulder, above the table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arm.protocol import FloatArray


@dataclass(frozen=True)
class Shell:
    """The reachable region of an arm, a little smaller than the truth."""

    shoulder: tuple[float, float, float]
    """Centre of the shell [m]."""
    inner: float
    """Nearer to the shoulder than this the arm is in its own way [m]."""
    outer: float
    """The arm does not reach farther from the shoulder than this [m]."""
    table: float
    """The tool stays above this height [m]."""

    def project(self, targets: FloatArray, *, above_table: bool = True) -> FloatArray:
        """Move targets to the nearest place in the shell.

        Parameters
        ----------
        targets : (..., 3) array
            Wanted positions [m].
        above_table : bool
            Also lift what is below the table; files may describe another table.

        Returns
        -------
        (..., 3) array
            Positions in the shell; unchanged where they were in it.
        """
        lifted = np.array(targets, dtype=np.float64)
        if above_table:
            lifted[..., 2] = np.maximum(lifted[..., 2], self.table)
        outwards = lifted - np.asarray(self.shoulder)
        radius = np.linalg.norm(outwards, axis=-1, keepdims=True)
        wanted = np.clip(radius, self.inner, self.outer)
        # At the shoulder itself no direction is nearest: forwards, where the arm rests.
        ahead = np.array([0.0, -1.0, 0.0])
        direction = np.where(radius > 1e-6, outwards / np.maximum(radius, 1e-6), ahead)
        return np.where(wanted == radius, lifted, np.asarray(self.shoulder) + wanted * direction)

    def outside(self, target: FloatArray) -> str | None:
        """Say in words why a target (3,) lies outside the shell; None when it lies inside."""
        below = self.table - float(target[2])
        radius = float(np.linalg.norm(target - np.asarray(self.shoulder)))
        reasons = [
            (below, "below the table"),
            (radius - self.outer, f"{length_in_words(radius - self.outer)} beyond reach"),
            (self.inner - radius, "too close to its own base"),
        ]
        excess, words = max(reasons)
        return words if excess > 0.0 else None

    def worst(self, targets: FloatArray) -> str | None:
        """Say why the target of several (K, 3) that is farthest outside lies there; None: all lie inside."""
        radii = np.linalg.norm(targets - np.asarray(self.shoulder), axis=1)
        excess = np.maximum(np.maximum(radii - self.outer, self.inner - radii), self.table - targets[:, 2])
        return self.outside(targets[int(np.argmax(excess))])


def length_in_words(metres: float) -> str:
    """Write a length as a person would say it: ``8 mm``, ``12 cm``, ``1.5 m``."""
    if metres < 0.01:
        return f"{max(1, round(1000 * metres))} mm"
    if metres < 1.0:
        return f"{round(100 * metres)} cm"
    return f"{metres:.1f} m"
