from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from gc_core import (
    Demonstration,
    GeneralizedCylinder,
    InvalidSettingError,
    NotFiniteError,
    ShapeError,
    TooFarError,
    UnknownOptionError,
    encode,
    reproduce,
)
from gc_core.radius import radius_at
from gc_core.sections import SECTIONS
from tests.core.shapes import bundle, seeds
from tests.core.steps import JUMP, worst_step_ratio

sections = st.sampled_from(sorted(SECTIONS))
laws = st.sampled_from(["fixed", "convergent"])


def start_at(cylinder: GeneralizedCylinder, ratio: float, angle: float, station: int = 0) -> np.ndarray:
    edge = radius_at(cylinder.radii, np.array(station), np.array(angle))
    across = cylinder.frames[station, :, 1:] @ [np.cos(angle), np.sin(angle)]
    return cylinder.directrix[station] + ratio * edge * across


@settings(max_examples=60, deadline=None)
@given(seed=seeds, section=sections, law=laws, ratio=st.floats(0.0, 1.0), angle=st.floats(-10.0, 10.0))
def test_a_run_from_inside_stays_inside(
    seed: int, section: str, law: str, ratio: float, angle: float
) -> None:
    cylinder = encode(bundle(seed), section=section, stations=60)
    run = reproduce(cylinder, start_at(cylinder, ratio, angle), law=law)

    assert run.start_inside is True
    assert cylinder.contains(run.positions).all()


@settings(max_examples=40, deadline=None)
@given(seed=seeds, ratio=st.floats(0.0, 1.0), angle=st.floats(-4.0, 4.0), station=st.integers(0, 50))
def test_a_run_from_inside_a_later_station_joins_there(
    seed: int, ratio: float, angle: float, station: int
) -> None:
    cylinder = encode(bundle(seed), stations=60)
    run = reproduce(cylinder, start_at(cylinder, ratio, angle, station))

    assert run.stations[0] <= station + 1e-6
    assert len(run.positions) == len(run.stations) == len(run.times)
    assert cylinder.contains(run.positions).all()


@settings(max_examples=30, deadline=None)
@given(seed=seeds, section=sections)
def test_a_run_from_the_centre_is_the_directrix(seed: int, section: str) -> None:
    cylinder = encode(bundle(seed), section=section)
    run = reproduce(cylinder, cylinder.directrix[0])

    np.testing.assert_allclose(run.positions, cylinder.directrix, atol=1e-12)
    np.testing.assert_allclose(run.ratios, 0.0, atol=1e-9)


@settings(max_examples=30, deadline=None)
@given(seed=seeds, section=sections, vertex=st.integers(0, 63))
def test_a_run_from_the_boundary_stays_on_it(seed: int, section: str, vertex: int) -> None:
    cylinder = encode(bundle(seed), section=section)
    run = reproduce(cylinder, cylinder.surface()[0, vertex])

    np.testing.assert_allclose(run.positions, cylinder.surface()[:, vertex], atol=1e-9)


@settings(max_examples=60, deadline=None)
@given(
    seed=seeds,
    start=st.tuples(*[st.floats(-2.0, 2.0)] * 3),
    section=sections,
    law=laws,
)
def test_a_run_begins_at_its_start_wherever_that_is(seed: int, start: tuple, section: str, law: str) -> None:
    run = reproduce(encode(bundle(seed), section=section, stations=60), start, law=law)

    np.testing.assert_allclose(run.positions[0], start, atol=1e-12)
    assert np.isfinite(run.positions).all()
    assert np.isfinite(run.ratios).all()
    assert (np.diff(run.times) > 0.0).all()
    assert len(run.positions) >= 2


@settings(max_examples=40, deadline=None)
@given(seed=seeds, back=st.floats(0.01, 0.1), ratio=st.floats(0.0, 0.8))
def test_a_start_off_the_first_plane_is_joined_without_a_jump(seed: int, back: float, ratio: float) -> None:
    cylinder = encode(bundle(seed))
    start = start_at(cylinder, ratio, 1.0) - back * cylinder.frames[0, :, 0]
    positions = reproduce(cylinder, start).positions

    assert worst_step_ratio(positions[None]).max() <= JUMP


def test_a_start_outside_keeps_its_ratio_above_one() -> None:
    cylinder = encode(bundle(1))
    run = reproduce(cylinder, start_at(cylinder, 3.0, 0.7), at=0)

    np.testing.assert_allclose(run.ratios, 3.0, rtol=1e-9)
    assert run.start_inside is False


@settings(max_examples=30, deadline=None)
@given(seed=seeds, ratio=st.floats(0.1, 3.0), final=st.floats(0.0, 1.0))
def test_the_convergent_law_ends_at_its_final_ratio_and_never_widens(
    seed: int, ratio: float, final: float
) -> None:
    cylinder = encode(bundle(seed), stations=60)
    run = reproduce(cylinder, start_at(cylinder, ratio, 1.0), law="convergent", final_ratio=final, at=0)

    np.testing.assert_allclose(run.ratios[-1], min(ratio, final), atol=1e-9)
    assert (np.diff(run.ratios) <= 1e-12).all()


@settings(max_examples=20, deadline=None)
@given(seed=seeds)
def test_several_starts_give_the_runs_that_each_gives_alone(seed: int) -> None:
    cylinder = encode(bundle(seed), stations=60)
    starts = np.array(
        [start_at(cylinder, ratio, angle) for ratio, angle in ((0.2, 0), (0.9, 2), (0.0, 0), (0.5, 4))]
    )
    together = reproduce(cylinder, starts)

    assert together.positions.shape == (4, 60, 3)
    for start, run in zip(starts, together.positions, strict=True):
        np.testing.assert_allclose(run, reproduce(cylinder, start, at=0).positions, atol=1e-9)


