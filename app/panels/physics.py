"""Try: the run in a physical world, with motors that have limits and things that can be touched."""

from typing import Final

import viser

from app.actions import Actions
from app.binding import QUIET, Changed, assign, on_press
from app.panels import words
from app.store import State
from app.trial import Trial

TRY: Final = "Try it with physics"
SHOW: Final = "Show what happened"
HIDE: Final = "Stop showing it"
HOW: Final = (
    "With physics the motors have limits, and what has a weight can be pushed and carried. The hand takes "
    "a thing within 2 cm of its finger tips when it closes, and holds it as if bolted on until it opens."
)
STALE: Final = "The skill has changed since. Try it again."


class PhysicsPanel:
    """A button, how far it is, and what happened."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._state: State | None = None
        with gui.add_folder("With physics", expand_by_default=True):
            self._try = gui.add_button(TRY, icon=viser.Icon.WEIGHT, color=QUIET, hint=HOW)
            self._bar = gui.add_progress_bar(0.0, visible=False)
            self._said = gui.add_html("")
            self._show = gui.add_button(SHOW, icon=viser.Icon.PLAYER_PLAY, color=QUIET, visible=False)
        on_press(self._try, actions.try_physics)
        on_press(self._show, self._press)
        self._changed = Changed()

    def draw(self, state: State) -> None:
        """Follow the trial."""
        self._state, trial = state, state.trial
        assign(self._try, disabled=not state.model.runs)
        if self._changed(trial):
            runs = trial is not None and trial.share < 1.0
            assign(self._bar, visible=runs, value=0.0 if trial is None else 100.0 * trial.share)
            assign(self._said, content=words.note(said(trial)))
            playable = trial is not None and trial.played is not None and not trial.stale
            shown = trial is not None and trial.time is not None
            assign(self._show, visible=playable, label=HIDE if shown else SHOW)

    def _press(self) -> None:
        trial = None if self._state is None else self._state.trial
        self._actions.play_trial(trial is not None and trial.time is None)


def said(trial: Trial | None) -> str:
    """Build the report as HTML: a sentence a line."""
    if trial is None:
        return words.escape(HOW)
    if trial.share < 1.0:
        return f"Run {trial.run + 1} is tried with physics …"
    sentences = (f"Run {trial.run + 1}:", *trial.said, *((STALE,) if trial.stale else ()))
    return "<br>".join(words.escape(sentence) for sentence in sentences)
