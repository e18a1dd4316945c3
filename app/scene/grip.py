"""What makes a ball easy to grab: an invisible rod from it towards whoever looks.

The page gives a press to the nearest thing that can be pulled, and lines pass in front
of the hand all the time. Seen from the camera the rod hides behind its own ball, so
that a press on the ball means the ball. Longer rods win over shorter ones.
"""

from typing import Final

import numpy as np
import viser

from app.document import FloatArray
from app.scene.geometry import disc, facing, tube_mesh
from app.scene.nodes import Mesh

SHARE: Final = 0.8
"""Radius of a rod as a part of its ball's."""
USUAL: Final = 1.8
"""From a ball to the camera [m]: as seen from there a rod is as thick at its far end as at its ball."""
BEFORE: Final = 0.7
"""A rod ends before this part of the way to the camera, which would else be in it."""
TURN: Final = float(np.cos(np.deg2rad(1.5)))
"""Cosine of the change of direction that is worth turning the rod for."""


class Grip:
    """``<ball>/grip``, a part of the ball for the pointer."""

    def __init__(self, api: viser.SceneApi, ball: str, radius: float, length: float) -> None:
        self._mesh = Mesh(api, f"{ball}/grip", opacity=0.0)
        self._radius, self._length = SHARE * radius, length
        self._towards: FloatArray | None = None
        self._size = (1.0, 1.0, 1.0)

    def aim(
        self, place: FloatArray, camera: FloatArray, *, scale: float = 1.0, length: float | None = None
    ) -> None:
        """Point from the ball's place (3,) to the camera (3,) [m]; costs nothing when it does already.

        A ``length`` [m] makes only the rod longer, while ``scale`` makes it wider as well.
        """
        away = float(np.linalg.norm(camera - place))
        if away < 1e-6:
            return
        towards = (camera - place) / away
        longest = scale * self._length if length is None else length
        shorter = float(np.floor(10.0 * BEFORE * away / longest)) / 10.0
        size = (scale, scale, longest / self._length * min(max(shorter, 0.1), 1.0))
        if self._towards is not None and size == self._size and towards @ self._towards > TURN:
            return
        first = self._towards is None
        handle = self._mesh.handle or self._mesh.show(*_rod(self._radius, self._length))
        if size != self._size or first:
            handle.scale = size
        handle.wxyz = facing(towards)
        self._towards, self._size = towards, size


def _rod(radius: float, length: float) -> tuple[np.ndarray, np.ndarray]:
    """A cone along +z that narrows towards the camera, with a lid at its far end."""
    end = 1.0 - length / USUAL
    lid, faces = disc(end * radius, sides=12)
    lid = lid + np.array([0.0, 0.0, length])
    rim = lid[1:].astype(np.float64)
    side, side_faces = tube_mesh(np.stack([rim * [1.0 / end, 1.0 / end, 0.0], rim]))
    vertices = np.concatenate([lid.astype(np.float32), side])
    return vertices, np.concatenate([faces, side_faces + np.uint32(len(lid))])
