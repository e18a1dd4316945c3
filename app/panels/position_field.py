"""Three number fields for a place in centimetres, or a turn in degrees: the way to move without dragging."""

from collections.abc import Callable
from functools import partial
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
DEGREES: Final = 180.0 / np.pi
WHOLE_TURN: Final = 360.0


class PositionField:
    """Shows a position of the `State`, and posts the one that a person types.

    Parameters
    ----------
    gui : viser.GuiApi
    label : str
    read : callable
        The position (3,) [m]; None leaves the fields as they are.
    write : callable
        Posts a position (3,) [m].
    hint : str, optional
    turn : bool
        It is three angles [rad], shown in degrees, instead.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        label: str,
        *,
        read: Callable[[State], FloatArray | None],
        write: Callable[[FloatArray], None],
        hint: str | None = None,
        turn: bool = False,
    ) -> None:
        self._scale, most = (DEGREES, WHOLE_TURN) if turn else (100.0, LIMIT)
        low, high = (-most, -most, -most), (most, most, most)
        self.handle = gui.add_vector3(
            label, (0.0, 0.0, 0.0), min=low, max=high, step=5.0 if turn else STEP, hint=hint
        )
        self.handle.precision = 1
        self._read, self._write = read, write
        self._position: FloatArray = np.zeros(3)
        self._shown: Triple = (0.0, 0.0, 0.0)
        self._binding: Binding[Triple] = Binding(
            self.handle, read=self._truth, write=self._post, accept=partial(_sensible, most), typed=True
        )

    def draw(self, state: State) -> None:
        """Show the position."""
        self._binding.draw(state)

    def _truth(self, state: State) -> Triple:
        position = self._read(state)
        if position is not None and position is not self._position:
            self._position, self._shown = position, words.rounded(self._scale * position)
        return self._shown

    def _post(self, value: Triple) -> None:
        """Change only the coordinates that differ from what was shown, which was rounded."""
        same = np.array(value) == np.array(self._shown)
        self._write(np.where(same, self._position, np.array(value) / self._scale))


def _sensible(most: float, value: Triple) -> bool:
    return len(value) == 3 and bool(np.all(np.abs(np.asarray(value, dtype=float)) <= most))
