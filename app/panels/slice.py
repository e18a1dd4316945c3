"""The slice (cross-section) at the playhead: nobody has to imagine what the tube holds."""

from typing import Final

import viser

from app.binding import Changed, assign
from app.palette import BLUE, MAGENTA, RED
from app.panels import words
from app.panels.section_svg import section_svg, size
from app.player import station_at
from app.store import State

EMPTY: Final = "There is no tube yet. Show the motion once, and its slices appear here."
LEGEND: Final = (
    f'<span style="color:{RED}">&#9679;</span> shown&ensp;'
    f'<span style="color:{BLUE}">&#9679;</span> middle line&ensp;'
    f'<span style="color:{MAGENTA}">&#9679;</span> new run'
)


class SlicePanel:
    """Boundary, demonstrations and run in the plane of one station."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._picture = gui.add_html("")
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Draw the slice that the playhead is at, when it is another one."""
        model, run = state.model, state.playback.run
        reproduction = model.runs[run].reproduction if run < len(model.runs) else None
        station = 0 if reproduction is None else station_at(reproduction, state.playback.time)
        if self._changed(model.cylinder, station, reproduction):
            assign(self._picture, content=self._content(state, station))

    @staticmethod
    def _content(state: State, station: int) -> str:
        model, run = state.model, state.playback.run
        cylinder = model.cylinder
        if cylinder is None:
            return words.note(EMPTY)
        reproduction = model.runs[run].reproduction if run < len(model.runs) else None
        wide, narrow = size(cylinder, station)
        along = 100.0 * float(cylinder.arc_length[station] / cylinder.arc_length[-1])
        caption = f"{words.cm(wide)} × {words.cm(narrow)}, {along:.0f} % of the way"
        return (
            f'<div style="padding:0 0.5rem">{section_svg(cylinder, station, reproduction)}</div>'
            + words.note(caption, strong=True)
            + words.note(LEGEND)
        )
