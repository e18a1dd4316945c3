"""A replay that yields: as far as its stiffness says, then back; left alone it is the route itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from app.arm import Arm, ArmInputError, FloatArray, Jaco, PlanarArm
from app.arm.physics import World
from app.arm.physics_engine import missing
from app.compliance import FEELS, FIRM, MEDIUM, SOFT, Feel, Pull, Replay, Replayed, advance, begin
from app.route import Route
from tests.app.impedance import STEPS_PER_SECOND, deviations
from tests.arm.physical import swing

PULL = 0.08
HELD = (1.5, 3.5)
DIRECTIONS = [(0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (1.0, 0.0, 0.0)]


@pytest.fixture(scope="module")
def jaco() -> Iterator[Jaco]:
    arm = Jaco()
    yield arm
    arm.close()


@pytest.fixture(scope="module")
def route() -> Route:
    times, places, _ = swing(600, 6.0)
    return Route(times, places)


@pytest.fixture(scope="module")
def first(jaco: Jaco, route: Route) -> FloatArray:
    """Joints at the beginning of the route."""
    return jaco.follow(route.positions[::10], jaco.home).joints[0]


def pulled(direction: tuple[float, float, float], length: float = PULL) -> tuple[Pull, ...]:
    """Events of a pull in the browser's rhythm: 0.3 s to draw it, then held still, then let go."""
    away = length * np.asarray(direction)
    times = np.arange(HELD[0], HELD[1], 0.05)
    shares = np.minimum((times - HELD[0]) / 0.3, 1.0)
    moves = [
        Pull(float(time), tuple((share * away).tolist())) for time, share in zip(times, shares, strict=True)
    ]
    return (*moves, Pull(HELD[1], None))


def aside(replayed: Replayed) -> FloatArray:
    """How far the hand really was from its route [m]."""
    return np.linalg.norm(replayed.positions - replayed.route, axis=1)


def whole(arm: Arm, replay: Replay, pulls: tuple[Pull, ...] = ()) -> Replayed:
    replay, replayed = advance(replay, arm, pulls, 60.0)
    assert replay.done
    return replayed


def test_left_alone_the_hand_goes_the_route_itself(jaco: Jaco, route: Route, first: FloatArray) -> None:
    replayed = whole(jaco, begin(jaco, route, 0.0, joints=first))

    np.testing.assert_allclose(replayed.route, [route.at(time) for time in replayed.times], atol=1e-9)
    assert aside(replayed).max() < 2e-4
    assert replayed.along[-1] == route.times[-1]


def test_a_planned_route_is_replayed_as_planned_even_below_the_table(jaco: Jaco) -> None:
    times, places, _ = swing(300, 3.0)
    low = places - [0.0, 0.0, 0.3]
    planned = jaco.follow(low, jaco.home)
    replayed = whole(jaco, begin(jaco, Route(times, low, planned.joints), 0.0))

    assert planned.errors.max() < 1e-3
    assert low[:, 2].min() < -0.01
    assert aside(replayed).max() < 1e-3


def test_a_hand_let_go_takes_its_plan_up_again(jaco: Jaco, route: Route, first: FloatArray) -> None:
    planned = jaco.follow(route.positions, first).joints
    replay = begin(jaco, replace(route, joints=planned), 0.0)
    replayed = whole(jaco, replay, pulled((0.0, 0.0, 1.0)))

    assert aside(replayed).max() > 0.8 * MEDIUM.deflection(PULL)
    assert aside(replayed)[replayed.times > HELD[1] + 1.0].max() < 1e-3
    assert np.abs(np.diff(replayed.joints, axis=0)).max() <= 0.03 + 1e-9
    np.testing.assert_allclose(replayed.joints[-1], planned[-1], atol=1e-9)


@pytest.mark.parametrize("feel", FEELS, ids=lambda feel: feel.name)
@pytest.mark.parametrize("direction", DIRECTIONS)
def test_a_pull_goes_as_far_as_the_stiffness_says_and_the_hand_comes_back(
    jaco: Jaco, route: Route, first: FloatArray, feel: Feel, direction: tuple[float, float, float]
) -> None:
    replayed = whole(jaco, begin(jaco, route, 0.0, feel=feel, joints=first), pulled(direction))
    away, held = aside(replayed), replayed.pulled

    np.testing.assert_allclose(away[held].max(), feel.deflection(PULL), rtol=0.15)
    np.testing.assert_allclose(away[held][-1], feel.deflection(PULL), rtol=0.15)
    assert away[replayed.times > HELD[1] + 1.0].max() < 1e-3
    assert away[replayed.times < HELD[0]].max() < 1e-3


