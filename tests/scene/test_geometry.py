"""Laws of the shapes that are drawn."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from app.document import FloatArray
from app.scene import geometry as g
from app.scene import polyline as p

LINES = st.integers(2, 30).flatmap(
    lambda n: arrays(np.float64, (n, 3), elements=st.floats(-1.0, 1.0, width=32))
)


def curve(n: int = 80) -> FloatArray:
    u = np.linspace(0.0, 1.0, n)
    return np.stack([0.3 * np.sin(5.0 * u), 0.6 * u, 0.2 + 0.2 * u**2], axis=1)


def round_tube(n: int = 20, m: int = 12) -> FloatArray:
    """Rings about +z, each counter-clockwise about it."""
    ring = g.circle(0.1, m)
    return np.stack([ring + np.array([0.0, 0.0, z]) for z in np.linspace(0.0, 1.0, n)])


def edge_uses(faces: np.ndarray) -> dict[tuple[int, int], int]:
    """How often each directed edge is walked."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    found, counts = np.unique(edges, axis=0, return_counts=True)
    return {(int(a), int(b)): int(n) for (a, b), n in zip(found, counts, strict=True)}


def areas(vertices: np.ndarray, faces: np.ndarray) -> FloatArray:
    a, b, c = (vertices[faces[:, k]].astype(np.float64) for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    """Positive when the faces of a closed body look outward."""
    a, b, c = (vertices[faces[:, k]].astype(np.float64) for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def test_a_tube_is_a_closed_strip_with_two_rims() -> None:
    n, m = 20, 12
    uses = edge_uses(g.tube_mesh(round_tube(n, m))[1])

    open_edges = [edge for edge in uses if edge[::-1] not in uses]
    assert set(uses.values()) == {1}
    assert len(open_edges) == 2 * m


def test_the_faces_of_a_tube_look_outward() -> None:
    vertices, faces = g.tube_mesh(round_tube())
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    outward = (a + b + c) * [1.0, 1.0, 0.0]

    assert np.all(np.einsum("ij,ij->i", np.cross(b - a, c - a), outward) > 0.0)


def test_a_tube_has_no_degenerate_face() -> None:
    assert areas(*g.tube_mesh(round_tube())).min() > 1e-6


def test_the_vertices_of_a_tube_are_its_surface() -> None:
    surface = round_tube()

    np.testing.assert_allclose(g.tube_mesh(surface)[0], surface.reshape(-1, 3), atol=1e-6)


def test_equal_counts_give_the_same_faces_object() -> None:
    assert g.tube_mesh(round_tube())[1] is g.tube_mesh(2.0 * round_tube())[1]


def test_a_torus_is_closed_and_looks_outward() -> None:
    vertices, faces = g.torus(0.05, 0.01)
    uses = edge_uses(faces)

    assert all(edge[::-1] in uses for edge in uses)
    assert volume(vertices, faces) == pytest.approx(2.0 * np.pi**2 * 0.05 * 0.005**2, rel=0.15)


def test_bodies_put_together_keep_their_volumes() -> None:
    small, large = g.torus(0.02, 0.006), g.torus(0.05, 0.01)

    assert volume(*g.together(small, large)) == pytest.approx(volume(*small) + volume(*large))


@pytest.mark.parametrize("height", [0.4, -0.1])
def test_a_stem_reaches_from_the_landmark_to_the_table(height: float) -> None:
    vertices, faces = g.stem(height, 0.004)

    assert sorted({float(z) for z in vertices[:, 2]}) == pytest.approx(sorted([0.0, -height]))
    assert areas(vertices, faces).min() > 0.0


def test_a_disc_is_seen_from_above() -> None:
    vertices, faces = g.disc(0.02)
    a, b, c = (vertices[faces[:, k]] for k in range(3))

    assert np.all(np.cross(b - a, c - a)[:, 2] > 0.0)


@given(points=LINES)
def test_every_box_of_a_pick_tube_is_closed_and_looks_outward(points: FloatArray) -> None:
    vertices, faces = g.pick_tube(points, 0.01)
    for box in faces.reshape(-1, 12, 3)[::11]:
        uses = edge_uses(box)
        corners = vertices - vertices[box].mean(axis=(0, 1))

        assert all(edge[::-1] in uses for edge in uses)
        assert volume(corners, box) > 0.0


@given(points=LINES)
def test_a_pick_tube_has_no_degenerate_face(points: FloatArray) -> None:
    assert areas(*g.pick_tube(points, 0.01)).min() > 1e-6


def test_a_pick_tube_surrounds_the_line() -> None:
    points = curve()
    corners = g.pick_tube(points, 0.01)[0].astype(np.float64)
    distance = np.linalg.norm(points[:, None] - corners[None], axis=-1)

    assert distance.min(axis=1).max() < 0.02
    assert distance.min(axis=0).max() < 0.02


@given(points=LINES)
def test_places_along_a_line_keep_their_order_and_its_ends(points: FloatArray) -> None:
    length = p.arc_length(points)
    found = p.along(points, length)

    np.testing.assert_allclose(found, points, atol=1e-6)


def test_dashes_lie_on_the_line_and_cover_their_share_of_it() -> None:
    points = np.array([[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0]])
    found = p.dashes(points, dash=0.03, gap=0.02)
    covered = np.linalg.norm(found[:, 1] - found[:, 0], axis=1)

    np.testing.assert_array_equal(found[..., 1:], 0.0)
    assert covered.sum() == pytest.approx(0.6)
    assert np.all(covered <= 0.03 + 1e-12)


def test_a_line_without_length_has_no_dashes() -> None:
    assert p.dashes(np.ones((4, 3))).shape == (0, 2, 3)


@given(n=st.integers(1, 500), most=st.integers(2, 100))
def test_thinning_out_keeps_both_ends_and_only_given_points(n: int, most: int) -> None:
    points = np.arange(3.0 * n).reshape(n, 3)
    kept = p.thin_out(points, most)

    assert len(kept) == min(n, most)
    assert len(np.unique(kept[:, 0])) == len(kept)
    np.testing.assert_array_equal(kept[[0, -1]], points[[0, -1]])
    assert np.isin(kept, points).all()


@given(turn=arrays(np.float64, (5, 4), elements=st.floats(-1.0, 1.0)).filter(
    lambda q: bool(np.all(np.linalg.norm(q, axis=1) > 0.1))
))  # fmt: skip
def test_quaternions_turn_as_their_rotations_do(turn: FloatArray) -> None:
    w, x, y, z = (turn / np.linalg.norm(turn, axis=1, keepdims=True)).T
    rotations = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    ).transpose(2, 0, 1)
    found = g.quaternions(rotations)
    alike = np.abs(np.einsum("ij,ij->i", found, np.stack([w, x, y, z], axis=1)))

    np.testing.assert_allclose(alike, 1.0, atol=1e-9)


def test_arrowheads_point_along_the_line() -> None:
    points = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    cones = g.arrowheads(points, count=3)[0].reshape(3, -1, 3)

    assert np.all(cones[:, 0, 2] > cones[:, 1:, 2].max(axis=1))


def test_arrowheads_look_outward() -> None:
    vertices, faces = g.arrowheads(curve(), count=1)

    assert volume(vertices - vertices.mean(axis=0), faces) > 0.0


@given(index=st.integers(0, 79))
def test_a_ray_through_a_point_of_a_line_finds_its_neighbourhood(index: int) -> None:
    points = curve()
    origin = np.array([0.9, -1.4, 0.9])
    found = p.nearest_to_ray(points, origin, points[index] - origin, 0.015)

    assert np.linalg.norm(points[found] - points[index]) < 0.03


def test_of_two_stretches_under_a_ray_the_one_in_front_is_meant() -> None:
    points = np.array([[0.0, 1.0, 0.0], [0.5, 1.5, 0.0], [0.0, 2.0, 0.0]])

    assert p.nearest_to_ray(points[::-1], np.zeros(3), np.array([0.0, 1.0, 0.0]), 0.01) == 2
