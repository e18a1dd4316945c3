"""Three number fields for a place, in centimetres: the way to move things without dragging."""

from collections.abc import Callable
from typing import Final

import numpy as np
import viser

from app.binding import Binding
from app.document import FloatArray
from app.edits import LARGEST_COORDINATE
from app.panels import words
from app.store import State

Triple = tuple[float, float, float]

LIMIT: Final = 100.0 * LARGEST_COORDINATE
"""No field takes more than this [cm]."""
STEP: Final = 0.5
"""What an arrow key adds [cm]."""


class PositionField:
    """Shows a position of the `State`, and posts the one that a person types.

    Parameters
    ----------
    read : callable
        The position (3,) [m]; None leaves the fields as they are.
    write : callable
        Posts a position (3,) [m].
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        label: str,
        *,
        read: Callable[[State], FloatArray | None],
        write: Callable[[FloatArray], None],
        hint: str | None = None,
    ) -> None:
        limits: Triple = (LIMIT, LIMIT, LIMIT)
        self.handle = gui.add_vector3(
            label, (0.0, 0.0, 0.0), min=(-LIMIT, -LIMIT, -LIMIT), max=limits, step=STEP, hint=hint
        )
        self.handle.precision = 1
        self._read, self._write = read, write
        self._position: FloatArray = np.zeros(3)
        self._shown: Triple = (0.0, 0.0, 0.0)
        self._binding: Binding[Triple] = Binding(
            self.handle, read=self._truth, write=self._post, accept=_sensible, typed=True
        )

    def draw(self, state: State) -> None:
        """Show the position."""
        self._binding.draw(state)

    def _truth(self, state: State) -> Triple:
        position = self._read(state)
        if position is not None and position is not self._position:
            self._position, self._shown = position, words.in_cm(position)
        return self._shown

    def _post(self, value: Triple) -> None:
        """Change only the coordinates that differ from what was shown, which was rounded."""
        same = np.array(value) == np.array(self._shown)
        self._write(np.where(same, self._position, np.array(value) / 100.0))


def _sensible(value: Triple) -> bool:
    return len(value) == 3 and bool(np.all(np.abs(np.asarray(value, dtype=float)) <= LIMIT))
