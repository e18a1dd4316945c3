"""Where a new landmark is: in the scene as it is now, and as it was when the skill was taught."""

from typing import Final

import numpy as np

from app.document import FloatArray, LandmarkKind, Place
from app.measures import TABLE
from app.model import Model
from app.player import station_at
from app.store import Playback

HALF_AN_OBJECT: Final = 0.03
"""An object stands on the table with its middle this high [m]."""

AHEAD: Final = (0.0, -0.5, TABLE)
"""In front of the arm: where a thing is put while there is no tube [m]."""
ASIDE: Final = 0.20
"""A thing beside the playhead stands this far from the middle line [m]."""


def placed(model: Model, point: FloatArray) -> Place:
    """Tie what is at a present point (3,) [m] to the motion; no landmark moves by that, nor does the tube."""
    if model.registration is None:
        return Place("", taught=point)
    return Place("", taught=model.taken_back(point[None])[0][0], now=point)


def beside(model: Model, playback: Playback, kind: LandmarkKind) -> Place | None:
    """Propose a landmark where the playhead is: on the middle line, objects below it on the table.

    Nothing for a start and a goal that are at the ends anyway, and where there is no tube.
    """
    cylinder = model.cylinder
    if cylinder is None or not model.runs:
        return None
    if kind in {"start", "goal"}:
        end = cylinder.directrix[0 if kind == "start" else -1]
        return None if model.registration is None else placed(model, end)
    run = model.runs[min(playback.run, len(model.runs) - 1)].reproduction
    point = np.array(cylinder.directrix[station_at(run, playback.time)])
    if kind != "via":
        point[2] = HALF_AN_OBJECT
    return placed(model, point)


def foot_beside(model: Model, playback: Playback) -> FloatArray:
    """Propose where a thing stands (3,) [m]: on the table beside the playhead, away from the arm's base."""
    if model.cylinder is None or not model.runs:
        return np.array(AHEAD)
    run = model.runs[min(playback.run, len(model.runs) - 1)].reproduction
    point = np.array(model.cylinder.directrix[station_at(run, playback.time)])
    point[2] = 0.0
    away = point / max(float(np.linalg.norm(point)), 1e-6)
    return point + ASIDE * away + np.array([0.0, 0.0, TABLE])
