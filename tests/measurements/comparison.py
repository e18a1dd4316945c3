"""Fig. 9's claims on every built-in skill and every public set.

``python -m tests.measurements.comparison --out docs/comparison.md``
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import tyro

from app.baselines import methods
from app.compare import arm_among_things
from app.comparison import Comparison, Task, claims, compare, task_of
from app.resources import static_folder
from app.skills import load_skill, skill_names
from tests.helpers_data import ALL_SETS, DATA, load
from tests.measurements.pages import put

STARTS = 20
INTRODUCTION = f"""# The tube beside other methods

Made by `python -m tests.measurements.comparison --out docs/comparison.md`: what `gc-teach compare` finds from
{STARTS} starts in the first slice. One BLAS thread on two shared cores, so times are good for ratios within
a set only; public recordings are not part of the project. All methods learn the same trimmed
demonstrations, aligned by arc length.

- *kept*: how far apart the runs are where they cross the middle slice, by the starts' distance (root mean
  square). Fig. 9 claims that the tube keeps paths apart in proportion to its width, and that DMP and GMR
  merge them.
- *end off*: from the end of the directrix. *Frechet*, *DTW* (a sample): from the nearest demonstration. Means
  of all runs.
- *touch*: runs with which the arm touches what stands in the way; where the motion goes through a ring, the
  point that the hand leads. *time*: learning and five runs, by the tube's.

| set | method | kept [%] | end off [cm] | Frechet [cm] | DTW [cm] | jerk [m²/s⁶] | touch | time |
|---|---|---|---|---|---|---|---|---|"""


def tasks() -> Iterator[tuple[str, Task]]:
    skills = static_folder() / "skills"
    for name in skill_names(skills):
        document = load_skill(skills, name)
        yield name, replace(task_of(document), arm=arm_among_things(document))
    if DATA.is_dir():
        for name in ALL_SETS:
            yield name, Task(tuple(load(name)))


def lines(name: str, found: Comparison) -> Iterator[str]:
    spent = {row.method: (row.fit_ms or 0.0) + 5.0 * (row.reproduce_ms or 0.0) for row in found.rows}
    for row in found.rows:
        if row.failed is not None:
            yield f"| {name} | {row.method} | {row.failed} | | | | | | |"
            continue
        kept = 100.0 * (row.spread_mid_m or 0.0) / (row.spread_start_m or 1.0)
        lengths = (row.end_error_m, row.frechet_m, row.dtw_m)
        cells = [f"{kept:.0f}", *(f"{100.0 * (each or 0.0):.2f}" for each in lengths), f"{row.jerk:.2g}"]
        cells += ["" if row.contacts is None else str(row.contacts), f"{spent[row.method] / spent['gc']:.1f}"]
        yield f"| {name} | {row.method} | {' | '.join(cells)} |"


def main(*, out: Path | None = None) -> None:
    """Measure, and write the page.

    Parameters
    ----------
    out
        Markdown file; the screen when not given.
    """
    table, held, broken = [INTRODUCTION], 0, []
    for name, task in tasks():
        found = compare(task, methods(tube=task.tube), STARTS)
        if task.arm is not None:
            task.arm.close()
        table += lines(name, found)
        told = claims(found)
        held += sum(claim.holds for claim in told)
        broken += [f"- *{name}*: {claim.sentence}" for claim in told if not claim.holds]
    table += ["", f"Of Fig. 9's claims {held} of {held + len(broken)} hold.", *broken]
    page = "\n".join(table) + "\n"
    put(page, out)


if __name__ == "__main__":
    tyro.cli(main)
