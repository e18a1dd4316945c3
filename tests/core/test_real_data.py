"""Recordings of people and arms that nobody tuned for; skipped where they are not present."""

from __future__ import annotations

import numpy as np
import pytest

from gc_core import encode, generalize, register, reproduce
from gc_core.alignment import ALIGNMENTS
from gc_core.radius import radius_at
from gc_core.sections import SECTIONS
from tests.core.test_encode import in_plane, ratios_to_polygons
from tests.helpers_data import ALL_SETS, POSE_SETS, load

every_set = pytest.mark.parametrize("name", ALL_SETS)
every_section = pytest.mark.parametrize("section", sorted(SECTIONS))
every_alignment = pytest.mark.parametrize("align_by", ALIGNMENTS)


@every_set
@every_section
@every_alignment
def test_every_effective_point_is_inside_and_nothing_is_nan(name: str, section: str, align_by: str) -> None:
    cylinder = encode(load(name), section=section, align_by=align_by)

    assert np.isfinite(cylinder.surface()).all()
    assert np.isfinite(cylinder.times).all()
    np.testing.assert_allclose(in_plane(cylinder, cylinder.effective_points)[..., 0], 0.0, atol=1e-9)
    assert ratios_to_polygons(cylinder).max() <= 1.0 + 1e-9
    slope = np.abs(np.diff(cylinder.radii, axis=0)) / np.diff(cylinder.arc_length)[:, None]
    assert slope.max() <= 2.0 + 1e-6


@every_set
@every_section
@every_alignment
def test_runs_from_inside_stay_inside(name: str, section: str, align_by: str) -> None:
    cylinder = encode(load(name), section=section, align_by=align_by)
    rng = np.random.default_rng(0)
    angles, ratios = rng.uniform(0.0, 2.0 * np.pi, 100), np.sqrt(rng.uniform(0.0, 1.0, 100))
    away = ratios * radius_at(cylinder.radii, np.zeros(100, dtype=int), angles)
    starts = cylinder.directrix[0] + away[:, None] * (
        np.stack((np.cos(angles), np.sin(angles)), axis=1) @ cylinder.frames[0, :, 1:].T
    )
    runs = reproduce(cylinder, starts)

    assert cylinder.contains(runs.positions.reshape(-1, 3)).all()


@every_set
@every_alignment
def test_a_run_from_each_demonstration_s_start_is_finite(name: str, align_by: str) -> None:
    shown = load(name)
    cylinder = encode(shown, align_by=align_by)

    for demonstration in shown:
        run = reproduce(cylinder, demonstration.positions[0], law="convergent")
        assert np.isfinite(run.positions).all()
        np.testing.assert_allclose(run.positions[0], demonstration.positions[0], atol=1e-12)


@every_set
@every_section
def test_moved_ends_are_met_and_effective_points_stay_inside(name: str, section: str) -> None:
    cylinder = encode(load(name), section=section, align_by="arc_length")
    ends = cylinder.directrix[[0, -1]]
    for seed in range(5):
        targets = ends + np.random.default_rng(seed).uniform(-0.1, 0.1, size=(2, 3))
        moved = generalize(cylinder, register(ends, targets))
        np.testing.assert_allclose(moved.directrix[[0, -1]], targets, atol=1e-9)
        assert np.isfinite(moved.surface()).all()
        assert ratios_to_polygons(moved).max() <= 1.0 + 1e-9


@pytest.mark.parametrize("name", [*POSE_SETS, "lab"])
def test_orientations_are_unit_and_continuous(name: str) -> None:
    orientations = encode(load(name), align_by="arc_length").orientations

    assert orientations is not None
    np.testing.assert_allclose(np.linalg.norm(orientations, axis=1), 1.0, atol=1e-9)
    assert (np.einsum("ij,ij->i", orientations[1:], orientations[:-1]) > 0.8).all()


def test_the_lab_s_stationary_ends_are_cut() -> None:
    diagnostics = encode(load("lab")).diagnostics

    assert (diagnostics.trimmed_end > 1.0).all()
    assert (diagnostics.trimmed_end < 6.0).all()
