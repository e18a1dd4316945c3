"""How the arm would hold itself along each demonstration: asked once for each, answered in a worker."""

from collections.abc import Callable
from concurrent.futures import Executor
from typing import Final

import numpy as np

from app.actor import Actor, Latest
from app.arm.protocol import Arm
from app.document import FloatArray
from app.quality import Postures
from app.store import State
from gc_core import Demonstration
from gc_core.arrays import evenly, interpolated

NOTHING: Final[dict[Demonstration, FloatArray]] = {}
LOOKED_AT: Final = 100
"""Places along a demonstration that the arm is led to, at most."""


def joints_along(arm: Arm, demonstration: Demonstration) -> FloatArray:
    """Lead an arm along a demonstration.

    Parameters
    ----------
    arm : Arm
        Used by nobody else meanwhile.
    demonstration : Demonstration
        With T samples.

    Returns
    -------
    (T, J) array
        The arm's joints; between the places that are looked at they go evenly [rad].
    """
    count = len(demonstration.times)
    kept = evenly(count, LOOKED_AT)
    turned = None if demonstration.orientations is None else demonstration.orientations[kept]
    found = arm.follow(demonstration.positions[kept], orientations=turned).joints
    samples, places = np.arange(count, dtype=np.float64), np.asarray(kept, dtype=np.float64)
    return np.stack([interpolated(samples, places, joint) for joint in found.T], axis=1)


class Examining:
    """Has every demonstration that is learned from examined once, one after the other."""

    def __init__(self, executor: Executor, actor: Actor, make_arm: Callable[[], Arm]) -> None:
        self._jobs = Latest(executor, actor)
        self._make_arm = make_arm
        self._asked: Demonstration | None = None
        self.postures: Postures | None = None
        """None until the first answer."""

    def follow(self, state: State) -> None:
        """Have the next demonstration examined, unless something is pulled."""
        known = NOTHING if self.postures is None else self.postures.joints
        learned_from = state.model.demonstrations
        missing = next((one for one in learned_from if one not in known), None)
        if missing is None or missing is self._asked or state.dragging is not None:
            return
        self._asked = missing

        def job() -> Postures:
            arm = self._make_arm()
            try:
                found = joints_along(arm, missing)
                kept = {one: known[one] for one in learned_from if one in known}
                return Postures(arm.lower, arm.upper, {**kept, missing: found})
            finally:
                arm.close()

        self._jobs.submit(job, self._accept)

    def _accept(self, postures: Postures) -> None:
        self.postures = postures
