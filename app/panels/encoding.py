"""What lies under the hood: how demonstrations become a tube, and how large and clean it is."""

from collections.abc import Mapping
from functools import partial
from typing import Final

import viser

from app import edits
from app.actions import Actions
from app.binding import Binding, Changed, anything, assign, one_of
from app.document import Alignment
from app.model import Model
from app.panels import words
from app.store import State

ALIGNMENT_WORDS: Final[Mapping[str, Alignment]] = {
    "way (arc length)": "arc_length",
    "place (time warping)": "dtw",
    "time": "time",
}


class EncodingPanel:
    """Alignment, stations and facts in a folder."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        with gui.add_folder("Under the hood", expand_by_default=False):
            self._bindings = (
                _add_alignment(gui, actions),
                _add_stations(gui, actions),
                *_add_views(gui, actions),
            )
            self._facts = gui.add_html("")
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Show the settings and state the facts."""
        for binding in self._bindings:
            binding.draw(state)
        if state.dragging is None and self._changed(state.model):
            assign(self._facts, content=words.note(words.escape(facts(state.model))))


def facts(model: Model) -> str:
    """Say how large and how clean the tube (generalized cylinder) is."""
    cylinder = model.cylinder
    if cylinder is None:
        return "There is no tube (generalized cylinder) yet."
    stations, per_station = cylinder.radii.shape
    return (
        f"Middle line (directrix) of {words.cm(float(cylinder.arc_length[-1]))} with {stations} slices of "
        f"{per_station} points; mean time {words.seconds(float(cylinder.times[-1]))}; volume "
        f"{words.volume(cylinder.volume)}. "
    ) + " ".join(cylinder.diagnostics.sentences())


def _add_alignment(gui: viser.GuiApi, actions: Actions) -> Binding[str]:
    shown = {alignment: text for text, alignment in ALIGNMENT_WORDS.items()}
    return Binding(
        gui.add_dropdown(
            "Match by",
            tuple(ALIGNMENT_WORDS),
            hint="How the demonstrations are brought together (alignment).",
        ),
        read=lambda state: shown[state.document.settings.align_by],
        write=lambda text: actions.edit(
            partial(edits.set_align_by, align_by=ALIGNMENT_WORDS[text]), "change the alignment"
        ),
        accept=one_of(ALIGNMENT_WORDS),
    )


def _add_stations(gui: viser.GuiApi, actions: Actions) -> Binding[int]:
    return Binding(
        gui.add_slider("Slices", 20, 400, 10, 200, hint="How many slices (stations) the tube is made of."),
        read=lambda state: state.document.settings.stations,
        write=lambda n: actions.edit(
            partial(edits.set_stations, stations=n), "change the number of slices", "stations"
        ),
        accept=lambda n: 20 <= n <= 400,
        typed=True,
    )


def _add_views(gui: viser.GuiApi, actions: Actions) -> tuple[Binding[bool], ...]:
    shown = {"show_tube": "Show tube", "show_demonstrations": "Show demos", "show_reproductions": "Show runs"}

    def bind(field: str, label: str) -> Binding[bool]:
        return Binding(
            gui.add_checkbox(label, True),
            read=lambda state: bool(getattr(state.view, field)),
            write=lambda value: actions.look(**{field: value}),
            accept=anything,
        )

    return tuple(bind(field, label) for field, label in shown.items())
