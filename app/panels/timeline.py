"""The timeline: play, scrub, speed, loop, and which run is played."""

from functools import partial
from typing import Final

import viser

from app import judgement
from app.actions import VIEW_NAMES, Actions
from app.arm.verdict import Problem
from app.binding import Binding, Rows, assign, on_choice, on_press
from app.panels import words
from app.player import SPEEDS
from app.store import Plan, State

SPEED_WORDS: Final = ("¼×", "½×", "1×", "2×")
PLAY, PAUSE = "Play", "Pause"
PLAYING, PAUSED = "Playing", "Paused"
LOOP: Final = "Loop"
STEP: Final = 0.01
"""Of the playhead [s]."""
AMBER: Final = (180, 83, 9)
"""White text keeps 4.5:1 on it."""
MOST_PROBLEMS: Final = 3
"""More are told in Try."""


class TimelinePanel:
    """One playhead for the arm, the scene and the slice."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._actions = actions
        self._state: State | None = None
        self._duration = 1.0
        self._slider = gui.add_slider("Time [s]", 0.0, 1.0, STEP, 0.0)
        self._time: Binding[float] = Binding(
            self._slider,
            read=lambda state: min(round(state.playback.time, 2), self._duration),
            write=actions.seek,
            accept=lambda time: 0.0 <= time <= self._duration,
            typed=True,
        )
        self._buttons = gui.add_button_group(
            PAUSED, (PLAY, *SPEED_WORDS, LOOP), hint="The space bar plays and pauses, too."
        )
        on_choice(self._buttons, self._press)
        self._runs = gui.add_button_group(
            "Run", ("1",), visible=False, hint="Which run (reproduction) the arm plays."
        )
        on_choice(self._runs, actions.choose_run)
        self._problems = Rows(gui.add_folder(None), partial(ProblemRow, gui, actions))
        views = gui.add_button_group("Look from", VIEW_NAMES)
        on_choice(views, lambda place: actions.see_from(VIEW_NAMES[place]))

    def draw(self, state: State) -> None:
        """Follow the playhead."""
        self._state = state
        playback, view = state.playback, state.view
        duration = round(playback.duration, 2) or 1.0
        if duration != self._duration:
            self._duration = duration
            assign(self._slider, max=duration)
        self._time.draw(state)
        assign(self._slider, disabled=playback.duration == 0.0)
        assign(
            self._buttons,
            label=PLAYING if playback.playing else PAUSED,
            options=_options(playback.playing, view.speed, view.loop),
        )
        runs = len(state.model.runs)
        assign(self._runs, visible=runs > 1)
        if runs > 1:
            assign(self._runs, options=words.marked(tuple(str(i + 1) for i in range(runs)), playback.run))

        self._draw_problems(state)

    def _draw_problems(self, state: State) -> None:
        plan = state.plan
        found = () if plan is None else judgement.problems(plan)[:MOST_PROBLEMS]
        for row, problem in zip(self._problems.fit(len(found)), found, strict=True):
            if plan is not None:
                row.draw(plan, problem)

    def toggle(self) -> None:
        """Play or pause, whatever is not the case."""
        if self._state is not None:
            self._actions.play(not self._state.playback.playing)

    def _press(self, place: int) -> None:
        if place == 0:
            self.toggle()
        elif place <= len(SPEEDS):
            self._actions.look(speed=SPEEDS[place - 1])
        elif self._state is not None:
            self._actions.look(loop=not self._state.view.loop)


class ProblemRow:
    """What the arm cannot do and when; a press moves the playhead there."""

    def __init__(self, gui: viser.GuiApi, actions: Actions, index: int) -> None:
        del index
        self._time = 0.0
        self._button = gui.add_button("", color=AMBER, hint="Go to where it is worst.")
        on_press(self._button, lambda: self._go(actions))

    def show(self, visible: bool) -> None:
        """Show or hide it."""
        assign(self._button, visible=visible)

    def draw(self, plan: Plan, problem: Problem) -> None:
        """Say it."""
        self._time = judgement.worst_at(plan, problem)
        assign(self._button, label=f"{judgement.when(plan, problem)}: {problem.what}")

    def _go(self, actions: Actions) -> None:
        actions.play(False)
        actions.seek(self._time)


def _options(playing: bool, speed: float, loop: bool) -> tuple[str, ...]:
    chosen = SPEEDS.index(speed) if speed in SPEEDS else -1
    return (
        PAUSE if playing else PLAY,
        *words.marked(SPEED_WORDS, chosen),
        *words.marked((LOOP,), 0 if loop else -1),
    )
