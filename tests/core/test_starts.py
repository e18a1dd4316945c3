"""Runs from starts anywhere: in the tube at any station, on it, off the planes, outside, far away."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from gc_core import Demonstration, GeneralizedCylinder, encode, reproduce
from gc_core.arrays import FloatArray
from gc_core.ratio_rule import JOIN_LENGTH
from gc_core.reproduction import OUTSIDE
from tests.core.shapes import bundle, seeds
from tests.core.steps import JUMP, worst_step_ratio
from tests.core.test_locate import arc, inner, tilted

laws = st.sampled_from(["fixed", "convergent"])
policies = st.sampled_from(OUTSIDE)
anywhere = st.tuples(*[st.floats(-0.5, 1.0)] * 3)


def ratio_by_hand(cylinder: GeneralizedCylinder, point: FloatArray, station: int) -> float:
    """Ratio of a point after projection onto a section's plane: where its ray leaves the polygon."""
    x, y = (point - cylinder.directrix[station]) @ cylinder.frames[station, :, 1:]
    angle, width = np.arctan2(y, x) % (2.0 * np.pi), 2.0 * np.pi / cylinder.radii.shape[1]
    sides = np.array([angle // width, angle // width + 1.0])
    rim = cylinder.radii[station, sides.astype(int) % cylinder.radii.shape[1]]
    ends = rim[:, None] * np.stack((np.cos(sides * width), np.sin(sides * width)), axis=1)
    return float(np.linalg.solve(ends.T, [x, y]).sum())


def behind(cylinder: GeneralizedCylinder, ratio: float, back: float) -> FloatArray:
    return inner(cylinder, 0, ratio, 1.0) - back * cylinder.frames[0, :, 0]


@settings(max_examples=60, deadline=None)
@given(
    seed=seeds,
    station=st.integers(0, 59),
    place=st.tuples(st.floats(0.0, 1.0), st.floats(-4.0, 4.0)),
    law=laws,
    leaning=st.booleans(),
)
def test_a_run_from_any_section_of_the_tube_stays_inside(
    seed: int, station: int, place: tuple, law: str, leaning: bool
) -> None:
    cylinder = encode(bundle(seed), stations=60)
    cylinder = tilted(cylinder) if leaning else cylinder
    start = inner(cylinder, station, *place)

    for at in (None, min(station, 58)):
        run = reproduce(cylinder, start, law=law, at=at)
        assert run.start_inside is True
        if station < 59 or at is None:
            assert cylinder.contains(run.positions).all()


@settings(max_examples=15, deadline=None)
@given(seed=seeds, law=laws)
def test_no_run_from_inside_jumps(seed: int, law: str) -> None:
    cylinder, rng = encode(bundle(seed)), np.random.default_rng(seed)
    assume(not cylinder.diagnostics.crossing.any())  # where sections cross, the tube itself turns back
    stations = rng.integers(0, 199, 200)
    starts = np.array([inner(cylinder, i, rng.uniform(0.0, 1.0), rng.uniform(0.0, 7.0)) for i in stations])

    assert worst_step_ratio(reproduce(cylinder, starts, law=law).positions).max() <= JUMP
    for start in starts[:10]:
        assert worst_step_ratio(reproduce(cylinder, start, law=law).positions[None]).max() <= JUMP


def test_runs_round_a_hairpin_do_not_jump_nor_leave_it() -> None:
    hairpin = arc(3.4, radius=0.05, width=0.02)
    rng = np.random.default_rng(0)
    starts = np.array([inner(hairpin, 0, rng.uniform(0.0, 1.0), rng.uniform(0.0, 7.0)) for _ in range(200)])
    positions = reproduce(hairpin, starts).positions

    assert worst_step_ratio(positions).max() <= JUMP
    assert hairpin.contains(positions.reshape(-1, 3)).all()


def test_a_jump_is_noticed_wherever_it_is() -> None:
    even = np.zeros((5, 60, 3))
    even[:, :, 0] = np.arange(60.0)
    even[0, 40:, 1] = even[1, 1:, 1] = even[2, -1:, 1] = 6.0
    even[3, :20] = even[3, 20]

    np.testing.assert_allclose(worst_step_ratio(even), [37.0**0.5] * 3 + [1.0, 1.0])


@settings(max_examples=12, deadline=None)
@given(seed=seeds, law=laws, outside=policies, at=st.sampled_from([None, 0, 17]))
@example(seed=142, law="fixed", outside="keep", at=0)  # a start in the plane of the next station
def test_many_starts_give_the_runs_that_each_gives_alone(
    seed: int, law: str, outside: str, at: int | None
) -> None:
    cylinder, rng = encode(bundle(seed), stations=60), np.random.default_rng(seed)
    held = [inner(cylinder, i, rng.uniform(0.0, 1.0), rng.uniform(0.0, 7.0)) for i in rng.integers(0, 59, 5)]
    starts = np.array([*held, *rng.uniform(-0.4, 0.9, (5, 3)), cylinder.directrix[0]])
    together = reproduce(cylinder, starts, law=law, outside=outside, at=at)

    for i, start in enumerate(starts):
        alone = reproduce(cylinder, start, law=law, outside=outside, at=at)
        count = len(alone.positions) - 1
        waiting = len(together.stations) - count
        np.testing.assert_array_equal(together.positions[i, :waiting], np.tile(start, (waiting, 1)))
        np.testing.assert_allclose(together.positions[i, -count:], alone.positions[1:], atol=1e-12)
        np.testing.assert_allclose(together.ratios[i, -count:], alone.ratios[1:], atol=1e-9, rtol=1e-9)
        np.testing.assert_allclose(together.ratios[i, :-count], alone.ratios[0], atol=1e-9, rtol=1e-9)
        assert together.start_inside[i] == alone.start_inside


@settings(max_examples=40, deadline=None)
@given(seed=seeds, start=anywhere, law=laws, outside=policies, at=st.sampled_from([None, 0, 30]))
def test_the_ratios_are_those_of_the_positions(
    seed: int, start: tuple, law: str, outside: str, at: int | None
) -> None:
    cylinder = encode(bundle(seed), stations=60)
    run = reproduce(cylinder, start, law=law, outside=outside, at=at)
    whole = [i for i, station in enumerate(run.stations) if station == round(station)]
    truth = [ratio_by_hand(cylinder, run.positions[i], int(run.stations[i])) for i in whole]

    np.testing.assert_allclose(run.ratios[whole], truth, rtol=1e-6, atol=1e-9)


@settings(max_examples=60, deadline=None)
@given(seed=seeds, start=anywhere, outside=policies, law=laws)
def test_whether_a_start_is_inside_is_what_contains_says(
    seed: int, start: tuple, outside: str, law: str
) -> None:
    cylinder = encode(bundle(seed), stations=60)
    run = reproduce(cylinder, start, outside=outside, law=law)

    assert run.start_inside == bool(cylinder.contains([start])[0])
    np.testing.assert_array_equal(run.positions[0], start)


@settings(max_examples=60, deadline=None)
@given(seed=seeds, start=anywhere)
def test_starts_outside_end_where_their_policy_says(seed: int, start: tuple) -> None:
    cylinder = encode(bundle(seed), stations=60)
    for outside, end in (("keep", np.inf), ("boundary", 1.0), ("directrix", 0.0)):
        run = reproduce(cylinder, start, outside=outside)
        begin = run.ratios[0]
        expected = min(begin, end) if begin > 1.0 + 1e-9 else begin
        np.testing.assert_allclose(run.ratios[-1], expected, rtol=1e-6, atol=1e-6)


@settings(max_examples=40, deadline=None)
@given(seed=seeds, ratio=st.floats(0.0, 0.95), back=st.floats(1e-5, 0.1), outside=policies)
def test_a_start_before_the_first_plane_comes_straight_in_and_keeps_its_ratio(
    seed: int, ratio: float, back: float, outside: str
) -> None:
    cylinder = encode(bundle(seed))
    start = behind(cylinder, ratio, back)
    run = reproduce(cylinder, start, outside=outside)

    if not cylinder.contains([start])[0] and run.stations[0] == 0.0:
        assert run.start_inside is False
        np.testing.assert_allclose(run.ratios[[0, -1]], ratio, atol=1e-9)
        assert worst_step_ratio(run.positions[None]).max() <= JUMP


@settings(max_examples=60, deadline=None)
@given(seed=seeds, ratio=st.floats(0.0, 4.0), back=st.floats(0.001, 1.0), outside=policies)
def test_what_a_start_is_off_the_rule_s_path_fades_no_faster_than_stated(
    seed: int, ratio: float, back: float, outside: str
) -> None:
    cylinder = encode(bundle(seed))
    run = reproduce(cylinder, behind(cylinder, ratio, back), at=0, outside=outside)
    kept = ratio if ratio <= 1.0 or outside == "keep" else float(outside == "boundary")
    rule = np.array([inner(cylinder, i, kept, 1.0) for i in range(200)])
    assume(run.stations[0] == 0.0)  # else the next section passes through the start: nothing fades out
    gap = np.linalg.norm(run.positions - rule, axis=1)
    length = cylinder.arc_length[-1]
    reach = min(max(2.0 * gap[0], JOIN_LENGTH * length), length)

    assert gap[-1] <= 1e-9
    assert (np.diff(gap) <= 1e-12).all()
    pace = -np.diff(gap) / np.diff(cylinder.arc_length)
    assert pace.max() <= 1.5 * gap[0] / reach * (1.0 + 1e-6)
    assert pace[0] <= 0.1 * pace.max()


@settings(max_examples=60, deadline=None)
@given(seed=seeds, start=anywhere)
def test_no_run_that_is_led_to_the_directrix_jumps(seed: int, start: tuple) -> None:
    cylinder = encode(bundle(seed))
    run = reproduce(cylinder, start, outside="directrix")

    if not run.start_inside:
        assert worst_step_ratio(run.positions[None]).max() <= JUMP


@settings(max_examples=30, deadline=None)
@given(seed=seeds, beyond=st.floats(0.001, 0.5), aside=st.floats(-0.2, 0.2))
def test_a_run_from_beyond_the_goal_comes_back_to_it(seed: int, beyond: float, aside: float) -> None:
    cylinder = encode(bundle(seed))
    start = cylinder.directrix[-1] + cylinder.frames[-1] @ [beyond, 0.0, aside]
    run = reproduce(cylinder, start, outside="boundary")

    assert np.linalg.norm(run.positions[-1] - cylinder.directrix[-1]) <= cylinder.radii[-1].max() + 1e-9


@settings(max_examples=30, deadline=None)
@given(seed=seeds, at=st.integers(0, 58), part=st.floats(0.0, 0.999), ratio=st.floats(0.0, 0.9))
def test_a_start_just_after_the_given_station_joins_where_it_lies(
    seed: int, at: int, part: float, ratio: float
) -> None:
    cylinder = encode(bundle(seed), stations=60)
    here, there = inner(cylinder, at, ratio, 1.0), inner(cylinder, at + 1, ratio, 1.0)
    run = reproduce(cylinder, here + part * (there - here), at=at)

    assert len(run.positions) == 60 - at
    assert at <= run.stations[0] < at + 1
    assert cylinder.contains(run.positions).all()
    np.testing.assert_allclose(run.positions[1], there, atol=1e-3)


@settings(max_examples=30, deadline=None)
@given(seed=seeds, station=st.integers(0, 100))
def test_the_convergent_law_begins_and_ends_level(seed: int, station: int) -> None:
    cylinder = encode(bundle(seed))
    run = reproduce(cylinder, inner(cylinder, station, 0.8, 2.0), law="convergent")
    gone = np.interp(run.stations, np.arange(200), cylinder.arc_length)
    slope = np.diff(run.ratios) / np.diff(gone)

    np.testing.assert_allclose(run.ratios[-1], 0.0, atol=1e-12)
    assert np.abs(slope[[0, -1]]).max() <= 0.05 * np.abs(slope).max()
    assert np.abs(np.diff(slope)).max() <= 0.1 * np.abs(slope).max()


@pytest.mark.parametrize("at", [None, 0, 40])
def test_orientation_and_gripper_are_those_of_the_stations(at: int | None) -> None:
    turn = np.linspace(0.0, 0.5, 120)
    quaternions = np.stack((np.cos(turn), np.sin(turn), 0.0 * turn, 0.0 * turn), axis=1)
    shown = [Demonstration(d.times, d.positions, quaternions, (turn > 0.25) * 1.0) for d in bundle(3)]
    cylinder = encode(shown, stations=60)
    run = reproduce(cylinder, (0.3, 0.5, -0.4), at=at, outside="boundary")
    stations = run.stations[1:].astype(int)

    assert cylinder.orientations is not None
    assert run.orientations is not None
    assert cylinder.gripper is not None
    assert run.gripper is not None
    np.testing.assert_allclose(run.orientations[1:], cylinder.orientations[stations], atol=1e-12)
    np.testing.assert_array_equal(run.gripper[1:], cylinder.gripper[stations])


def test_a_million_numbers_of_runs_are_not_copied_and_cannot_be_written() -> None:
    cylinder = encode(bundle(0))
    run = reproduce(cylinder, np.tile(cylinder.directrix[0], (50, 1)))

    assert run.positions.flags.owndata
    for samples in (run.positions, run.ratios, reproduce(cylinder, cylinder.directrix[0]).ratios):
        with pytest.raises(ValueError, match="read-only"):
            samples[0] = 1.0
