"""The list of demonstrations: learn from it or not, rename, trim, duplicate, delete."""

from collections.abc import Callable
from functools import partial

import numpy as np
import viser

from app import advising, edits
from app.actions import Actions
from app.advising import FAULT_WORDS, Noted
from app.binding import (
    QUIET,
    Binding,
    Changed,
    Rows,
    anything,
    assign,
    name_field,
    on_choice,
    on_press,
    place_of,
)
from app.document import Document, Shown
from app.history import DELETE as DELETE_STEP
from app.panels import words
from app.store import State
from gc_core import Demonstration

TRIM, COPY, DELETE = "Trim", "Duplicate", "Delete"
STEP = 0.01
"""Of the times to trim at [s]."""


class DemonstrationsPanel:
    """One folder a demonstration; folders are reused."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._rows = Rows(gui.add_folder(None), partial(DemonstrationRow, gui, actions))

    def draw(self, state: State) -> None:
        """Follow the list of what is kept; what is being drawn or pulled joins it at the release."""
        if state.dragging is not None:
            return
        for row in self._rows.fit(len(state.document.demonstrations)):
            row.draw(state)


class DemonstrationRow:
    """One demonstration."""

    def __init__(self, gui: viser.GuiApi, actions: Actions, index: int) -> None:
        self._actions, self._index = actions, index
        self._shown: Shown | None = None
        self._noted: Noted | None = None
        self._redo: Demonstration | None = None
        self._changed = Changed()
        self._duration: float = 0.0
        self._keep = (0.0, 0.0)
        self._folder = gui.add_folder(f"Demonstration {index + 1}", expand_by_default=False)
        with self._folder:
            self._use = self._add_use(gui)
            self._name = self._add_name(gui)
            self._part = gui.add_multi_slider(
                "Keep [s]", 0.0, 1.0, STEP, (0.0, 1.0), hint="The part to keep; then press Trim."
            )
            self._kept: Binding[tuple[float, ...]] = Binding(
                self._part, read=lambda _: self._keep, write=self._choose, accept=self._within, typed=True
            )
            self._wrong = gui.add_html("", visible=False)
            self._fix = gui.add_button("", color=QUIET, visible=False)
            on_press(self._fix, self._mend)
            group = gui.add_button_group("", (TRIM, COPY, DELETE))
            on_choice(group, lambda place: (self._trim, self._copy, self._delete)[place]())

    def show(self, visible: bool) -> None:
        """Show or hide it."""
        assign(self._folder, visible=visible)

    def draw(self, state: State) -> None:
        """Show the demonstration at this place of the list."""
        shown = state.document.demonstrations[self._index]
        self._noted = advising.note_of(advising.advice(state.model, state.postures), shown.demonstration)
        self._redo = state.view.redo
        if self._changed(shown, self._noted, self._redo):
            self._show_facts(shown)
            self._show_note()
        self._use.draw(state)
        self._name.draw(state)
        self._kept.draw(state)

    def _show_facts(self, shown: Shown) -> None:
        former, self._shown = self._shown, shown
        demonstration = shown.demonstration
        duration: float = max(round(float(demonstration.times[-1]), 2), STEP)
        if former is None or duration != self._duration:
            self._duration, self._keep = duration, (0.0, duration)
            assign(self._part, max=duration)
        muted = " · muted" if shown.muted else ""
        wrong = "" if self._noted is None else f" · {FAULT_WORDS[self._noted.note.fault]}"
        assign(
            self._folder, label=f"{words.short(demonstration.name)} · {words.seconds(duration)}{muted}{wrong}"
        )

    def _show_note(self) -> None:
        assign(self._wrong, visible=self._noted is not None)
        assign(self._fix, visible=self._noted is not None)
        if self._noted is not None:
            sentence, label = advising.said(self._noted, self._redo)
            assign(self._wrong, content=words.note(words.escape(sentence)))
            assign(self._fix, label=label)

    def _mend(self) -> None:
        if self._noted is not None:
            advising.press(self._actions, self._noted, self._redo)

    def _add_use(self, gui: viser.GuiApi) -> Binding[bool]:
        widget = gui.add_checkbox(
            "Learn from it", True, hint="Without the tick it is muted: kept and drawn, but not learned from."
        )

        def write(used: bool) -> None:
            self._edit(
                partial(edits.mute_demonstration, muted=not used),
                f"unmute {self._title}" if used else f"mute {self._title}",
            )

        return Binding(
            widget,
            read=lambda state: not state.document.demonstrations[self._index].muted,
            write=write,
            accept=anything,
        )

    def _add_name(self, gui: viser.GuiApi) -> Binding[str]:
        def write(name: str) -> None:
            rename = partial(edits.rename_demonstration, name=name)
            self._edit(rename, "rename a demonstration", f"rename demonstration {self._index}")

        return name_field(
            gui, "Name", lambda state: state.document.demonstrations[self._index].demonstration.name, write
        )

    @property
    def _title(self) -> str:
        return "" if self._shown is None else self._shown.demonstration.name

    def _within(self, keep: tuple[float, ...]) -> bool:
        return len(keep) == 2 and 0.0 <= keep[0] <= keep[1] <= self._duration + 1e-9

    def _choose(self, keep: tuple[float, ...]) -> None:
        self._keep = (keep[0], keep[1])

    def _trim(self) -> None:
        start, stop = self._keep
        # The slider's end is rounded: the last sample must not fall off when only the beginning is cut.
        stop = float("inf") if stop >= self._duration else stop
        self._edit(partial(edits.trim_demonstration, start=start, stop=stop), f"trim {self._title}")

    def _edit(self, change: Callable[[Document, int], Document], name: str, key: str | None = None) -> None:
        if (shown := self._shown) is not None:
            self._actions.edit(partial(_wherever, shown, self._index, change), name, key)

    def _copy(self) -> None:
        self._actions.edit(
            partial(_at, self._shown, edits.duplicate_demonstration), f"duplicate {self._title}"
        )

    def _delete(self) -> None:
        self._actions.edit(
            partial(_at, self._shown, edits.delete_demonstration), f"{DELETE_STEP}{self._title}"
        )


def _wherever(
    shown: Shown, index: int, change: Callable[[Document, int], Document], document: Document
) -> Document:
    """Change the demonstration that was shown, wherever it is by now and whatever it is called."""
    place = place_of(shown, index, document.demonstrations, _same)
    return document if place is None else change(document, place)


def _same(one: Shown, other: Shown) -> bool:
    first, second = one.demonstration, other.demonstration
    return np.array_equal(first.times, second.times) and np.array_equal(first.positions, second.positions)


def _at(shown: Shown | None, change: Callable[[Document, int], Document], document: Document) -> Document:
    """Change the very demonstration that was shown, wherever it is by now, and none like it."""
    for index, candidate in enumerate(document.demonstrations):
        if candidate is shown:
            return change(document, index)
    return document
