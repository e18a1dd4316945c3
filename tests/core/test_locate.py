"""Where points lie in a tube, and whether they are inside: for any points."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gc_core import Demonstration, GeneralizedCylinder, NotFiniteError, ShapeError, encode
from gc_core.arrays import FloatArray
from gc_core.location import BLOCK
from gc_core.radius import radius_at
from tests.core.shapes import bundle, line, rotation, seeds

LARGE = st.floats(-1e300, 1e300)


@cache
def arc(turn: float, radius: float = 0.2, width: float = 0.02, rise: float = 0.0) -> GeneralizedCylinder:
    """A tube along an arc in the plane z = 0, or a helix."""
    angle = np.linspace(0.0, turn, 400)
    rings = [
        np.stack((r * np.cos(angle), r * np.sin(angle), rise * angle), axis=1)
        for r in (radius - width, radius, radius + width)
    ]
    return encode([Demonstration(angle, ring) for ring in rings], section="circle")


def tilted(cylinder: GeneralizedCylinder, most: float = 0.5) -> GeneralizedCylinder:
    """The same curve with section planes that lean up to an angle and back [rad]."""
    lean = most * np.sin(np.linspace(0.0, np.pi, len(cylinder.directrix)))
    turn = np.zeros((len(lean), 3, 3))
    turn[:, 1, 1] = 1.0
    turn[:, 0, 0] = turn[:, 2, 2] = np.cos(lean)
    turn[:, 0, 2], turn[:, 2, 0] = np.sin(lean), -np.sin(lean)
    return replace(cylinder, frames=cylinder.frames @ turn)


def inner(cylinder: GeneralizedCylinder, station: int, ratio: float, angle: float) -> FloatArray:
    """The point of a section at a ratio and an angle."""
    edge = radius_at(cylinder.radii, np.array(station), np.array(angle))
    across = cylinder.frames[station, :, 1:] @ [np.cos(angle), np.sin(angle)]
    return cylinder.directrix[station] + ratio * edge * across


def by_hand(cylinder: GeneralizedCylinder, point: FloatArray) -> list[tuple[float, float]]:
    """Stations and ratios of all passages, one plane after the other."""
    normals, centres = cylinder.frames[:, :, 0], cylinder.directrix
    height = [float((point - c) @ n) for c, n in zip(centres, normals, strict=True)]
    found: list[tuple[float, float]] = []
    for i in range(len(height) - 1):
        if height[i] * height[i + 1] > 0.0 or height[i] == height[i + 1]:
            continue
        part = height[i] / (height[i] - height[i + 1])
        axes = (1.0 - part) * cylinder.frames[i, :, 1:] + part * cylinder.frames[i + 1, :, 1:]
        x, y = (point - (1.0 - part) * centres[i] - part * centres[i + 1]) @ axes
        edges = radius_at(cylinder.radii, np.array([i, i + 1]), np.array(np.arctan2(y, x)))
        found.append((i + part, float(np.hypot(x, y) / ((1.0 - part) * edges[0] + part * edges[1]))))
    return found


@settings(max_examples=60, deadline=None)
@given(seed=seeds, point=st.tuples(*[st.floats(-0.3, 0.8)] * 3), leaning=st.booleans())
def test_the_most_central_of_all_passages_is_found(seed: int, point: tuple, leaning: bool) -> None:
    cylinder = encode(bundle(seed), stations=30)
    cylinder = tilted(cylinder) if leaning else cylinder
    passages = by_hand(cylinder, np.array(point))
    station, _, ratio = (float(part[0]) for part in cylinder.locate([point]))

    inside = any(r <= 1.0 for _, r in passages)
    assert bool(cylinder.contains([point])[0]) is inside
    if inside or station not in (0.0, 29.0):
        best = min(passages, key=lambda passage: passage[1])
        np.testing.assert_allclose((station, ratio), best, atol=1e-9)


def test_nothing_is_inside_beyond_the_ends() -> None:
    cylinder = encode([line((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))])

    assert not cylinder.contains(np.array([[-0.01, 0.0, 0.0], [1.01, 0.0, 0.0]])).any()
    assert cylinder.contains(np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])).all()


@settings(max_examples=40, deadline=None)
@given(
    seed=seeds,
    station=st.integers(0, 59),
    ratio=st.floats(0.05, 0.95),
    angle=st.floats(-3.0, 3.0),
    most=st.floats(-0.4, 0.4),
)
def test_a_point_of_a_leaning_section_is_found_in_it(
    seed: int, station: int, ratio: float, angle: float, most: float
) -> None:
    cylinder = tilted(encode(bundle(seed), stations=60), most)
    point = inner(cylinder, station, ratio, angle)
    stations, angles, ratios = cylinder.locate([point])

    assert cylinder.contains([point]).all()
    assert ratios[0] <= ratio + 1e-6
    if ratios[0] > ratio - 1e-6:
        np.testing.assert_allclose(stations, station, atol=1e-6)
        np.testing.assert_allclose(np.angle(np.exp(1j * (angles - angle))), 0.0, atol=1e-5)


@settings(max_examples=40, deadline=None)
@given(seed=seeds, station=st.integers(0, 59), vertex=st.integers(0, 63))
def test_the_boundary_is_inside_and_just_beyond_it_is_not(seed: int, station: int, vertex: int) -> None:
    cylinder = encode(bundle(seed), stations=60)
    centre, corner = cylinder.directrix[station], cylinder.surface()[station, vertex]
    passages = [near for near, _ in by_hand(cylinder, centre + 1.001 * (corner - centre))]

    assert cylinder.contains([corner]).all()
    if all(abs(near - station) < 1e-6 for near in passages):
        assert not cylinder.contains([centre + 1.001 * (corner - centre)]).any()


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 5), point=st.tuples(LARGE, LARGE, LARGE), turn=st.sampled_from([0.5, 3.2, 6.9]))
def test_every_finite_place_has_a_finite_answer(seed: int, point: tuple, turn: float) -> None:
    for cylinder in (encode(bundle(seed), stations=20), arc(turn)):
        stations, angles, ratios = cylinder.locate([point])

        assert np.isfinite([stations, angles, ratios]).all()
        assert 0.0 <= stations[0] <= len(cylinder.directrix) - 1
        assert ratios[0] >= 0.0


@pytest.mark.parametrize("turn", [1.0, 3.1, 6.9])
def test_near_the_centre_of_a_bend_all_sections_pass_and_nothing_breaks(turn: float) -> None:
    cylinder = arc(turn)
    middle = np.random.default_rng(0).normal(scale=1e-6, size=(200, 3))
    middle[0] = 0.0
    stations, angles, ratios = cylinder.locate(middle)

    assert np.isfinite([stations, angles, ratios]).all()
    assert (ratios > 1.0).all()
    assert not cylinder.contains(middle).any()


def test_where_the_tube_comes_back_to_itself_the_more_central_passage_counts() -> None:
    helix = arc(4.0 * np.pi, rise=0.03 / (2.0 * np.pi))
    early, late = 40, 140
    points = np.array([0.9 * helix.directrix[early] + 0.1 * helix.directrix[late], helix.directrix[late]])
    stations, _, ratios = helix.locate(points)

    assert abs(stations[0] - early) < 3.0
    assert abs(stations[1] - late) < 3.0
    assert (ratios < 0.5).all()


def test_any_passage_that_holds_a_point_makes_it_inside() -> None:
    ring = arc(2.2 * np.pi)
    behind = ring.directrix[0] - 0.005 * ring.frames[0, :, 0]

    assert ring.contains([behind]).all()
    assert ring.locate([behind])[0][0] > 100.0
    assert not arc(3.2).contains([arc(3.2).directrix[0] - 0.005 * arc(3.2).frames[0, :, 0]]).any()


@settings(max_examples=40, deadline=None)
@given(seed=seeds, end=st.sampled_from([0, -1]), off=st.floats(1e-6, 0.01), ratio=st.floats(0.0, 0.9))
def test_a_point_just_beyond_an_end_is_told_by_that_end_and_not_inside(
    seed: int, end: int, off: float, ratio: float
) -> None:
    cylinder = encode(bundle(seed), stations=60)
    side = 1.0 if end else -1.0
    point = inner(cylinder, end, ratio, 1.0) + side * off * cylinder.frames[end, :, 0]
    stations, _, ratios = cylinder.locate([point])

    if not any(r <= 1.0 for _, r in by_hand(cylinder, point)):
        assert not cylinder.contains([point]).any()
        assert stations[0] == (59.0 if end else 0.0)
        np.testing.assert_allclose(ratios, ratio, atol=1e-6)


@settings(max_examples=30, deadline=None)
@given(seed=seeds, turned=seeds)
def test_a_place_moves_with_the_tube(seed: int, turned: int) -> None:
    cylinder, turn, shift = encode(bundle(seed), stations=40), rotation(turned), np.array([3.0, -1.0, 0.5])
    moved = replace(
        cylinder, directrix=cylinder.directrix @ turn.T + shift, frames=turn[None] @ cylinder.frames
    )
    points = np.random.default_rng(seed).uniform(-0.2, 0.7, size=(50, 3))

    for here, there in zip(cylinder.locate(points), moved.locate(points @ turn.T + shift), strict=True):
        np.testing.assert_allclose(here, there, atol=1e-5, rtol=1e-5)


def test_points_are_answered_alike_alone_and_in_any_number() -> None:
    cylinder = encode(bundle(1), stations=50)
    points = np.random.default_rng(0).uniform(-0.2, 0.7, size=(2 * BLOCK + 7, 3))
    together, inside = np.array(cylinder.locate(points)), cylinder.contains(points)
    some = [0, 1, BLOCK - 1, BLOCK, 2 * BLOCK, 2 * BLOCK + 6]

    for row in some:
        np.testing.assert_allclose(
            np.array(cylinder.locate(points[row : row + 1]))[:, 0], together[:, row], atol=1e-9
        )
        assert cylinder.contains(points[row : row + 1])[0] == inside[row]


def test_many_points_do_not_need_much_memory() -> None:
    cylinder = encode(bundle(1))
    points = np.random.default_rng(0).uniform(-0.2, 0.7, size=(100_000, 3))
    tracemalloc.start()
    try:
        cylinder.locate(points)
        cylinder.contains(points)
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()

    assert most < 10 * points.nbytes


def test_a_section_that_only_grazes_a_point_holds_it() -> None:
    straight = encode([line((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))], stations=9)
    frames = straight.frames.copy()
    lean = 0.9  # the planes beside the middle one pass on the same side of its boundary
    for station, sign in ((3, -1.0), (5, 1.0)):
        normal = np.array([np.cos(lean), 0.0, sign * np.sin(lean)])
        frames[station] = np.stack((normal, [0.0, 1.0, 0.0], np.cross(normal, [0.0, 1.0, 0.0])), axis=1)
    wide = replace(straight, frames=frames, radii=np.full_like(straight.radii, 1.0))
    point = wide.surface()[4]

    assert wide.contains(point).all()
    assert (wide.locate(point)[2] <= 1.0 + 1e-9).all()


def test_no_points_have_no_places() -> None:
    cylinder = encode(bundle(4))

    assert [part.shape for part in cylinder.locate(np.zeros((0, 3)))] == [(0,), (0,), (0,)]
    assert cylinder.contains(np.zeros((0, 3))).shape == (0,)


@pytest.mark.parametrize(
    ("error", "points"), [(ShapeError, [0.0, 0.0, 0.0]), (NotFiniteError, [[np.nan, 0, 0]])]
)
def test_what_is_no_place_is_refused(error: type[Exception], points: list) -> None:
    cylinder = encode(bundle(0), stations=20)

    with pytest.raises(error):
        cylinder.locate(points)
    with pytest.raises(error):
        cylinder.contains(points)
