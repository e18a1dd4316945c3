"""The skill in each kind of slice, side by side: three pictures, and a click on one chooses it."""

from collections.abc import Mapping
from functools import partial
from typing import Final

import viser

from app import edits
from app.actions import Actions
from app.binding import QUIET, STRONG, Changed, assign, element_id, on_press
from app.document import SectionKind
from app.panels import words
from app.shapes import Picture, Shapes
from app.store import State

KINDS: Final[Mapping[SectionKind, tuple[str, str]]] = {
    "circle": ("Circle", "The smallest circle round what was shown."),
    "ellipse": ("Ellipse", "A small ellipse round what was shown."),
    "closed_spline": (
        "Free shape",
        "A smooth curve through the outermost of what was shown: a closed spline.",
    ),
}
"""Of each kind the word on its button, and what it is."""
CHOSEN: Final = "light-dark(#1F3FA8,#6E8BFF)"
OTHER: Final = "light-dark(#c9ced6,#4a505a)"


class KindsPanel:
    """A picture above a button for each kind; the picture is the button's label, so both can be pressed."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        gui.add_html(words.note("Shape of the slices (cross-sections)", strong=True))
        self._pictures = gui.add_html("")
        self._buttons: Mapping[SectionKind, viser.GuiButtonHandle] = {
            kind: gui.add_button(label, hint=hint) for kind, (label, hint) in KINDS.items()
        }
        self._note = gui.add_html("")
        for kind, button in self._buttons.items():
            on_press(button, partial(_choose, actions, kind))
        self._ids: Mapping[SectionKind, str] = {k: element_id(button) for k, button in self._buttons.items()}
        self._style = _side_by_side(tuple(self._ids.values()))
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Mark the chosen kind, and show the skill in all of them; while something is pulled all stays."""
        chosen = state.document.settings.section
        for kind, button in self._buttons.items():
            assign(button, color=STRONG if kind == chosen else QUIET)
        taught = state.model.cylinder is not None
        if state.dragging is None and self._changed(state.shapes, chosen, taught):
            shapes = state.shapes if taught else None
            assign(self._pictures, content=self._style + self._row(shapes, chosen))
            assign(self._note, content=note_on(shapes))

    def _row(self, shapes: Shapes | None, chosen: SectionKind) -> str:
        if shapes is None:
            return ""
        cards = "".join(
            f'<label for="{self._ids[kind]}" style="flex:1 1 0;min-width:0;padding:0 2px;cursor:pointer">'
            f"{card(shapes.pictures.get(kind), shapes.least, kind == chosen)}</label>"
            for kind in self._ids
        )
        return f'<div style="display:flex;margin:0 10px">{cards}</div>'


def card(picture: Picture | None, least: float, chosen: bool) -> str:
    """One picture with its numbers, as HTML; None where this kind cannot be made."""
    inside = words.note("cannot be made of this")
    if picture is not None:
        times = picture.volume / max(least, 1e-12)
        inside = (
            f'{picture.tube}<div style="padding:0 8%">{picture.widest}</div>'
            f'<div style="text-align:center;font-size:0.75rem;line-height:1.35;padding-bottom:2px">'
            f"<b>{words.volume(picture.volume)}</b><br>{times:.1f} &times; tightest</div>"
        )
    return (
        f'<div style="border:2px solid {CHOSEN if chosen else OTHER};border-radius:6px;margin-bottom:4px;'
        f'height:calc(100% - 4px);box-sizing:border-box">{inside}</div>'
    )


def note_on(shapes: Shapes | None) -> str:
    """Say what the pictures and their numbers are, as HTML."""
    if shapes is None:
        return ""
    return words.note(
        "Your skill in each kind, with its widest slice, and the room that the tube leaves (volume), "
        f"compared with the tightest tube round what was shown (convex hull, {words.volume(shapes.least)}). "
        "Free shape: closed spline."
    )


def _choose(actions: Actions, kind: SectionKind) -> None:
    actions.edit(partial(edits.set_section, section=kind), "choose the shape of the slices")


def _side_by_side(ids: tuple[str, ...]) -> str:
    """Lay the buttons with these ids out in one row: viser itself knows only one below the other."""
    boxes = ",".join(f'div:has(>[id="{one}"])' for one in ids)
    buttons = ",".join(f'[id="{one}"]' for one in ids)
    return (
        f"<style>{boxes}{{display:inline-block;width:calc((100% - 20px)/{len(ids)});margin:0!important;"
        f'padding:0 2px 0.5em}}div:has(>[id="{ids[0]}"]){{margin-left:10px!important}}'
        f"{buttons}{{padding:0 4px;font-size:0.75rem}}</style>"
    )
