"""Demonstrations that differ at the start and half as much at the end, and what the tests need installed."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
import pytest

from gc_core import Demonstration

needs_gmr = pytest.mark.skipif(find_spec("gmr") is None, reason="gmr is missing (extra compare)")
needs_primitives = pytest.mark.skipif(
    find_spec("movement_primitives") is None or find_spec("pytransform3d") is None,
    reason="movement_primitives is missing (extra compare): it needs a compiler when it is installed",
)
GOAL = np.array([0.3, 0.0, 0.1])
SIDES = np.array([[0, 0, 0], [1, 0, 1], [0, 1, -1], [-1, -1, 0], [0.5, -1, 1]])


def demonstrations(count: int = 5, width: float = 0.04) -> list[Demonstration]:
    u = np.linspace(0.0, 1.0, 120)
    middle = np.stack([0.3 * u, 0.2 * np.sin(np.pi * u), 0.1 * u**2], axis=1)
    paths = middle + width * SIDES[:count, None] * (1.0 - 0.5 * u)[None, :, None]
    return [Demonstration(4.0 * u, path) for path in paths]
