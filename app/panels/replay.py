"""Fix: replay a demonstration or a run, and correct it by pulling the moving hand."""

from typing import Final, get_args

import viser

from app.actions import Actions
from app.binding import QUIET, Binding, Changed, assign, on_press, one_of
from app.document import Feel
from app.panels import words
from app.progress import Progress
from app.store import State
from app.subject import subjects

HOW: Final = "The arm replays the motion slowly. Pull its hand where the motion should be otherwise."
REPLAY: Final = "Replay and let me correct"
STOP: Final = "Stop"
SPEEDS: Final = {"¼×": 0.25, "½×": 0.5, "¾×": 0.75, "1×": 1.0}
FEELS: Final[tuple[Feel, ...]] = get_args(Feel)
NOTHING: Final = "nothing yet"


class ReplayPanel:
    """What is replayed, how fast, how soft, and the button."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._nodes: dict[str, str] = {}
        gui.add_html(words.note(words.escape(HOW)))
        self._what = gui.add_dropdown("Motion", (NOTHING,), hint="A demonstration, or a run (reproduction).")
        self._bindings = (
            Binding(
                self._what,
                read=self._chosen,
                write=lambda label: actions.look(replay=self._nodes[label]),
                accept=lambda label: label in self._nodes,
            ),
            _speed(gui, actions),
            _feel(gui, actions),
        )
        self._start = gui.add_button(REPLAY, icon=viser.Icon.PLAYER_RECORD, color=QUIET)
        self._stop = gui.add_button(STOP, icon=viser.Icon.PLAYER_STOP, color=QUIET, visible=False)
        self._how_far = gui.add_html("")
        on_press(self._start, actions.start_replay)
        on_press(self._stop, actions.stop_replay)
        self._listed, self._told = Changed(), Changed()

    def draw(self, state: State) -> None:
        """Follow what can be replayed, and the replay."""
        shown, runs = state.document.demonstrations, state.model.runs
        if state.dragging is None and self._listed(shown, len(runs)):
            self._nodes = subjects(state.model)
            assign(self._what, options=tuple(self._nodes) or (NOTHING,))
        for binding in self._bindings:
            binding.draw(state)
        replay = state.replay
        assign(self._start, visible=replay is None, disabled=not self._nodes or state.proposal is not None)
        assign(self._stop, visible=replay is not None)
        if self._told(None if replay is None else (how_far(replay))):
            assign(self._how_far, content="" if replay is None else words.note(words.escape(how_far(replay))))

    def _chosen(self, state: State) -> str:
        labels = [label for label, node in self._nodes.items() if node == state.view.replay]
        return labels[0] if labels else next(iter(self._nodes), NOTHING)


def how_far(replay: Progress) -> str:
    """Say where the replay is."""
    if not len(replay.done):
        return f"The arm goes to where {replay.name} begins …"
    held = " You hold the hand." if replay.held else ""
    effect = f" {replay.effect[0].upper()}{replay.effect[1:]}." if replay.effect else ""
    return f"{replay.name}: {words.seconds(replay.time)} of {words.seconds(replay.duration)}.{held}{effect}"


def _speed(gui: viser.GuiApi, actions: Actions) -> Binding[str]:
    labels = {speed: label for label, speed in SPEEDS.items()}
    return Binding(
        gui.add_dropdown("Speed", tuple(SPEEDS), hint="Slower is easier to correct."),
        read=lambda state: labels.get(state.view.replay_speed, "1×"),
        write=lambda label: actions.look(replay_speed=SPEEDS[label]),
        accept=one_of(SPEEDS),
    )


def _feel(gui: viser.GuiApi, actions: Actions) -> Binding[str]:
    return Binding(
        gui.add_dropdown("The hand is", FEELS, hint="How hard the hand is to pull aside (stiffness)."),
        read=lambda state: state.view.replay_feel,
        write=lambda feel: actions.look(replay_feel=feel),
        accept=one_of(FEELS),
    )
