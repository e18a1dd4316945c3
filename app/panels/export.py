"""Taking a skill along: choose a kind of file, see what will be in it, take it."""

import base64
from typing import Final

import viser

from app.actions import Actions
from app.binding import QUIET, STRONG, Binding, Changed, assign, on_press, one_of
from app.exports import FORMATS
from app.files import SUFFIX
from app.panels import words
from app.parcel import Parcel
from app.store import State

LABELS: Final = {f"{form.label} ({suffix})": suffix for suffix, form in FORMATS.items()}
PICTURES: Final = {".png": "image/png", ".svg": "image/svg+xml"}
LARGEST_PICTURE: Final = 2 * 2**20
"""Shown in the dialog [bytes]."""
# A dialog puts the cursor on the first thing that takes it, and a dropdown that has it hides the preview.
INTRODUCTION: Final = f'<div tabindex="0" style="outline:none">{words.note("Choose a kind of file.")}</div>'
MAKING: Final = "It is being made …"


class ExportPanel:
    """A button and, once it is pressed, a dialog."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._gui, self._actions = gui, actions
        self._dialog: _Dialog | None = None
        button = gui.add_button(
            "Export…",
            icon=viser.Icon.DOWNLOAD,
            color=QUIET,
            hint="Take the skill along: to keep or send, to play without gc-teach, for a paper, for an arm.",
        )
        on_press(button, lambda: actions.prepare_export(SUFFIX))

    def draw(self, state: State) -> None:
        """Open the dialog when a file was asked for, and close it when it was put away."""
        if state.parcel is None:
            if self._dialog is not None:
                self._dialog.close()
                self._dialog = None
            return
        if self._dialog is None:
            self._dialog = _Dialog(self._gui, self._actions)
        self._dialog.draw(state)


class _Dialog:
    """One is made each time it is opened: viser's modals cannot be hidden."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._modal = gui.add_modal("Export this skill")
        self._changed = Changed()
        with self._modal:
            gui.add_html(INTRODUCTION)
            self._kind: Binding[str] = Binding(
                gui.add_dropdown("As", tuple(LABELS)),
                read=lambda state: _label(state.parcel),
                write=lambda label: actions.prepare_export(LABELS[label]),
                accept=one_of(LABELS),
            )
            self._preview = gui.add_html("")
            self._take = gui.add_button("Download", icon=viser.Icon.DOWNLOAD, color=STRONG, disabled=True)
            on_press(self._take, actions.take_export)
            on_press(gui.add_button("Close", color=QUIET), actions.close_export)

    def draw(self, state: State) -> None:
        """Show what will be in the file."""
        self._kind.draw(state)
        if state.parcel is not None and self._changed(state.parcel):
            assign(self._preview, content=preview(state.parcel))
            assign(self._take, disabled=not state.parcel.ready)

    def close(self) -> None:
        """Take it from the screen."""
        if not self._modal.closed:
            self._modal.close()


def preview(parcel: Parcel) -> str:
    """Say what a file is called, how large it is and what is in it, as HTML; or why there is none."""
    if parcel.problem:
        return words.note(words.escape(parcel.problem), color=words.AMBER)
    if not parcel.ready:
        return words.note(MAKING)
    called = words.note(f"{words.escape(parcel.name)}, {size(len(parcel.content))}", strong=True)
    lines = "\n".join(words.escape_line(line) for line in parcel.excerpt.splitlines())
    text = f'<pre style="{_LINES}">{lines}</pre>' if lines else ""
    return called + words.note(words.escape(parcel.about)) + text + _picture(parcel)


def _picture(parcel: Parcel) -> str:
    kind = PICTURES.get(parcel.suffix)
    if kind is None or len(parcel.content) > LARGEST_PICTURE:
        return ""
    data = base64.b64encode(parcel.content).decode()
    return f'<img alt="" style="width:100%;background:#fff" src="data:{kind};base64,{data}">'


def size(n_bytes: int) -> str:
    """A file's size: kB, and MB from 1 MB on."""
    return f"{n_bytes / 1e6:.1f} MB" if n_bytes >= 1e6 else f"{max(n_bytes / 1e3, 0.1):.1f} kB"


def _label(parcel: Parcel | None) -> str:
    wanted = SUFFIX if parcel is None else parcel.suffix
    return next(label for label, suffix in LABELS.items() if suffix == wanted)


_LINES: Final = (
    "margin:0 0.75rem 0.5rem;padding:0.5rem;font-size:0.7rem;line-height:1.35;overflow-x:auto;"
    "background:light-dark(#f1f3f5,#25262b);border-radius:4px"
)
