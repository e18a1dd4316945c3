"""A path of the tool with its times: what an arm replays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arm.errors import ArmInputError
from app.arm.protocol import FloatArray


@dataclass(frozen=True, eq=False)
class Route:
    """What is replayed: any path of the tool with its times."""

    times: FloatArray
    """(K,) strictly increasing; K >= 2 [s]."""
    positions: FloatArray
    """(K, 3) tool; straight in between [m]."""
    joints: FloatArray | None = None
    """(K, J) that bring the tool there, as planned; None: found on the way, above the table [rad]."""

    def __post_init__(self) -> None:
        for name in ("times", "positions", "joints"):
            if getattr(self, name) is not None:
                array = np.array(getattr(self, name), dtype=np.float64)
                array.setflags(write=False)
                object.__setattr__(self, name, array)
        count = len(self.times) if self.times.ndim == 1 else 0
        planned = self.joints is None or (self.joints.ndim == 2 and len(self.joints) == count)
        if count < 2 or self.positions.shape != (count, 3) or not planned:
            wanted = "(K,) times, (K, 3) positions and (K, J) joints, if any, K >= 2"
            raise ArmInputError("a route", wanted, (self.times.shape, self.positions.shape))
        numbers = [array for array in (self.times, self.positions, self.joints) if array is not None]
        if not (all(np.isfinite(array).all() for array in numbers) and np.all(np.diff(self.times) > 0.0)):
            raise ArmInputError("a route", "finite numbers and times that increase", "others")

    def at(self, time: float) -> FloatArray:
        """(3,) where the hand belongs at a time of the route [m]."""
        return _between(time, self.times, self.positions)

    def planned(self, time: float) -> FloatArray | None:
        """(J,) joints planned for a time of the route [rad]; None where there is no plan."""
        return None if self.joints is None else _between(time, self.times, self.joints)


def _between(time: float, times: FloatArray, rows: FloatArray) -> FloatArray:
    """Interpolate rows (K, n) at a time."""
    return np.array([np.interp(time, times, rows[:, column]) for column in range(rows.shape[1])])
