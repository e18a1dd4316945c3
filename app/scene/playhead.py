"""Between the clock of the playback and the stations of the cylinder."""

import numpy as np

from app import player
from app.model import Model
from app.store import Playback


def station_at(model: Model, playback: Playback) -> int | None:
    """Find the station that the playhead stands at; None without a cylinder."""
    if model.cylinder is None:
        return None
    last = len(model.cylinder.directrix) - 1
    if playback.run >= len(model.runs):
        return min(int(np.searchsorted(model.cylinder.times, playback.time)), last)
    return min(player.station_at(model.runs[playback.run].reproduction, playback.time), last)


def time_of(model: Model, run: int, station: int) -> float | None:
    """Find when the played reproduction is at a station [s]; None without a cylinder."""
    if model.cylinder is None:
        return None
    if run >= len(model.runs):
        return float(model.cylinder.times[station])
    played = model.runs[run].reproduction
    return float(played.times[int(np.argmin(np.abs(played.stations - station)))])
