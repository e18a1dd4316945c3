"""How far a curve bows out, and how much of its shape it keeps when its ends are moved."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from gc_core.arrays import FloatArray


def bow(curve: FloatArray) -> float:
    """Greatest distance of a curve (K, 3) from its chord, as a part of the chord's length [-]."""
    away, chord = curve - curve[0], curve[-1] - curve[0]
    across = away - np.outer(away @ chord, chord) / (chord @ chord)
    return float(np.linalg.norm(across, axis=1).max() / np.linalg.norm(chord))


def shape_change(taught: FloatArray, moved: FloatArray) -> float:
    """Greatest distance between corresponding points of two curves (K, 3), chord laid onto chord.

    The taught curve is scaled and turned by the smallest rotation so that both its ends meet those of the
    moved one; the result is a part of the moved chord's length [-].
    """
    old, new = taught[-1] - taught[0], moved[-1] - moved[0]
    scale = np.linalg.norm(new) / np.linalg.norm(old)
    turn = _smallest_turn(old / np.linalg.norm(old), new / np.linalg.norm(new))
    expected = moved[0] + scale * (taught - taught[0]) @ turn.T
    return float(np.linalg.norm(moved - expected, axis=1).max() / np.linalg.norm(new))


def _smallest_turn(one: FloatArray, other: FloatArray) -> FloatArray:
    """Rotation (3, 3) of one direction onto another; they are not opposed."""
    axis = np.cross(one, other)
    sine = float(np.linalg.norm(axis))
    angle = np.arctan2(sine, float(one @ other))
    return Rotation.from_rotvec(axis * (angle / sine) if sine > 0.0 else axis).as_matrix()
