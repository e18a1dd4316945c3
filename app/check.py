"""``gc-teach check``: can the arm do what a file shows, and if not, what to change where."""

from __future__ import annotations

import json as json_text
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tyro

from app.arm.conditions import FREE, Conditions
from app.commands import Units
from app.document import View
from app.files import inspect
from app.model import learn
from app.resources import static_folder
from app.skills import load_skill
from app.surroundings import conditions_of
from gc_core import Demonstration, GcError


class CheckError(GcError):
    """The arm that should check a file cannot be used."""


@dataclass(frozen=True, eq=False)
class _Checked:
    """One motion of a file, and what the arm makes of it."""

    name: str
    motion: Demonstration
    verdict: Any


def check(file: tyro.conf.Positional[Path], *, units: Units = "auto", json: bool = False) -> None:
    """Say whether the arm can do what a file shows, how closely, how fast, how clear of itself and of things.

    Args:
        file: Recordings or a path (.mat .csv .npy .npz .h5 .hdf5), or the name of a built-in skill.
        units: The file's unit of length.
        json: Print one JSON value instead of words.
    """
    if not file.suffix and not file.exists():
        document = load_skill(static_folder() / "skills", str(file))
        motions = [shown.demonstration for shown in document.demonstrations]
        conditions = conditions_of(learn(document), View())
        title = f"{document.title}: {len(motions)} demonstrations."
    else:
        reading = inspect(file)
        unit = reading.unit if units == "auto" else units
        motions, conditions = reading.accepted(unit, "as recorded"), FREE
        title = f"{reading.name}: {reading.summary_in(unit)}"
    checked = _judged(motions, conditions)
    facts = _facts(checked)
    print(json_text.dumps(facts) if json else "\n".join(_words(title, checked, facts)), flush=True)


def _judged(motions: list[Demonstration], conditions: Conditions) -> list[_Checked]:
    # Only this command of those that work on files needs the arm, which takes a second to import.
    from app.arm import ArmError, Jaco  # noqa: PLC0415
    from app.arm.verdict import judge  # noqa: PLC0415

    try:
        arm = Jaco()
        heeding = arm.under(conditions)
        try:
            return [
                _Checked(
                    each.name or f"Demonstration {number}", each, judge(heeding, each.positions, each.times)
                )
                for number, each in enumerate(motions, 1)
            ]
        finally:
            arm.close()
    except ArmError as error:
        raise CheckError(str(error)) from error


def _facts(checked: list[_Checked]) -> dict[str, Any]:
    """Give one JSON value for a file: the worst of its motions counts."""
    verdicts = [each.verdict for each in checked]
    samples = [len(each.motion.positions) for each in checked]
    reached = sum(v.reached * n for v, n in zip(verdicts, samples, strict=True)) / sum(samples)
    return {
        "reached": float(reached),
        "max_error_mm": 1000.0 * max(float(v.path.errors.max()) for v in verdicts),
        "max_joint_step_rad": max(v.largest_step for v in verdicts),
        "max_joint_speed_ratio": max(v.speed_ratio for v in verdicts),
        "min_self_distance_mm": 1000.0 * min(v.self_distance for v in verdicts),
        "clearance_mm": _millimetres(min(v.clearance for v in verdicts)),
        "duration_s": max(v.timed.duration for v in verdicts),
        "problems": [sentence for each in checked for sentence in _sentences(each)],
    }


def _millimetres(metres: float) -> float | None:
    """Give a clearance in JSON, where there is no infinity: null when nothing stands around."""
    return 1000.0 * metres if math.isfinite(metres) else None


def _sentences(checked: _Checked) -> list[str]:
    """Say where what is wrong, and what to change."""
    times = checked.motion.times
    return [
        f"{checked.name}, {times[each.first]:.1f} to {times[each.last]:.1f} s: {each.what}. {each.remedy}"
        for each in checked.verdict.problems
    ]


def _words(title: str, checked: list[_Checked], facts: dict[str, Any]) -> list[str]:
    slowest = max(float(each.motion.times[-1]) for each in checked)
    clear = facts["clearance_mm"]
    around = "nothing stands in its way" if clear is None else f"{clear:.0f} mm clear of what is around it"
    return [
        title,
        f"The arm reaches {_percent(100.0 * facts['reached'])} of the samples within 1 mm; the largest miss "
        f"is {facts['max_error_mm']:.2f} mm, the largest joint step {facts['max_joint_step_rad']:.3f} rad.",
        f"As recorded (up to {slowest:.1f} s) its fastest joint runs at "
        f"{100.0 * facts['max_joint_speed_ratio']:.0f} % of its speed limit; timed anew, the arm needs "
        f"{facts['duration_s']:.1f} s.",
        f"It stays {facts['min_self_distance_mm']:.0f} mm clear of itself; {around}.",
        *(facts["problems"] or ["Nothing needs to be changed."]),
    ]


def _percent(share: float) -> str:
    """Write a share so that 100 % means all."""
    return "100 %" if share == 100.0 else f"{min(float(np.floor(10.0 * share)) / 10.0, 99.9):.1f} %"
