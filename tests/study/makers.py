"""A study small enough for a test: three made-up demonstrations, four methods, few runs."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

from app.files import write
from app.study.executors import in_this_process
from app.study.running import Outcome, run_study
from app.study.spec import Spec, read_spec
from tests.baselines.makers import demonstrations

SMALL = """
title = "A small study"
seed = 7
data_sets = ["bent.csv"]
methods = ["gc", "ramp", "gmr-5"]
sections = ["ellipse", "hull"]
starts = 3
moves = 2
leave_one_out = true
"""
PARTS = 12
"""Four methods and sections, three experiments."""


def small(folder: Path, changes: str = "", without: str = "") -> Spec:
    """Put demonstrations and a spec into a folder; lines of `changes` in place of those they begin like."""
    write(folder / "bent.csv", demonstrations(3))
    kept = [line for line in SMALL.splitlines() if not _replaced(line, changes) and line != without]
    (folder / "small.toml").write_text("\n".join([*kept, changes]), encoding="utf-8")
    return read_spec(folder / "small.toml")


def alone(spec: Spec, out: Path) -> Outcome:
    """Run a study in this process."""
    return run_study(spec, out, nullcontext(in_this_process))


def _replaced(line: str, changes: str) -> bool:
    key = line.partition(" =")[0]
    return bool(key) and any(each.startswith(f"{key} =") for each in changes.splitlines())
