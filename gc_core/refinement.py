"""Reshaping a path by pulling at one of its points, and what a reshaped path is to those it belongs to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from gc_core.arrays import FloatArray, finite
from gc_core.demonstration import Demonstration
from gc_core.errors import InvalidSettingError
from gc_core.frames import arc_length
from gc_core.reproduction import Reproduction


def soft_correction(positions: ArrayLike, index: int, displacement: ArrayLike, width: float) -> FloatArray:
    """Pull a path at one sample; the pull fades out in arc length to both sides.

    The ends stay where they are unless the sample is an end itself: near an end, that side fades out faster.
    The weight (1 - (s / width)^2)^2 is C1, so that the corrected path has no corner that was not there.

    Parameters
    ----------
    positions : (K, 3) array
        Path, K >= 2 [m].
    index : int
        Sample that is pulled, from -K to K - 1.
    displacement : (3,) array
        How far it is pulled [m].
    width : float
        Arc length at which the pull has faded out, above 0 [m].

    Returns
    -------
    (K, 3) array
        A new path; the sample is moved by exactly the displacement [m].

    Raises
    ------
    ShapeError, NotFiniteError
        If the path or the displacement are not finite places.
    InvalidSettingError
        If there is no such sample, or the width is not a length.

    Notes
    -----
    The paper's teacher reshapes a target trajectory by pushing the arm in compliant replay [1]_; this is the
    same with a pointer, which holds the path at one place only.

    References
    ----------
    .. [1] S. R. Ahmadzadeh, M. A. Rana, S. Chernova. Generalized Cylinders for Learning, Reproduction,
       Generalization, and Refinement of Robot Skills. RSS 2017, Sec. VI-A. doi:10.15607/RSS.2017.XIII.021
    """
    path = finite(positions, "positions", (None, 3))
    pull = finite(displacement, "displacement", (3,))
    if not -len(path) <= index < len(path) or index != int(index):
        raise InvalidSettingError("index", index, f"a sample from 0 to {len(path) - 1}")
    if not 0.0 < width < np.inf:
        raise InvalidSettingError("width", width, "a length above 0 m")
    return path + correction_weights(path, index, width)[:, None] * pull


def correction_weights(positions: FloatArray, index: int, width: float) -> FloatArray:
    """Share of a pull at one sample that each sample of a path follows.

    Parameters
    ----------
    positions : (K, 3) array
        Path [m].
    index : int
        Sample that is pulled.
    width : float
        Arc length at which the pull has faded out [m].

    Returns
    -------
    (K,) array
        1 at the sample, 0 at the ends (unless the sample is there) and beyond the width [-].
    """
    index = index % len(positions)
    gone = arc_length(positions)
    away = gone - gone[index]
    back = min(width, -away[0]) if away[0] < 0.0 else width
    ahead = min(width, away[-1]) if away[-1] > 0.0 else width
    part = np.clip(np.where(away < 0.0, -away / back, away / ahead), 0.0, 1.0)
    return (1.0 - part**2) ** 2


def refined(
    demonstrations: Sequence[Demonstration], index: int, positions: ArrayLike
) -> tuple[Demonstration, ...]:
    """Put a corrected path in the place of a demonstration: incremental refinement.

    Encoding them again learns the correction: of n demonstrations, the mean takes over one n-th of it.

    Parameters
    ----------
    demonstrations : sequence of n Demonstration
        Not changed.
    index : int
        Which one was corrected, from 0 to n - 1.
    positions : (T, 3) array
        Its path as it is now, sample by sample [m].

    Returns
    -------
    tuple of Demonstration
        The corrected one keeps its times, orientations, gripper and name; the others are the same objects.

    Raises
    ------
    InvalidSettingError
        If there is no such demonstration.
    ShapeError, NotFiniteError, NoMotionError, TooFarError
        If the path does not fit it.

    References
    ----------
    .. [1] S. R. Ahmadzadeh, M. A. Rana, S. Chernova. Generalized Cylinders for Learning, Reproduction,
       Generalization, and Refinement of Robot Skills. RSS 2017, Sec. VI-A. doi:10.15607/RSS.2017.XIII.021
    """
    if not 0 <= index < len(demonstrations):
        raise InvalidSettingError("index", index, f"a demonstration from 0 to {len(demonstrations) - 1}")
    one = demonstrations[index]
    path = finite(positions, "positions", (len(one.times), 3))
    return (*demonstrations[:index], replace(one, positions=path), *demonstrations[index + 1 :])


def as_demonstration(run: Reproduction, name: str = "") -> Demonstration:
    """Make a demonstration of a run, for instance of a corrected one that joins those that were shown.

    Parameters
    ----------
    run : Reproduction
        One run, not several.
    name : str
        How to call it.

    Returns
    -------
    Demonstration
        With the run's times, positions, orientations and gripper.

    Raises
    ------
    ShapeError, NotFiniteError, NoMotionError, TooFarError
        If it is several runs, or no motion.
    """
    return Demonstration(run.times, run.positions, run.orientations, run.gripper, name)