def test_the_firmer_the_less_it_yields() -> None:
    assert SOFT.deflection(PULL) > MEDIUM.deflection(PULL) > FIRM.deflection(PULL) > 0.0


def test_a_pull_has_a_strongest_force(jaco: Jaco, route: Route, first: FloatArray) -> None:
    replayed = whole(jaco, begin(jaco, route, 0.0, feel=FIRM, joints=first), pulled((0.0, 0.0, 1.0), 0.3))

    np.testing.assert_allclose(aside(replayed).max(), FIRM.deflection(0.3), rtol=0.15)
    assert FIRM.deflection(0.3) == FIRM.deflection(3.0)


@pytest.mark.parametrize("speed", [0.25, 0.5, 1.0])
def test_a_slower_replay_takes_longer_on_the_same_route(speed: float) -> None:
    times, places, _ = swing(100, 1.0)
    replayed = whole(PlanarArm(), begin(PlanarArm(), Route(times, places), 0.0, speed=speed))

    np.testing.assert_allclose(replayed.times[-1], 1.0 / speed, atol=0.011)
    np.testing.assert_allclose(replayed.along, np.minimum(speed * replayed.times, 1.0), atol=1e-9)


def test_it_is_recorded_a_hundred_times_a_second() -> None:
    times, places, _ = swing(100, 1.0)
    replayed = whole(PlanarArm(), begin(PlanarArm(), Route(times, places), 7.0))

    np.testing.assert_allclose(np.diff(replayed.times), 0.01, atol=1e-9)
    np.testing.assert_allclose(replayed.times[0], 7.01, atol=1e-9)


def test_the_same_pulls_give_the_same_motion_however_the_calls_are_cut() -> None:
    times, places, _ = swing(300, 3.0)
    arm, pulls = PlanarArm(), pulled((0.0, 0.0, 1.0))[:20]
    replay = begin(arm, Route(times, places), 0.0)
    _, at_once = advance(replay, arm, pulls, 2.5)
    parts: list[Replayed] = []
    for until in np.arange(0.013, 2.6, 0.037):
        now = tuple(pull for pull in pulls if until - 0.037 < pull.time <= until)
        replay, part = advance(replay, arm, now, min(float(until), 2.5))
        parts.append(part)

    joints = np.concatenate([part.joints for part in parts])
    np.testing.assert_array_equal(joints, at_once.joints[: len(joints)])
    assert len(joints) > 240


def test_only_what_the_arm_can_take_is_recorded(jaco: Jaco, route: Route, first: FloatArray) -> None:
    """A soft hand is pulled out of reach."""
    replayed = whole(jaco, begin(jaco, route, 0.0, feel=SOFT, joints=first), pulled((0.0, -1.0, 0.0), 1.5))
    tips = [jaco.tool_pose(joints)[:3, 3] for joints in replayed.joints]

    np.testing.assert_array_equal(replayed.positions, tips)
    assert np.all((jaco.lower <= replayed.joints) & (replayed.joints <= jaco.upper))
    assert np.abs(np.diff(replayed.joints, axis=0)).max() <= 0.03 + 1e-9
    assert aside(replayed)[replayed.times > HELD[1] + 1.5].max() < 1e-3


def test_a_hand_pulled_against_the_end_of_reach_comes_back_without_delay() -> None:
    arm = PlanarArm()
    route = Route(np.array([0.0, 8.0]), np.array([[0.0, -0.9, 0.3], [0.0, -0.9, 0.31]]))
    replayed = whole(arm, begin(arm, route, 0.0, feel=SOFT), pulled((0.0, -1.0, 0.0), 1.0))
    released = aside(replayed)[replayed.times >= HELD[1]]

    assert released[0] < 0.1
    assert released[15] < 0.9 * released[0]


def test_a_route_out_of_reach_is_replayed_as_far_as_the_arm_goes_and_ends() -> None:
    arm = PlanarArm()
    route = Route(np.array([0.0, 2.0]), np.array([[0.0, -0.5, 0.3], [0.0, -2.0, 0.3]]))
    replayed = whole(arm, begin(arm, route, 0.0))

    assert np.linalg.norm(replayed.positions, axis=1).max() < 1.1
    np.testing.assert_allclose(replayed.times[-1], 2.0, atol=0.011)


