"""Move, under the hood: how stiff space is between the landmarks, and the map in an expert's words."""

from functools import partial
from typing import Final

import viser

from app import edits
from app.actions import Actions
from app.binding import Binding, Changed, assign
from app.model import Model
from app.panels import words
from app.store import State

UNMOVED: Final = "Nothing is moved, so there is no map (thin-plate spline) yet."


class SmoothingPanel:
    """Lambda of the thin-plate spline, and by how much it makes it miss the landmarks."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        with gui.add_folder("Under the hood", expand_by_default=False):
            self._smoothing: Binding[float] = Binding(
                gui.add_slider(
                    "Smoothing",
                    0.0,
                    1.0,
                    0.01,
                    0.0,
                    hint="lambda: 0 meets every landmark exactly; more bends the tube less and misses them.",
                ),
                read=lambda state: state.document.smoothing,
                write=lambda value: actions.edit(
                    partial(edits.set_smoothing, smoothing=value), "change the smoothing", "smoothing"
                ),
                accept=lambda value: 0.0 <= value <= 1.0,
                typed=True,
            )
            self._facts = gui.add_html("")
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Show lambda and its effect."""
        self._smoothing.draw(state)
        if self._changed(state.model.registration):
            assign(self._facts, content=words.note(words.escape(facts(state.model))))


def facts(model: Model) -> str:
    """Name the case of the map, by how much it misses the landmarks, and where it folds."""
    registration, cylinder = model.registration, model.cylinder
    if registration is None or cylinder is None:
        return UNMOVED
    folded = int(cylinder.diagnostics.folded.sum())
    return (
        f"Case: {registration.case}. Landmarks are missed by at most {1e3 * registration.residual:.1f} mm at "
        f"lambda = {model.source.smoothing:g}. Bending energy {100.0 * registration.bending_energy:.2f} cm. "
        + (f"{folded} of {len(cylinder.directrix)} slices are turned inside out." if folded else "No folds.")
    )
