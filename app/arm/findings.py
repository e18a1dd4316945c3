"""What an arm answers with: parts to draw, joint paths, distances, and why a hand is not where it is due."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
"""Joints, positions and poses: float64, SI units."""

HERE = 0.005
"""A hand closer than this to where it is wanted is there [m]."""
STUCK = "stuck: reposition the arm"
"""The reason where the hand is not, though another posture of the arm would bring it there."""


@dataclass(frozen=True, eq=False)
class LinkMesh:
    """One drawable part of an arm; it moves with its link and never changes."""

    link: str
    """The link that carries it: a key of `Arm.link_poses`."""
    vertices: npt.NDArray[np.float32]
    """(V, 3) corners in the frame of the link [m]."""
    faces: npt.NDArray[np.uint32]
    """(F, 3) indices of the corners of each triangle, counter-clockwise from outside."""
    color: tuple[int, int, int]
    """Red, green, blue, each 0..255."""


@dataclass(frozen=True, eq=False)
class JointPath:
    """An arm's way along a path of tool positions."""

    joints: FloatArray
    """(K, J) joints at each position [rad]."""
    errors: FloatArray
    """(K,) distance from the tool to the wanted position [m]."""
    turns: FloatArray | None = None
    """(K,) how far the tool is turned away from the wanted orientation [rad]; None: none was wanted."""


@dataclass(frozen=True)
class Shortfall:
    """The hand is not where it is wanted, and why, in a teacher's words."""

    distance: float
    """From the tool to the wanted position [m]."""
    reason: str
    """For instance ``12 cm beyond reach`` or ``joint 4 at its limit``; no full stop."""
    cause: str = ""
    """What stopped a hand that is stuck, for instance ``joint 2 at its limit``; empty where unknown."""

    @property
    def stuck(self) -> bool:
        """Whether `Arm.reposition` knows a posture that brings the hand there."""
        return self.reason == STUCK


@dataclass(frozen=True, eq=False)
class Clearance:
    """How far the bodies of an arm are from each other and from the obstacles along joints (K, J)."""

    itself: FloatArray
    """(K,) smallest distance between two bodies of the arm [m]; negative: they overlap; inf: it has none."""
    obstacles: FloatArray
    """(K,) smallest distance of the whole arm from an obstacle [m]; negative: so deep; inf: there is none."""
    links: tuple[str, ...]
    """K names of the link nearest to an obstacle; empty names without obstacles."""
    names: tuple[str, ...]
    """K names of the obstacle nearest to the arm; empty names without obstacles."""
