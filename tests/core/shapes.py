"""Demonstrations and maps for the laws: seeded gentle ones, and strategies for wild ones that shrink well."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

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


@dataclass(frozen=True, eq=False)
class Bundle:
    """Demonstrations of one motion, and their size: laws scale with it."""

    shown: list[Demonstration]
    size: float
    """About the length of a leg of the path [m]."""

    @property
    def half_width(self) -> float:
        """A least half-width that suits the size [m]."""
        return 0.002 * self.size

    def __repr__(self) -> str:
        counts = [len(demonstration.times) for demonstration in self.shown]
        return (
            f"Bundle(size={self.size:.6g} m, samples={counts}, first={self.shown[0].positions[:2].tolist()})"
        )


def straight(u: FloatArray, bend: float) -> FloatArray:
    return np.outer(u, [1.0, 0.3 * bend, 0.1])


def arc(u: FloatArray, bend: float) -> FloatArray:
    angle = 2.0 * np.pi * (0.05 + 0.9 * bend) * u
    return np.stack((np.sin(angle), 1.0 - np.cos(angle), 0.0 * u), axis=1) / (0.5 + 3.0 * bend)


def wave(u: FloatArray, bend: float) -> FloatArray:
    return np.stack((u, 0.3 * bend * np.sin(7.0 * u), 0.1 * np.sin(3.0 * u)), axis=1)


def hairpin(u: FloatArray, bend: float) -> FloatArray:
    """Out and back beside it; the sharper, the more it bends."""
    radius = 0.002 + 0.1 * (1.0 - bend)
    gone = (2.0 + np.pi * radius) * u
    turn = np.clip((gone - 1.0) / radius, 0.0, np.pi)
    along = np.minimum(gone, 1.0) - np.maximum(gone - 1.0 - np.pi * radius, 0.0) + radius * np.sin(turn)
    return np.stack((along, radius * (1.0 - np.cos(turn)), 0.0 * u), axis=1)


def coil(u: FloatArray, bend: float) -> FloatArray:
    """Turns that pass near themselves."""
    angle = 2.0 * np.pi * (1.0 + 2.0 * bend) * u
    return np.stack((0.2 * np.cos(angle), 0.2 * np.sin(angle), 0.1 * u), axis=1)


PATHS = (straight, arc, wave, hairpin, coil)
"""Simple ones first: an example shrinks towards them."""

FLAT_PATHS = (arc, hairpin)

SIZES = st.just(1.0) | st.floats(-2.0, 2.0).map(lambda power: 10.0**power)
"""A centimetre to a hundred metres."""


@st.composite
def bundles(
    draw: st.DrawFn,
    paths: tuple[Callable[[FloatArray, float], FloatArray], ...] = PATHS,
    least: int = 1,
    noises: tuple[float, ...] = (0.0, 1e-3),
    sizes: st.SearchStrategy[float] = SIZES,
) -> Bundle:
    """One to eight demonstrations, from two samples each, not in step, beside and across each other."""
    path, bend = draw(st.sampled_from(paths)), draw(st.floats(0.0, 1.0))
    count, size = draw(st.integers(least, 8)), draw(sizes)
    spread = draw(st.sampled_from((0.02, 0.0, 0.005, 0.1)))
    noise, samples = draw(st.sampled_from(noises)), draw(st.integers(2, 150))
    rng = np.random.default_rng(draw(seeds))
    shown: list[Demonstration] = []
    for j in range(count):
        part = np.linspace(0.0, 1.0, max(2, samples - 7 * j))
        place = path(part + rng.uniform(0.0, 0.25) * part * (1.0 - part), bend)
        aside = spread * (rng.normal(size=3) + np.sin(np.pi * part)[:, None] * rng.normal(size=3))
        place = size * (place + aside + noise * rng.normal(size=place.shape))
        shown.append(Demonstration(rng.uniform(2.0, 3.0) * part, place, name=f"Demonstration {j + 1}"))
    return Bundle(shown, size)


def hairpins(least: int = 2) -> st.SearchStrategy[Bundle]:
    """Bundles that turn back beside themselves, some so sharply that their sections would cross."""
    return bundles((hairpin,), least=least)
