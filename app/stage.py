"""Where the arm plays: its posture, the playhead, and the joint path that leads it."""

from dataclasses import replace
from typing import Final

from app import player
from app.arm.conditions import Conditions
from app.arm.protocol import Arm, FloatArray
from app.document import View
from app.driver import Driver, Lead, hand_at, lead_at
from app.model import Model
from app.store import Hand, Plan, Playback, Task
from app.trial import Trial

GLIDE: Final = 0.7
"""In a loop the arm goes back to the start in what is left of the rest after this part of it."""


class Stage:
    """The arm of one session and the time it plays in."""

    def __init__(self, arm: Arm) -> None:
        self.arm = arm
        """Heeds what stands around and how the tool is held."""
        self.playing_conditions = Conditions(arm.conditions.obstacles)
        """What it heeds when it plays or goes back: the tool is then turned as it was shown."""
        self.driver = Driver(arm)
        self.playback = Playback(playing=True)
        self._plans: tuple[Plan, ...] = ()
        self._planned_for: tuple[Model | None, Conditions] = None, self.playing_conditions
        self._began: FloatArray | None = None
        self._trial: Trial | None = None

    @property
    def hand(self) -> Hand:
        """Where the arm is now."""
        return self.driver.hand

    @property
    def shown(self) -> Playback:
        """The playhead, which waits at the end while the arm rests or glides back."""
        return replace(self.playback, time=min(self.playback.time, self.playback.duration))

    def heed(self, conditions: Conditions) -> None:
        """From now on keep off these things and hold the tool like this."""
        if conditions != self.arm.conditions:
            self.arm = self.arm.under(conditions)
            if conditions.obstacles != self.playing_conditions.obstacles:
                self.playing_conditions = Conditions(conditions.obstacles)
            self.driver.use(self.arm.under(self.playing_conditions))

    def fit(self, model: Model) -> None:
        """Fit the playback to the runs of a model."""
        runs = model.runs
        run = min(self.playback.run, max(len(runs) - 1, 0))
        duration = float(runs[run].reproduction.times[-1]) if runs else 0.0
        self.playback = player.with_duration(replace(self.playback, run=run), duration)

    def open(self, *, playing: bool) -> None:
        """Begin with another skill: what physics made of the former one is forgotten."""
        self.playback, self._trial = Playback(playing=playing), None

    def plan(self, model: Model) -> Plan | None:
        """Give what the arm makes of the run that is played, where it is known."""
        return next((plan for plan in self.plans(model) if plan.run == self.playback.run), None)

    def plans(self, model: Model) -> tuple[Plan, ...]:
        """Give what the arm makes of the runs, as far as it is known and still true."""
        if model is not self._planned_for[0] or self.playing_conditions is not self._planned_for[1]:
            self._planned_for = model, self.playing_conditions
            self._plans = tuple(plan for plan in self._plans if self._holds(plan, model))
        return self._plans

    def unplanned(self, model: Model) -> tuple[int, ...]:
        """Number the runs that wait for a plan: first the one that is played."""
        known = {plan.run for plan in self.plans(model)}
        missing = [run for run in range(len(model.runs)) if run not in known]
        return tuple(sorted(missing, key=lambda run: run != self.playback.run))

    def accept(self, plan: Plan, model: Model) -> bool:
        """Take over a plan from the worker; returns whether it is still true."""
        if not self._holds(plan, model):
            return False
        others = [other for other in self.plans(model) if other.run != plan.run]
        self._plans = tuple(sorted([*others, plan], key=lambda each: each.run))
        if plan.run == self.playback.run:
            self._began = plan.path.joints[0]
        return True

    def _holds(self, plan: Plan, model: Model) -> bool:
        """Whether a plan is about the same run under the same conditions, whatever else was changed."""
        if plan.run >= len(model.runs) or plan.conditions != self.playing_conditions:
            return False
        return (
            plan.reproduction is model.runs[plan.run].reproduction and plan.source.cylinder is model.cylinder
        )

    def trial(self, model: Model) -> Trial | None:
        """Give what physics made of a run, and whether the run or what is around has changed since."""
        trial = self._trial
        if trial is not None and not trial.stale and not trial.holds(model):
            trial = self._trial = replace(trial, stale=True, time=None)
        return trial

    def task(self, model: Model) -> Task | None:
        """Say what a worker must know to play the present run in a physical world; None without a run."""
        run = self.playback.run
        if run >= len(model.runs):
            return None
        return Task(model, run, self.playing_conditions, self.begins_near(), self.plan(model))

    def accept_trial(self, trial: Trial) -> None:
        """Take over what physics made of a run, or how far it is."""
        self._trial = trial

    def play_trial(self, playing: bool) -> None:
        """Show what happened there from its beginning, or no longer."""
        trial = self._trial
        if trial is None or trial.played is None or (not playing and trial.time is None):
            return
        self.pause()
        self.driver.pulled(self.hand)
        self._trial = replace(trial, time=0.0 if playing and not trial.stale else None)

    def _show_trial(self, trial: Trial, dt: float) -> bool:
        """Move the arm as it moved there; at the end it stays."""
        assert trial.played is not None
        played, time = trial.played, (trial.time or 0.0) + dt
        moving = time < played.times[-1]
        trial = self._trial = replace(trial, time=min(time, float(played.times[-1])))
        at = trial.index()
        self.driver.pulled(hand_at(self.arm, played.joints[at], self.hand.gripper))
        return moving

    def begins_near(self) -> FloatArray:
        """(J,) joints near which the next joint path should begin [rad]."""
        return self.hand.joints if self._began is None else self._began

    def play(self, playing: bool) -> None:
        """Start or pause."""
        self.playback = player.play(self.playback, playing)
        self.driver.lead()

    def pause(self) -> None:
        """Stop the playhead; the arm stays where it is."""
        self.playback = player.play(self.playback, False)

    def rewind(self) -> None:
        """Put the playhead back to the beginning; the arm stays where it is."""
        self.playback = player.seek(self.playback, 0.0)

    def seek(self, time: float) -> None:
        """Move the playhead; the arm goes there."""
        self.playback = player.seek(self.playback, time)
        self.driver.lead()

    def cue(self, run: int, model: Model, *, playing: bool | None = None) -> None:
        """Go to the beginning of a run."""
        now = self.playback.playing if playing is None else playing
        self.playback = replace(self.playback, run=run, time=0.0, playing=now)
        self.fit(model)
        self.driver.lead()

    def tick(self, now: float, dt: float, model: Model, view: View) -> bool:
        """Move on what moves by itself; returns whether something still moves."""
        if self._trial is not None and self._trial.time is not None:
            return self._show_trial(self._trial, view.speed * dt)
        plan = self.plan(model)
        pace = None if plan is None else player.pace_of(plan, view.pace)
        self.playback = player.advance(self.playback, dt, speed=view.speed, loop=view.loop, pace=pace)
        moving = self.driver.tick(now, dt, self._lead(model))
        return moving or self.playback.playing

    def _lead(self, model: Model) -> Lead | None:
        """Find where the playhead wants the arm; in the rest of a loop it glides back to the start."""
        if not model.runs:
            return None
        playback, plan = self.playback, self.plan(model)
        time = 0.0 if playback.time > playback.duration + GLIDE * player.REST else playback.time
        return lead_at(time, model.runs[playback.run].reproduction, None if plan is None else plan.path)
