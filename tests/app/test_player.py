"""The playhead."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app import player
from app.store import Playback

PLAYING = Playback(time=1.0, duration=4.0, playing=True)
STEPS = st.lists(st.floats(0.0, 0.2), max_size=120)


@given(steps=STEPS, speed=st.sampled_from(player.SPEEDS))
def test_without_a_loop_it_never_leaves_the_reproduction_and_ends_at_its_end(
    steps: list[float], speed: float
) -> None:
    playback = PLAYING
    for dt in steps:
        playback = player.advance(playback, dt, speed=speed, loop=False)

    assert playback.time == pytest.approx(min(1.0 + speed * sum(steps), 4.0))
    assert playback.playing == (playback.time < 4.0)


@given(steps=STEPS, speed=st.sampled_from(player.SPEEDS))
def test_a_loop_never_ends(steps: list[float], speed: float) -> None:
    playback = PLAYING
    for dt in steps:
        playback = player.advance(playback, dt, speed=speed, loop=True)

    assert playback.playing
    assert 0.0 <= playback.time < 4.0 + speed * player.REST


@pytest.mark.parametrize("speed", player.SPEEDS)
def test_a_loop_rests_a_second_of_the_wall_clock_at_its_end(speed: float) -> None:
    at_end = Playback(time=4.0, duration=4.0, playing=True)

    rested = player.advance(at_end, 0.9 * player.REST, speed=speed, loop=True)
    again = player.advance(rested, 0.2 * player.REST, speed=speed, loop=True)

    assert rested.time >= 4.0
    assert again.time == 0.0


def test_a_paused_playhead_stands_still() -> None:
    paused = player.play(PLAYING, False)

    assert player.advance(paused, 1.0, speed=1.0, loop=True) is paused


def test_nothing_plays_where_there_is_no_reproduction() -> None:
    empty = Playback(playing=True)

    assert player.advance(empty, 1.0, speed=1.0, loop=True) is empty


def test_pressing_play_while_it_plays_changes_nothing() -> None:
    assert player.play(PLAYING, True) is PLAYING


def test_playing_at_the_end_begins_again() -> None:
    ended = Playback(time=4.0, duration=4.0)

    assert player.play(ended, True).time == 0.0


@given(time=st.floats(allow_nan=False))
def test_seeking_stays_within_the_reproduction(time: float) -> None:
    assert 0.0 <= player.seek(PLAYING, time).time <= PLAYING.duration


def test_another_duration_keeps_the_share_of_the_way() -> None:
    assert player.with_duration(PLAYING, 8.0).time == pytest.approx(2.0)


def test_the_same_duration_changes_nothing() -> None:
    assert player.with_duration(PLAYING, 4.0) is PLAYING


@given(time=st.floats(0.0, 20.0), duration=st.floats(0.0, 10.0), other=st.floats(0.0, 10.0))
def test_whatever_the_durations_the_playhead_stays_within(time: float, duration: float, other: float) -> None:
    playback = player.with_duration(Playback(time=time, duration=duration), other)

    assert playback.duration == other
    assert duration == other or 0.0 <= playback.time <= other
