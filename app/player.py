"""The playhead: pure functions on `Playback`, and the one answer to where a run is at a time."""

from dataclasses import replace
from typing import Final

import numpy as np

from app.store import Playback
from gc_core import Reproduction

SPEEDS: Final = (0.25, 0.5, 1.0, 2.0)
"""Playback speeds that are offered."""
REST: Final = 2.0
"""A loop rests at its end this long before it begins again [s]."""


def advance(playback: Playback, dt: float, *, speed: float, loop: bool) -> Playback:
    """Move the playhead on by ``dt`` seconds of the wall clock.

    Without a loop it stops at the end; with one it stays at the end for `REST` seconds
    and begins again.
    """
    if not playback.playing or playback.duration <= 0.0:
        return playback
    time = playback.time + speed * dt
    if not loop:
        playing = time < playback.duration
        return replace(playback, time=min(time, playback.duration), playing=playing)
    return replace(playback, time=0.0 if time >= playback.duration + speed * REST else time)


def play(playback: Playback, playing: bool) -> Playback:
    """Start or pause; starting at the end begins again."""
    if playing == playback.playing:
        return playback
    again = playing and playback.time >= playback.duration
    return replace(playback, playing=playing, time=0.0 if again else playback.time)


def seek(playback: Playback, time: float) -> Playback:
    """Move the playhead to a time within the reproduction [s]."""
    return replace(playback, time=min(max(time, 0.0), playback.duration))


def station_at(reproduction: Reproduction, time: float) -> int:
    """Station of the cylinder that a run has reached at a time of its own clock [s]."""
    index = int(np.searchsorted(reproduction.times, time, side="right")) - 1
    return round(float(reproduction.stations[max(index, 0)]))


def with_duration(playback: Playback, duration: float) -> Playback:
    """Take over the duration of another reproduction; the playhead keeps its share of it."""
    if duration == playback.duration:
        return playback
    share = min(playback.time / playback.duration, 1.0) if playback.duration > 0.0 else 0.0
    return replace(playback, duration=duration, time=share * duration)
