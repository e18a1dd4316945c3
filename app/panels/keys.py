"""Keyboard: undo, redo, play and pause, the hand and the arm, how far a pull on a line reaches."""

from functools import partial

import viser

from app.actions import Actions
from app.binding import assign, on_command
from app.linepull import NARROWEST, WIDER, WIDEST
from app.store import State


class Keys:
    """The commands, also listed in the palette that Ctrl/Cmd+K opens."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._state: State | None = None
        self._undo = gui.add_command("Undo", hotkey="Z", modifier="cmd/ctrl", icon=viser.Icon.ARROW_BACK_UP)
        self._redo = gui.add_command(
            "Redo", hotkey="Z", modifier="cmd/ctrl+shift", icon=viser.Icon.ARROW_FORWARD_UP
        )
        again = gui.add_command(
            "Redo (as Windows has it)", hotkey="Y", modifier="cmd/ctrl", icon=viser.Icon.ARROW_FORWARD_UP
        )
        on_command(again, actions.redo)
        play = gui.add_command("Play or pause", hotkey="space", icon=viser.Icon.PLAYER_PLAY)
        gripper = gui.add_command("Open or close the hand", hotkey="G", icon=viser.Icon.HAND_GRAB)
        record = gui.add_command("Record by buttons, or stop", hotkey="R", icon=viser.Icon.PLAYER_RECORD)
        reposition = gui.add_command("Reposition a stuck arm", hotkey="P", icon=viser.Icon.ROTATE)
        on_command(record, actions.record)
        on_command(reposition, actions.reposition)
        on_command(self._undo, actions.undo)
        on_command(self._redo, actions.redo)
        on_command(play, self._toggle_play)
        on_command(gripper, actions.toggle_gripper)
        wider = gui.add_command("Pull wider", hotkey="pageup", icon=viser.Icon.ARROWS_HORIZONTAL)
        narrower = gui.add_command("Pull narrower", hotkey="pagedown", icon=viser.Icon.ARROWS_HORIZONTAL)
        on_command(wider, partial(self._widen, WIDER))
        on_command(narrower, partial(self._widen, 1.0 / WIDER))

    def draw(self, state: State) -> None:
        """Name what undo and redo would do."""
        self._state = state
        assign(self._undo, description=state.undo_name)
        assign(self._redo, description=state.redo_name)

    def _widen(self, factor: float) -> None:
        if self._state is not None:
            width = self._state.view.pull_width * factor
            self._actions.look(pull_width=min(max(width, NARROWEST), WIDEST))

    def _toggle_play(self) -> None:
        if self._state is not None:
            self._actions.play(not self._state.playback.playing)
