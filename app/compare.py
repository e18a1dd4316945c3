"""``gc-teach compare``: the tube beside other methods, from the same starts."""

from __future__ import annotations

import json as json_text
from dataclasses import asdict, replace
from pathlib import Path
from typing import Annotated, Final, get_args

import tyro

from app.arm.protocol import Arm
from app.baselines import DEFAULT, Tube, methods
from app.commands import AlignBy, Section, Units
from app.comparison import Comparison, Row, Task, claims, kept_of, task_of
from app.comparison import compare as run_comparison
from app.document import Document, Settings, View
from app.model import learn
from app.opening import opened
from app.surroundings import conditions_of

_DEFAULT = Settings()
SECTIONS: Final = f"{{{','.join(get_args(Section))}}}"


def compare(
    file: tyro.conf.Positional[Path],
    *,
    starts: int = 5,
    methods: tuple[str, ...] = DEFAULT,
    section: Annotated[Section | None, tyro.conf.arg(metavar=SECTIONS, help_behavior_hint="")] = None,
    align_by: AlignBy = _DEFAULT.align_by,
    units: Units = "auto",
    json: bool = False,
) -> None:
    """Let the tube and other methods run a skill from the same starts, and say how each did.

    Args:
        file: Recordings (.mat .csv .npy .npz .h5 .hdf5), or the name of a built-in skill.
        starts: From how many places of the first slice.
        methods: gc, ramp, or dmp, promp or gmr with a number of weights or components: dmp-5.
        section: Kind of the tube's cross-sections; that of the skill unless given.
        align_by: What brings the demonstrations into correspondence, for all methods.
        units: The file's unit of length.
        json: Print one JSON value instead of words.
    """
    print(_answer(_task(file, section, align_by, units), methods, starts, json=json), flush=True)


def _answer(task: Task, names: tuple[str, ...], starts: int, *, json: bool) -> str:
    try:
        found = run_comparison(task, methods(names, task.tube), starts)
    finally:
        if task.arm is not None:
            task.arm.close()
    return json_text.dumps([asdict(row) for row in found.rows]) if json else "\n".join(_words(found))


def _task(file: Path, section: Section | None, align_by: AlignBy, units: Units) -> Task:
    """Open a recording, or a built-in skill with the things in its way."""
    document = opened(file, None if units == "auto" else units)
    tube = Tube(section or document.settings.section, align_by, document.settings.stations)
    return replace(task_of(document), tube=tube, arm=arm_among_things(document))


def arm_among_things(document: Document) -> Arm | None:
    """Give an arm that heeds what stands around; None where nothing does."""
    conditions = conditions_of(learn(document), View())
    if not conditions.obstacles:
        return None
    from app.arm import Jaco  # noqa: PLC0415 - it takes a third of a second to import

    return Jaco().under(conditions)


def _words(found: Comparison) -> list[str]:
    """Say in a table, then in sentences, what each method did."""
    done = [row for row in found.rows if row.failed is None]
    in_the_way = any(row.contacts is not None for row in done)
    spread = next((row.spread_start_m for row in done if row.spread_start_m is not None), None)
    begin = "" if spread is None else f", {100.0 * spread:.1f} cm apart (rms from their mean)"
    head = "method      half way   end off   Frechet       DTW        jerk       fit       run"
    units = "                [cm]      [cm]      [cm]      [cm]    [m2/s6]      [ms]      [ms]"
    if in_the_way:
        head, units = head + "  clear of  contacts", units + "      [cm]    [runs]"
    count = "1 start" if len(found.starts) == 1 else f"{len(found.starts)} starts"
    return [
        f"{count} in the first slice{begin}. Half way: how far apart the runs are there.",
        "",
        head,
        units,
        *(_line(row) for row in done),
        "",
        *_paces(done, len(found.starts)),
        *_sentences(found),
        *(row.failed for row in found.rows if row.failed is not None),
    ]


def _sentences(found: Comparison) -> list[str]:
    """Say of each method how far apart its paths stay; of those outside of Fig. 9's claims nothing more."""
    claimed = {claim.method: claim.sentence for claim in claims(found)}
    kept = {row.method: part for row in found.rows if (part := kept_of(row)) is not None}
    plain = "{}: half way {:.0f} % of the starts' spread is left (the paper claims nothing about it)."
    return [claimed.get(name) or plain.format(name, 100.0 * part) for name, part in kept.items()]


def _paces(done: list[Row], runs: int) -> list[str]:
    """Say how long learning and all runs take by the tube's time."""
    spent = {row.method: (row.fit_ms or 0.0) + runs * (row.reproduce_ms or 0.0) for row in done}
    tube = spent.pop("gc", 0.0)
    if not (tube and spent):
        return []
    others = ", ".join(f"{method} {each / tube:.1f}" for method, each in spent.items())
    return [f"Learning and {runs} runs take the tube {tube:.0f} ms, the others by that: {others}."]


def _line(row: Row) -> str:
    lengths = (row.spread_mid_m, row.end_error_m, row.frechet_m, row.dtw_m)
    cells = [f"{100.0 * (value or 0.0):10.2f}" for value in lengths]
    cells += [f"{row.jerk or 0.0:12.3g}", f"{row.fit_ms or 0.0:10.1f}", f"{row.reproduce_ms or 0.0:10.2f}"]
    if row.clearance_m is not None:
        cells += [f"{100.0 * row.clearance_m:10.1f}", f"{row.contacts:10d}"]
    return f"{row.method:10}" + "".join(cells)
