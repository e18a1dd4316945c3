"""A recording from a file: choose it, see what is in it, say what it means, add it."""

from typing import Any, Final, cast, get_args

import viser

from app.actions import Actions
from app.binding import QUIET, Binding, Changed, assign, on_choice, one_of
from app.files import FRAMES, Frame, Unit
from app.panels import words
from app.store import State

ADD: Final = "Add"
CANCEL: Final = "Cancel"
SUFFIXES: Final = ".mat,.csv,.npy,.npz,.h5,.hdf5,.gcteach"
UNITS: Final[tuple[Unit, ...]] = get_args(Unit)


class OfferPanel:
    """The upload button and, after an upload, what was found."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._unit: Unit = "m"
        self._frame: Frame = FRAMES[0]
        self._changed = Changed()
        self._upload = gui.add_upload_button(
            "Add a recording…", icon=viser.Icon.UPLOAD, color=QUIET, mime_type=SUFFIXES
        )
        self._upload.on_upload(self._uploaded)
        self._box = gui.add_folder("Recording", visible=False)
        with self._box:
            self._summary = gui.add_html("")
            self._bindings = (self._add_unit(gui), self._add_frame(gui))
            group = gui.add_button_group("", (ADD, CANCEL))
            on_choice(group, lambda place: (self._accept, actions.decline_file)[place]())

    def draw(self, state: State) -> None:
        """Show the offered file, if there is one."""
        offer = state.offer
        if self._changed(offer):
            assign(self._box, visible=offer is not None)
            if offer is not None:
                self._unit, self._frame = offer.unit, offer.frame
                found = f"{offer.name}: {offer.summary} {offer.unit_reason} {offer.frame_reason}"
                assign(self._summary, content=words.note(words.escape(found)))
        for binding in self._bindings:
            binding.draw(state)

    async def _uploaded(self, event: viser.GuiEvent[Any]) -> None:
        value = event.target.value
        if event.client is not None and isinstance(value, viser.UploadedFile):
            self._actions.offer_file(value.name, value.content)

    def _add_unit(self, gui: viser.GuiApi) -> Binding[str]:
        widget = gui.add_dropdown("Unit", UNITS, initial_value="m", hint="What the numbers of the file mean.")
        return Binding(widget, read=lambda _: self._unit, write=self._set_unit, accept=one_of(UNITS))

    def _add_frame(self, gui: viser.GuiApi) -> Binding[str]:
        widget = gui.add_dropdown(
            "Place", FRAMES, initial_value=FRAMES[0], hint="Where the motion goes. Nothing is turned."
        )
        return Binding(widget, read=lambda _: self._frame, write=self._set_frame, accept=one_of(FRAMES))

    def _set_unit(self, unit: str) -> None:
        self._unit = cast(Unit, unit)

    def _set_frame(self, frame: str) -> None:
        self._frame = cast(Frame, frame)

    def _accept(self) -> None:
        self._actions.accept_file(self._unit, self._frame)