def test_a_run_of_several_that_joins_later_waits_at_its_start() -> None:
    cylinder = encode(bundle(2), stations=60)
    late = start_at(cylinder, 0.5, 1.0, 30)
    runs = reproduce(cylinder, np.array([cylinder.directrix[0], late])).positions

    np.testing.assert_array_equal(runs[1, :29], np.broadcast_to(late, (29, 3)))
    assert cylinder.contains(runs[1]).all()


@settings(max_examples=30, deadline=None)
@given(seed=seeds, which=st.integers(0, 3))
def test_a_run_from_a_demonstration_s_start_stays_near_it(seed: int, which: int) -> None:
    shown = bundle(seed)
    cylinder = encode(shown, align_by="arc_length")
    run = reproduce(cylinder, shown[which].positions[0])

    away = np.linalg.norm(run.positions[:, None] - shown[which].positions, axis=2).min(axis=1)
    assert away.max() <= 2.0 * cylinder.radii.max()


def test_a_tube_that_passes_itself_is_joined_at_its_first_passage() -> None:
    angle = np.linspace(0.0, 2.2 * np.pi, 400)
    rings = [
        np.stack((r * np.cos(angle), r * np.sin(angle), 0.001 * angle), axis=1) for r in (0.19, 0.2, 0.21)
    ]
    cylinder = encode([Demonstration(angle, ring) for ring in rings], section="circle")

    assert reproduce(cylinder, cylinder.directrix[4]).stations[0] <= 4.001


def test_orientation_and_gripper_follow_the_stations() -> None:
    turn = np.linspace(0.0, 0.5, 120)
    quaternions = np.stack((np.cos(turn), np.sin(turn), 0.0 * turn, 0.0 * turn), axis=1)
    shown = [Demonstration(d.times, d.positions, quaternions, (turn > 0.25) * 1.0) for d in bundle(3)]
    cylinder = encode(shown, stations=60)
    run = reproduce(cylinder, cylinder.directrix[20] * 0.5 + cylinder.directrix[21] * 0.5)

    assert run.orientations is not None
    assert run.gripper is not None
    np.testing.assert_allclose(np.linalg.norm(run.orientations, axis=1), 1.0, atol=1e-9)
    assert len(run.orientations) == len(run.gripper) == len(run.positions) == 40


@pytest.mark.parametrize(
    ("error", "start", "options"),
    [
        (NotFiniteError, [np.nan, 0.0, 0.0], {}),
        (ShapeError, [0.0, 0.0], {}),
        (ShapeError, [[0.0, 0.0, 0.0], [0.0, 0.0]], {}),
        (TooFarError, [1e160, 0.0, 0.0], {}),
        (UnknownOptionError, [0.0, 0.0, 0.0], {"law": "wild"}),
        (InvalidSettingError, [0.0, 0.0, 0.0], {"final_ratio": -1.0}),
        (InvalidSettingError, [0.0, 0.0, 0.0], {"at": 1000}),
    ],
)
def test_what_cannot_be_run_is_refused(error: type[Exception], start: list, options: dict) -> None:
    with pytest.raises(error):
        reproduce(encode(bundle(0)), start, **options)


@settings(max_examples=30, deadline=None)
@given(seed=seeds, ratio=st.floats(0.0, 0.98), angle=st.floats(-4.0, 4.0), back=st.floats(0.0, 1.0))
@example(seed=5, ratio=0.5, angle=0.0, back=1.0)  # in the plane of a station, but for rounding
def test_a_run_from_the_last_slice_stays_there(seed: int, ratio: float, angle: float, back: float) -> None:
    # Not up to 1: the boundary between two stations is not quite the chord that the start is taken from.
    cylinder = encode(bundle(seed), stations=60)
    earlier, last = (start_at(cylinder, ratio, angle, station) for station in (58, 59))
    run = reproduce(cylinder, last + back * (earlier - last))

    assert run.start_inside
    assert len(run.positions) >= 2
    assert cylinder.contains(run.positions).all()
    assert (np.diff(run.times) > 0.0).all()


@pytest.mark.parametrize(("outside", "end"), [("boundary", 1.0), ("directrix", 0.0)])
def test_a_start_outside_of_a_narrow_slice_is_led_and_not_flung_away(outside: str, end: float) -> None:
    narrow = np.linspace(0.0, 1.0, 80)[:, None]  # all demonstrations begin in one point
    demonstrations = [
        Demonstration(
            3.0 * narrow[:, 0],
            np.hstack([narrow, 0.1 * narrow * np.cos(turn), 0.1 * narrow * np.sin(turn)]),
        )
        for turn in (0.0, 2.0, 4.0)
    ]
    cylinder = encode(demonstrations)
    start = np.array([-0.005, 0.05, 0.02])

    run = reproduce(cylinder, start, outside=outside)

    away = np.linalg.norm(run.positions - cylinder.directrix, axis=1)
    assert not run.start_inside
    np.testing.assert_array_equal(run.positions[0], start)
    assert np.all(away <= np.linalg.norm(start - cylinder.directrix[0]) + cylinder.radii.max(axis=1))
    assert run.ratios[0] > 1.0
    np.testing.assert_allclose(run.ratios[-1], end, atol=1e-6)


def test_a_policy_for_starts_outside_must_exist() -> None:
    with pytest.raises(UnknownOptionError, match="boundary"):
        reproduce(encode(bundle(0)), (0.0, 0.0, 0.0), outside="nowhere")
