"""Seeded demonstrations and maps for the laws."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from gc_core import Demonstration
from gc_core.arrays import FloatArray

seeds = st.integers(0, 10_000)


def bundle(seed: int, count: int = 4, samples: int = 120, spread: float = 0.02) -> list[Demonstration]:
    """Smooth demonstrations of one curved motion, half a metre long, not quite in step."""
    rng = np.random.default_rng(seed)
    u = np.linspace(0.0, 1.0, samples)
    waves = np.sin(np.pi * np.outer(u, np.arange(1, 4)))
    base = 0.5 * np.outer(u, [1.0, 0.3, 0.2]) + waves @ rng.normal(
        scale=[[0.06], [0.03], [0.01]], size=(3, 3)
    )
    return [_one(rng, base, u, waves, spread=spread, name=f"Demonstration {j + 1}") for j in range(count)]


def _one(
    rng: np.random.Generator, base: FloatArray, u: FloatArray, waves: FloatArray, *, spread: float, name: str
) -> Demonstration:
    wobble = waves @ rng.normal(scale=spread / 3.0, size=(3, 3)) + rng.normal(scale=spread, size=3)
    duration = rng.uniform(2.0, 3.0)
    return Demonstration(duration * u, base + wobble, name=name)


def line(
    start: tuple[float, float, float], end: tuple[float, float, float], samples: int = 50
) -> Demonstration:
    part = np.linspace(0.0, 1.0, samples)[:, None]
    return Demonstration(part[:, 0], np.array(start) * (1.0 - part) + np.array(end) * part)


def rotation(seed: int) -> FloatArray:
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return turn * np.sign(np.linalg.det(turn))


def moved(demonstrations: list[Demonstration], linear: FloatArray, shift: FloatArray) -> list[Demonstration]:
    return [Demonstration(d.times, d.positions @ linear.T + shift, name=d.name) for d in demonstrations]
