"""Motions that break what is written for smooth ones."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from gc_core import Demonstration, encode, generalize, register, reproduce
from gc_core.alignment import ALIGNMENTS
from gc_core.arrays import FloatArray
from gc_core.sections import SECTIONS, section_radii
from tests.core.shapes import bundle, moved, rotation
from tests.core.test_encode import ratios_to_polygons

ASIDE = (0.0, 0.02, 0.05)


def side_by_side(path: FloatArray) -> list[Demonstration]:
    return [Demonstration(0.01 * np.arange(len(path)), path + np.array([0.0, 0.0, aside])) for aside in ASIDE]


def noisy() -> list[Demonstration]:
    rng = np.random.default_rng(0)
    return [
        Demonstration(d.times, d.positions + rng.normal(scale=0.003, size=(1500, 3)))
        for d in bundle(1, 4, 1500)
    ]


def waiting(before: int, after: int) -> list[Demonstration]:
    """Nearly all of each recording stands still, trembling."""
    rng = np.random.default_rng(1)
    paths = [
        np.concatenate(
            (np.repeat(d.positions[:1], before, 0), d.positions, np.repeat(d.positions[-1:], after, 0))
        )
        for d in bundle(7, 3)
    ]
    return [
        Demonstration(0.01 * np.arange(len(path)), path + rng.normal(scale=2e-5, size=path.shape))
        for path in paths
    ]


TURN = np.linspace(0.0, 2.0 * np.pi, 300)
STIR = 0.1 * np.stack((np.cos(TURN), np.sin(TURN)))[:, 30 * (np.arange(1501) % 10)]
THERE_AND_BACK = np.abs(np.linspace(-1.0, 1.0, 301))[:, None] * [0.3, 0.0, 0.0]
WALK = np.cumsum(np.random.default_rng(0).normal(size=(50, 3)), axis=0)
MOTIONS = {
    "two samples": side_by_side(np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])),
    "a closed loop": side_by_side(0.2 * np.stack((np.cos(TURN), np.sin(TURN), 0.0 * TURN), axis=1)),
    "there and back": side_by_side(THERE_AND_BACK),
    "stirring in step with the search": side_by_side(np.stack((*STIR, 0.0 * STIR[0]), axis=1)),
    "a random walk": side_by_side(WALK),
    "every sample held ten times": side_by_side(np.repeat(bundle(2, 1)[0].positions, 10, axis=0)),
    "a sensor's noise": noisy(),
    "far from the origin and late": [Demonstration(d.times + 1.7e9, d.positions + 100.0) for d in bundle(3)],
    "smaller than the least width": [Demonstration(d.times, 1e-3 * d.positions) for d in bundle(4)],
    "waiting for a minute at both ends": waiting(6000, 6000),
    "samples at uneven times": [Demonstration(d.times**3, d.positions) for d in bundle(8)],
    "as far away as is allowed": [Demonstration(d.times, 9e5 + d.positions) for d in bundle(9)],
    "as large as is allowed": [Demonstration(d.times, 1e6 * d.positions) for d in bundle(10)],
    "a hundred thousand samples": bundle(5, 2, 100_000),
    "forty demonstrations": bundle(6, 40, 200),
}


@pytest.mark.parametrize("align_by", ALIGNMENTS)
@pytest.mark.parametrize("section", sorted(SECTIONS))
@pytest.mark.parametrize("name", MOTIONS)
def test_awkward_motions_are_learned_run_and_bent_without_a_warning(
    name: str, section: str, align_by: str
) -> None:
    shown = MOTIONS[name]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cylinder = encode(shown, section=section, align_by=align_by)
        run = reproduce(cylinder, shown[0].positions[0])
        ends = cylinder.directrix[[0, -1]]
        bent = generalize(cylinder, register(ends, ends + np.array([[0.0, 0.1, 0.0], [0.1, 0.0, 0.1]])))

    # Far from the origin, rounding alone moves a point by more than a billionth of a thin section.
    rounding = 8.0 * np.spacing(np.abs(cylinder.directrix).max()) / cylinder.radii.min()
    assert ratios_to_polygons(cylinder).max() <= 1.0 + 1e-9 + rounding
    assert (np.diff(cylinder.times) > 0.0).all()
    assert all(np.isfinite(values).all() for values in (cylinder.surface(), run.positions, bent.surface()))


def meeting() -> list[Demonstration]:
    """All end in one place; the first two swing round to it, from beyond the goal and from before it."""
    u = np.linspace(0.0, 1.0, 200)
    late = np.clip(5.0 * u - 4.0, 0.0, 1.0)
    swing = np.sin(np.pi * late)
    shown: list[Demonstration] = []
    for beyond, aside in ((0.01, 0.03), (-0.01, 0.03), (0.0, -0.06)):
        along = 0.5 * np.minimum(1.25 * u, 1.0) + beyond * swing
        across = aside * ((1.0 - late) * np.sin(np.pi * u) + swing)
        shown.append(Demonstration(3.0 * u, np.stack((along, across, 0.0 * u), axis=1)))
    return shown


@pytest.mark.parametrize("turn", range(1, 5))
def test_where_all_demonstrations_end_in_one_place_rounding_does_not_choose_the_section(turn: int) -> None:
    linear, shift = rotation(turn), np.array([0.3, -0.2, 0.5])
    tube, turned = encode(meeting()), encode(moved(meeting(), linear, shift))

    np.testing.assert_allclose(turned.surface(), tube.surface() @ linear.T + shift, atol=1e-9)


@pytest.mark.parametrize("section", sorted(SECTIONS))
@pytest.mark.parametrize("size", [1e-30, 1e-170, 1e-310])
def test_points_too_near_to_tell_apart_have_a_section_of_the_least_width(section: str, size: float) -> None:
    points = size * np.array([[[1.0, 0.0], [0.0, 1.0], [-1.0, -1.0]]])

    np.testing.assert_allclose(section_radii(points, section, 64, 0.001), 0.001, rtol=0.01)
