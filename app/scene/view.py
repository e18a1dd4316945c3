"""Where one looks from: the views of the buttons, and the eye of the person who looks."""

from dataclasses import dataclass, field
from typing import Final

import numpy as np
import viser

from app.actions import ViewName
from app.document import FloatArray


@dataclass(frozen=True)
class Viewpoint:
    """A place to look from."""

    position: tuple[float, float, float]
    """Of the camera [m]."""
    look_at: tuple[float, float, float]
    """[m]."""


VIEWS: Final[dict[ViewName, Viewpoint]] = {
    "3D": Viewpoint((0.85, -1.45, 0.80), (0.0, -0.36, 0.25)),
    "Front": Viewpoint((0.0, -2.1, 0.30), (0.0, -0.36, 0.30)),
    "Side": Viewpoint((1.8, -0.36, 0.30), (0.0, -0.36, 0.30)),
    "Top": Viewpoint((0.0, -0.37, 1.9), (0.0, -0.36, 0.0)),
}
"""What the view buttons show."""
FIELD_OF_VIEW: Final = 0.80
"""Vertical [rad]; narrow, so that distances are not exaggerated."""


@dataclass
class Eye:
    """Where this person's camera is; what it changes costs nothing until the next draw."""

    position: FloatArray = field(default_factory=lambda: np.array(VIEWS["3D"].position))
    """(3,) [m]; replaced, never written into."""


def look_from_here(camera: viser.InitialCameraConfig) -> None:
    """Let every new page begin with the 3-D view; set on ``server.initial_camera``."""
    camera.position = VIEWS["3D"].position
    camera.look_at = VIEWS["3D"].look_at
    camera.fov = FIELD_OF_VIEW
