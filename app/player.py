"""The playhead: pure functions on `Playback`, and the one answer to where a run is at a time."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app.document import FloatArray
from app.document import Pace as Wanted
from app.store import Plan, Playback
from gc_core import Reproduction

SPEEDS: Final = (0.25, 0.5, 1.0, 2.0)
"""Playback speeds that are offered."""
REST: Final = 2.0
"""A loop rests at its end this long before it begins again [s]."""


@dataclass(frozen=True, eq=False)
class Pace:
    """How fast a run is played: the playhead shows the run's own clock, and moves by the arm's."""

    taught: FloatArray
    """(K,) the run's clock; increasing from 0 [s]."""
    arm: FloatArray
    """(K,) the arm's clock at the same samples; not decreasing from 0 [s]."""

    def later(self, time: float, dt: float) -> float:
        """Give the run's time when the arm has played on from a time for ``dt`` [s]."""
        after = float(np.interp(time, self.taught, self.arm)) + max(time - float(self.taught[-1]), 0.0) + dt
        return float(np.interp(after, self.arm, self.taught)) + max(after - float(self.arm[-1]), 0.0)


def pace_of(plan: Plan, wanted: Wanted) -> Pace:
    """Give how fast a planned run is played."""
    arm = plan.verdict.timed.times if wanted == "fastest" else plan.clock
    return Pace(plan.reproduction.times, arm)


def advance(playback: Playback, dt: float, *, speed: float, loop: bool, pace: Pace | None = None) -> Playback:
    """Move the playhead on by ``dt`` seconds of the wall clock.

    Without a loop it stops at the end; with one it stays at the end for `REST` seconds
    and begins again. Without a pace it runs as taught.
    """
    if not playback.playing or playback.duration <= 0.0:
        return playback
    step = speed * dt
    time = playback.time + step if pace is None else pace.later(playback.time, step)
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
