"""Where the next demonstration would help most: the widest side from which nobody has shown the motion."""

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from app.document import FloatArray
from gc_core import GeneralizedCylinder

Reason: TypeAlias = Literal["alone", "flat", "gap"]

SEEN: Final = np.radians(130.0)
"""Demonstrations with no wider angle between neighbours are around the middle line [rad]."""
OPPOSITE: Final = np.radians(140.0)
"""Where the second widest angle is so wide too, the demonstrations lie in a plane [rad]."""
WORTH: Final = 0.008
"""A place that is nearer to the middle line than this is not worth another demonstration [m]."""
NEIGHBOURHOOD: Final = 0.05
"""What is suggested holds over this part of the way to either side [-]."""
SIDE: Final = 0.03
"""How far beside a lone demonstration the next one goes [m]."""
MOSTLY: Final = 0.35
"""A direction says up, down, left or right when it goes so much that way (cosine)."""


@dataclass(frozen=True, eq=False)
class Suggestion:
    """Where to show the motion once more."""

    station: int
    """Where along the way."""
    direction: FloatArray
    """(3,) from the middle line, unit [-]."""
    place: FloatArray
    """(3,) where the next demonstration should pass [m]."""
    reason: Reason
    """``alone``: there is only one; ``flat``: all lie in a plane; ``gap``: one side was left out."""
    sentence: str


def suggestion(cylinder: GeneralizedCylinder) -> Suggestion | None:
    """Find where one more demonstration would help most.

    Of all slices, the one whose largest angle without a demonstration, seen from the middle line, leaves most
    room unseen.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
        With N stations, of n demonstrations.

    Returns
    -------
    Suggestion or None
        None when the motion was shown from all sides wherever it is wide.
    """
    points = cylinder.effective_points - cylinder.directrix[:, None]
    if points.shape[1] < 2:
        station = len(points) // 2
        return _suggested(cylinder, station, _level(cylinder.frames[station]), SIDE, "alone")
    flat = np.einsum("nji,nkj->nki", cylinder.frames[:, :, 1:], points)
    gaps, middles, second = _gaps(flat)
    room = np.sqrt((flat**2).sum(axis=2).mean(axis=1))
    # A slice counts with its neighbours: one where lines happen to meet is nothing to be told about.
    score = _around(np.maximum(gaps - SEEN, 0.0) * room)
    station = int(np.argmax(score))
    if score[station] <= 0.0 or gaps[station] <= SEEN or room[station] < WORTH:
        return None
    across = cylinder.frames[station, :, 1:] @ [np.cos(middles[station]), np.sin(middles[station])]
    reason: Reason = "flat" if second[station] > OPPOSITE else "gap"
    return _suggested(cylinder, station, across, float(room[station]), reason)


def _gaps(flat: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Largest angles between neighbours (N,), their middles (N,), and the second largest (N,) [rad].

    Of places (N, n, 2) in the slices, seen from the centre.
    """
    angles = np.sort(np.arctan2(flat[..., 1], flat[..., 0]), axis=1)
    between = np.diff(np.concatenate((angles, angles[:, :1] + 2.0 * np.pi), axis=1), axis=1)
    largest = np.argmax(between, axis=1)
    rows = np.arange(len(flat))
    gaps = between[rows, largest]
    return gaps, angles[rows, largest] + 0.5 * gaps, np.sort(between, axis=1)[:, -2]


def _around(values: FloatArray) -> FloatArray:
    """Means (N,) of values over a neighbourhood; at the ends over what there is of it."""
    reach = max(round(NEIGHBOURHOOD * len(values)), 1)
    window = np.ones(2 * reach + 1)
    return np.convolve(values, window, "same") / np.convolve(np.ones(len(values)), window, "same")


def _level(frame: FloatArray) -> FloatArray:
    """A direction (3,) across a slice, as level as there is."""
    level = np.cross(frame[:, 0], [0.0, 0.0, 1.0])
    size = float(np.linalg.norm(level))
    return frame[:, 1] if size < 1e-6 else np.asarray(level / size, dtype=np.float64)


def _suggested(
    cylinder: GeneralizedCylinder, station: int, direction: FloatArray, away: float, reason: Reason
) -> Suggestion:
    part = station / (len(cylinder.directrix) - 1)
    where = f"{100.0 * away:.0f} cm {_side(direction, cylinder.frames[station, :, 0])} the middle line"
    begin = {
        "alone": "One demonstration shows no room.",
        "flat": "All demonstrations lie side by side, as on a sheet.",
        "gap": "Nobody has shown this side yet.",
    }[reason]
    sentence = f"{begin} Show one through the red disc, {where}, {_along(part)}."
    return Suggestion(station, direction, cylinder.directrix[station] + away * direction, reason, sentence)


def _side(direction: FloatArray, along: FloatArray) -> str:
    """Say where a direction (3,) is, for somebody who goes along."""
    right = np.cross(along, [0.0, 0.0, 1.0])
    sideways = float(direction @ right) / max(float(np.linalg.norm(right)), 1e-9)
    words = [
        word
        for word, much in (
            ("above", direction[2]),
            ("below", -direction[2]),
            ("to the right of", sideways),
            ("to the left of", -sideways),
        )
        if much > MOSTLY
    ]
    return " and ".join(words) or "beside"


def _along(part: float) -> str:
    if part < 0.1:
        return "at the beginning"
    if part > 0.9:
        return "at the end"
    return "half-way" if 0.45 < part < 0.55 else f"after {100.0 * part:.0f} % of the way"
