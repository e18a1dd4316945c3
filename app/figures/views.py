"""From where a motion is looked at: (3, 3) rows to the right, up, towards the eye. Up stays up."""

from __future__ import annotations

from itertools import combinations
from typing import Final

import numpy as np

from app.document import FloatArray
from app.tube_svg import CAMERA_SIDE, projection_of
from gc_core import GeneralizedCylinder

LOWEST, HIGHEST, TURN = 18.0, 46.0, 15.0
"""Views from above, and how far they are turned from straight across the motion [degrees]."""
STEEP: Final = 0.3
"""Of a plane's normal: with less of it upwards, the plane is upright [-]."""
BEYOND, ROOM = 1.45, 0.9
"""Where the letter of an axis stands, and how far from the next letter, by the length of an axis [-]."""


def seen_across(cylinder: GeneralizedCylinder) -> FloatArray:
    """Find a view (3, 3) across a motion and a little from above, as in the drawings of the app."""
    return projection_of([cylinder]).axes


def seen_flat(cylinder: GeneralizedCylinder) -> FloatArray:
    """Find a view (3, 3) from above in which a motion's bends are seen, and a little of its slices."""
    away = cylinder.directrix - cylinder.directrix.mean(axis=0)
    towards = np.linalg.eigh(away.T @ away)[1][:, 0]
    upright = abs(towards[2]) < STEEP  # then both sides are level, and the one of the app's camera is taken
    if (towards[:2] @ CAMERA_SIDE if upright else towards[2]) < 0.0:
        towards = -towards
    back = -cylinder.frames[0, :, 0]  # out of the opening, to which one turns
    turn = TURN if towards[0] * back[1] - towards[1] * back[0] >= 0.0 else -TURN
    azimuth = np.rad2deg(np.arctan2(towards[1], towards[0])) + turn
    height = np.rad2deg(np.arcsin(np.clip(towards[2], -1.0, 1.0)))
    return seen_from(float(azimuth), float(np.clip(height, LOWEST, HIGHEST)))


def seen_from(azimuth: float, elevation: float) -> FloatArray:
    """View (3, 3) from an angle about z, counted from x, and an angle above level [degrees]."""
    turn, up = np.deg2rad([azimuth, elevation])
    towards = np.array([np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)])
    right = np.array([-np.sin(turn), np.cos(turn), 0.0])
    return np.stack([right, np.cross(towards, right), towards])


def letters_of(axes: FloatArray) -> FloatArray:
    """Find places (K, 2) for the letters of axes (K, 2) from one origin: beyond the tips, and apart [-]."""
    places = BEYOND * axes
    for one, other in combinations(range(len(places)), 2):
        between = places[other] - places[one]
        distance = float(np.hypot(*between))
        if distance < ROOM:
            # Of two axes that are seen as one, the letters stand on either side.
            away = between / distance if distance > 0.0 else np.array([-axes[one, 1], axes[one, 0]])
            places[one] -= 0.5 * (ROOM - distance) * away
            places[other] += 0.5 * (ROOM - distance) * away
    return places
