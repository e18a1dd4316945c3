"""Motions to and from an object that is moved and turned, shown before and after: transfer with a truth.

Part of each motion belongs to the room (leaving the start, lifting), part to the object (coming near it
along its own axes). The same motion at another pose is what a person would show there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from gc_core import Demonstration, Landmark
from gc_core.arrays import FloatArray

KINDS = ("pick", "place")

Turning: TypeAlias = Literal["turned", "moved alone", "turned about a leaning axis"]
TURNINGS: tuple[Turning, ...] = get_args(Turning)
LEAN = 30.0
"""An axis leans from the vertical by at most this much [deg]."""

SHOWN = 5
SAMPLES = 200


@dataclass(frozen=True, eq=False)
class Scene:
    """Where the motion starts and where the object stands."""

    start: FloatArray
    """(3,) [m]."""
    place: FloatArray
    """(3,) origin of the object [m]."""
    turn: FloatArray
    """(3, 3) axes of the object."""

    def start_point(self) -> Landmark:
        return Landmark(self.start, name="start")

    def goal_point(self) -> Landmark:
        return Landmark(self.place, name="goal")

    def object_frame(self) -> Landmark:
        return Landmark(self.place, Rotation.from_matrix(self.turn).as_quat(scalar_first=True), name="object")


@dataclass(frozen=True, eq=False)
class Transfer:
    """One motion shown in two scenes."""

    before: Scene
    after: Scene
    shown: list[Demonstration]
    """In the scene before."""
    truth: list[Demonstration]
    """In the scene after."""


def transfer(seed: int, kind: str, turning: Turning = "turned") -> Transfer:
    """A motion, and an object that is moved by 10 to 25 cm and, if wanted, turned by 20 to 90 degrees."""
    rng = np.random.default_rng(seed)
    before = Scene(
        start=np.array([0.0, 0.0, 0.25]) + rng.uniform(-0.05, 0.05, 3),
        place=np.array([0.4, 0.1, 0.05]) + rng.uniform(-0.08, 0.08, 3),
        turn=Rotation.from_euler("z", rng.uniform(-30.0, 30.0), degrees=True).as_matrix(),
    )
    aside = rng.normal(size=3) * [1.0, 1.0, 0.3]
    about = np.array([0.0, 0.0, rng.choice([-1.0, 1.0])])
    if turning == "turned about a leaning axis":
        about = _leaning(about, np.random.default_rng((seed, 1)))
    angle = 0.0 if turning == "moved alone" else np.deg2rad(rng.uniform(20.0, 90.0))
    after = Scene(
        start=before.start + rng.uniform(-0.05, 0.05, 3),
        place=before.place + rng.uniform(0.10, 0.25) * aside / np.linalg.norm(aside),
        turn=Rotation.from_rotvec(angle * about).as_matrix() @ before.turn,
    )
    shape = rng.uniform(-1.0, 1.0, 4)
    shown, truth = ([_shown(rng, scene, kind, shape) for _ in range(SHOWN)] for scene in (before, after))
    return Transfer(before, after, shown, truth)


def _leaning(upright: FloatArray, rng: np.random.Generator) -> FloatArray:
    """An axis (3,) that leans from an upright one by up to `LEAN`, any way."""
    way = rng.uniform(0.0, 2.0 * np.pi)
    lean = np.deg2rad(rng.uniform(0.0, LEAN)) * np.array([np.cos(way), np.sin(way), 0.0])
    return Rotation.from_rotvec(lean).apply(upright)


def _shown(rng: np.random.Generator, scene: Scene, kind: str, shape: FloatArray) -> Demonstration:
    """One person's go: smooth, a few millimetres off each time, at an uneven pace, with a tremble."""
    corners = _corners(scene, kind, shape)
    corners = corners + rng.normal(scale=0.003, size=corners.shape)
    corners[-1] = scene.place + rng.normal(scale=0.001, size=3)
    knots = np.concatenate(([0.0], np.cumsum(np.sqrt(np.linalg.norm(np.diff(corners, axis=0), axis=1)))))
    part = np.linspace(0.0, 1.0, SAMPLES)
    eased = part**3 * (10.0 - 15.0 * part + 6.0 * part**2)
    pace = 0.7 * part + 0.3 * eased + 0.04 * rng.normal() * np.sin(np.pi * part) ** 2
    path = CubicSpline(knots, corners)(knots[-1] * np.clip(pace, 0.0, 1.0))
    tremble = np.cumsum(rng.normal(size=path.shape), axis=0)
    tremble = 1e-4 * (tremble - np.linspace(tremble[0], tremble[-1], SAMPLES))
    return Demonstration(rng.uniform(2.0, 4.0) * part, path + tremble)


def _corners(scene: Scene, kind: str, shape: FloatArray) -> FloatArray:
    """Places (K, 3) that the motion goes by: those near the object belong to it."""
    lift = np.array([0.0, 0.0, 0.06 + 0.02 * shape[0]])
    if kind == "pick":
        near = [
            [-0.12, 0.02 * shape[1], 0.04],
            [-0.07, 0.01 * shape[2], 0.01],
            [-0.03, 0.0, 0.0],
            [0.0, 0.0, 0.0],
        ]
        first = [scene.start, scene.start + 0.3 * (scene.place - scene.start) + 0.5 * lift]
    else:
        near = [
            [0.02 * shape[1], -0.12, 0.07],
            [0.01 * shape[2], -0.07, 0.06],
            [0.0, -0.02, 0.04],
            [0.0, 0.0, 0.0],
        ]
        first = [scene.start, scene.start + lift, scene.start + 0.35 * (scene.place - scene.start) + lift]
    return np.vstack((first, scene.place + np.array(near) @ scene.turn.T))