def test_a_hand_grabbed_while_it_eases_back_is_held_where_it_is(
    jaco: Jaco, route: Route, first: FloatArray
) -> None:
    again = (*pulled((0.0, 0.0, 1.0)), Pull(3.6, (0.0, 0.0, 0.0)), Pull(5.0, None))
    replayed = whole(jaco, begin(jaco, route, 0.0, feel=SOFT, joints=first), again)
    at_grab = aside(replayed)[np.searchsorted(replayed.times, 3.6)]

    np.testing.assert_allclose(aside(replayed)[480], SOFT.deflection(float(at_grab)), rtol=0.2)


def test_the_end_waits_for_a_hand_that_is_held() -> None:
    times, places, _ = swing(100, 1.0)
    arm = PlanarArm()
    replay, _ = advance(begin(arm, Route(times, places), 0.0), arm, (Pull(0.5, (0.0, 0.0, 0.05)),), 3.0)
    later, rest = advance(replay, arm, (Pull(3.0, None),), 6.0)

    assert not replay.done
    assert replay.time == 3.0
    assert later.done
    assert len(rest.times) > 5


def test_nothing_moves_after_the_end() -> None:
    times, places, _ = swing(100, 1.0)
    arm = PlanarArm()
    replay, _ = advance(begin(arm, Route(times, places), 0.0), arm, (), 5.0)
    after, replayed = advance(replay, arm, (), 9.0)

    assert after.tick == replay.tick
    assert replayed.joints.shape == (0, 3)
    assert replayed.positions.shape == (0, 3)


def test_the_speed_may_change_on_the_way() -> None:
    times, places, _ = swing(100, 1.0)
    arm = PlanarArm()
    replay, _ = advance(begin(arm, Route(times, places), 0.0), arm, (), 0.5)
    replayed = whole(arm, replace(replay, speed=0.25))

    np.testing.assert_allclose(replayed.times[-1], 0.5 + 0.5 / 0.25, atol=0.011)


@pytest.mark.parametrize("speed", [0.0, 0.2, 1.1, float("nan")])
def test_a_speed_out_of_range_is_refused(route: Route, speed: float) -> None:
    with pytest.raises(ArmInputError, match="speed"):
        begin(PlanarArm(), route, 0.0, speed=speed)


def test_a_route_or_a_pull_that_is_none_is_refused(route: Route) -> None:
    with pytest.raises(ArmInputError, match="a route"):
        Route(np.array([0.0, 0.0]), np.zeros((2, 3)))
    with pytest.raises(ArmInputError, match="a route"):
        Route(np.array([0.0, 1.0]), np.zeros((3, 3)))
    with pytest.raises(ArmInputError, match="a route"):
        Route(np.array([0.0, 1.0]), np.zeros((2, 3)), np.zeros((3, 6)))
    with pytest.raises(ArmInputError, match="a pull"):
        advance(begin(PlanarArm(), route, 0.0), PlanarArm(), (Pull(0.1, (0.0, float("inf"), 0.0)),), 1.0)


@pytest.mark.skipif(missing() is not None, reason="pybullet is not installed (the extra `physics`)")
@pytest.mark.parametrize("feel", FEELS, ids=lambda feel: feel.name)
def test_full_physics_yields_the_same_way(jaco: Jaco, route: Route, first: FloatArray, feel: Feel) -> None:
    away = PULL * np.asarray(DIRECTIONS[0])
    events = (Pull(HELD[0], (float(away[0]), float(away[1]), float(away[2]))), Pull(HELD[1], None))
    replayed = whole(jaco, begin(jaco, route, 0.0, feel=feel, joints=first), events)
    with World() as world:
        joints = jaco.follow(route.positions, first).joints
        physical = deviations(world, route, joints, feel=feel, pull=away, held=HELD)
    clock = np.arange(len(physical)) / STEPS_PER_SECOND
    resampled = np.stack([np.interp(replayed.times, clock, along) for along in physical.T], axis=1)
    apart = np.linalg.norm(replayed.positions - replayed.route - resampled, axis=1)

    np.testing.assert_allclose(aside(replayed).max(), np.linalg.norm(physical, axis=1).max(), rtol=0.02)
    assert np.sqrt(np.mean(apart**2)) < 0.06 * feel.deflection(PULL)
    assert apart.max() < 0.25 * feel.deflection(PULL)
