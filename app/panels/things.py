"""Move: what is in the way of the arm, and what it can push and carry."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np
import viser

from app import edits, measures, placing
from app.actions import Actions
from app.binding import Binding, Changed, Rows, assign, name_field, on_choice, place_of
from app.document import THING_KINDS, Document, Shape, ThingKind, View
from app.edits.things import HEAVIEST, LARGEST, SMALLEST
from app.panels import words
from app.panels.position_field import PositionField
from app.store import State

KINDS: Final[Mapping[ThingKind, str]] = {"box": "Box", "ball": "Ball", "cylinder": "Cylinder", "ring": "Ring"}
NOTHING: Final = "The arm keeps off what you put here. The tube does not: it is what you showed."
WHERE: Final = "Now click on the table where it stands. Then pull it, or its small balls to size it."
FULL: Final = "There are twelve things, which is enough. Remove one before you add another."
ANSWERS: Final = ("Beside the playhead", "Not here")
MOST: Final = 3
"""Measures of a thing."""
NO_PLACE: Final = np.zeros(3)


class ThingsPanel:
    """Add a thing; one folder for each."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._state: State | None = None
        gui.add_html(words.note("In the way", strong=True))
        self._choice = gui.add_button_group("", tuple(KINDS.values()))
        self._what = gui.add_html("")
        self._where = gui.add_button_group("  ", ANSWERS, visible=False)
        on_choice(self._choice, self._choose)
        on_choice(self._where, self._answer)
        self._rows = Rows(gui.add_folder(None), partial(ThingRow, gui, actions))
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Offer what can be added, ask where, and list what is there."""
        self._state = state
        count, waiting = len(state.document.things), waits(state.view)
        for row in self._rows.fit(count):
            row.draw(state)
        if self._changed(count, waiting):
            full = count >= edits.MOST_THINGS
            said = FULL if full else NOTHING if waiting is None else WHERE
            assign(self._choice, visible=not full)
            assign(self._where, visible=waiting is not None)
            assign(self._what, content=words.note(words.escape(said)))

    def _choose(self, option: int) -> None:
        self._actions.look(placing=THING_KINDS[option])

    def _answer(self, option: int) -> None:
        state = self._state
        kind = None if state is None else waits(state.view)
        if state is None or kind is None or option > 0:
            self._actions.look(placing=None)
            return
        name = edits.new_thing_name(state.document, kind)
        place = placing.foot_beside(state.model, state.playback)
        self._actions.edit(partial(edits.add_thing, kind=kind, place=place), f"add {name}")
        self._actions.look(placing=None, thing=name)


class ThingRow:
    """One thing: its name, place, measures, turn and weight; remove it."""

    def __init__(self, gui: viser.GuiApi, actions: Actions, index: int) -> None:
        self._actions, self._index = actions, index
        self._thing: Shape | None = None
        self._place = self._turn = NO_PLACE
        self._folder = gui.add_folder(f"Thing {index + 1}", expand_by_default=False)
        with self._folder:
            self._name = self._add_name(gui)
            self._position = PositionField(
                gui,
                f"Thing {index + 1} [cm]",
                read=lambda _: self._place,
                write=lambda place: self._edit(edits.move_thing, "move", position=place),
                hint="x, y, z of its middle.",
            )
            self._sizes = [self._add_size(gui, number) for number in range(MOST)]
            self._turned = PositionField(
                gui,
                "Turned [°]",
                read=lambda _: self._turn,
                write=lambda turn: self._edit(edits.turn_thing, "turn", turn=turn),
                turn=True,
                hint="About x, then y, then z (roll, pitch, yaw).",
            )
            self._mass = self._add_mass(gui)
            self._group = gui.add_button_group(" ", ("Size it by hand", "Remove"))
            on_choice(self._group, self._press)

    def show(self, visible: bool) -> None:
        """Show or hide it."""
        assign(self._folder, visible=visible)

    def draw(self, state: State) -> None:
        """Show the thing at this place of the list."""
        thing = state.document.things[self._index]
        if thing is not self._thing:
            self._thing = thing
            self._place, self._turn = np.array(thing.position), measures.turn_of(thing.wxyz)
            self._say(thing)
        self._name.draw(state)
        self._position.draw(state)
        for _, binding in self._sizes[: len(measures.measures(thing))]:
            binding.draw(state)
        self._turned.draw(state)
        self._mass.draw(state)

    def _say(self, thing: Shape) -> None:
        title = thing.name[:1].upper() + thing.name[1:]
        weight = "stands fixed" if thing.mass == 0.0 else f"can be carried, {1000.0 * thing.mass:.0f} g"
        assign(self._folder, label=f"{title} · {weight}")
        assign(self._position.handle, label=f"{title} [cm]")
        assign(self._turned.handle, label=f"{title} turned [°]", visible=measures.kind_of(thing) != "ball")
        assign(self._group, options=("Size it by hand", f"Remove {thing.name}"))
        names = measures.NAMES[measures.kind_of(thing)]
        for number, (field, _) in enumerate(self._sizes):
            shown = number < len(names)
            assign(field, visible=shown, label=f"{names[number]} [cm]" if shown else "")

    def _add_name(self, gui: viser.GuiApi) -> Binding[str]:
        def write(name: str) -> None:
            if (thing := self._thing) is not None:
                change = partial(_renamed, thing, self._index, name)
                self._actions.edit(change, "rename a thing", f"rename thing {self._index}")

        return name_field(gui, "Called", lambda state: state.document.things[self._index].name, write)

    def _add_size(self, gui: viser.GuiApi, number: int) -> tuple[viser.GuiInputHandle[float], Binding[float]]:
        def write(value: float) -> None:
            if self._thing is not None:
                former = measures.measures(self._thing)
                lengths = (*former[:number], 0.01 * value, *former[number + 1 :])
                self._edit(edits.resize_thing, "size", lengths=lengths)

        field = gui.add_number(f"Size {number + 1}", 1.0, min=0.0, max=100.0 * LARGEST, step=0.5)
        return field, Binding(
            field,
            read=lambda state: round(
                100.0 * measures.measures(state.document.things[self._index])[number], 1
            ),
            write=write,
            accept=partial(_between, 100.0 * SMALLEST, 100.0 * LARGEST),
            typed=True,
        )

    def _add_mass(self, gui: viser.GuiApi) -> Binding[float]:
        most = 1000.0 * HEAVIEST
        return Binding(
            gui.add_number(
                "Weight [g]",
                0.0,
                min=0.0,
                max=most,
                step=10.0,
                hint="0: it stands fixed. Else it can be carried.",
            ),
            read=lambda state: round(1000.0 * state.document.things[self._index].mass, 1),
            write=lambda grams: self._edit(edits.weigh_thing, "weigh", mass=0.001 * grams),
            accept=partial(_between, 0.0, most),
            typed=True,
        )

    def _edit(self, change: Callable[..., Document], verb: str, **how: Any) -> None:
        """Post an edit that a series of typed digits makes only once."""
        if self._thing is not None:
            name = self._thing.name
            self._actions.edit(partial(change, name=name, **how), f"{verb} {name}", f"{verb} thing {name}")
            self._actions.look(thing=name)

    def _press(self, option: int) -> None:
        if self._thing is None:
            return
        name = self._thing.name
        if option == 0:
            self._actions.look(thing=name)
        else:
            self._actions.edit(partial(edits.remove_thing, name=name), f"remove {name}")


def waits(view: View) -> ThingKind | None:
    """Say what kind of thing waits for its place."""
    return next((kind for kind in THING_KINDS if kind == view.placing), None)


def _renamed(thing: Shape, index: int, name: str, document: Document) -> Document:
    """Rename the thing that was shown, wherever it is in the list by now."""
    at = place_of(thing, index, document.things, _same)
    return document if at is None else edits.rename_thing(document, at, name)


def _same(one: Shape, other: Shape) -> bool:
    return replace(one, name=other.name) == other


def _between(low: float, high: float, value: float) -> bool:
    return low <= value <= high
