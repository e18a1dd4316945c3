"""The commands that work on a file: ``gc-teach encode`` and ``gc-teach reproduce``.

Each prints what it found, in words or as one JSON value; what is wrong with the
input is raised as a `GcError`, and the command line says it.
"""

from __future__ import annotations

import json as json_text
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
import tyro

from app.document import FloatArray, Settings
from app.files import Reading, Unit, UnknownFormatError, format_glb, format_tube, inspect, put, write
from gc_core import Demonstration, GeneralizedCylinder, Reproduction
from gc_core import encode as learn_cylinder
from gc_core import reproduce as run_from

Section: TypeAlias = Literal["circle", "ellipse", "closed_spline", "hull"]
AlignBy: TypeAlias = Literal["time", "arc_length", "dtw"]
Law: TypeAlias = Literal["fixed", "convergent"]
Units: TypeAlias = Literal["auto"] | Unit
Place: TypeAlias = Annotated[Path | None, tyro.conf.arg(metavar="PATH", help_behavior_hint="")]
"""A file or folder that need not be given; the help would call it {None}|PATH."""

_DEFAULT = Settings()


@dataclass(frozen=True, eq=False)
class Learned:
    """A file, and the cylinder of its demonstrations."""

    reading: Reading
    unit: Unit
    """In which the file was read."""
    cylinder: GeneralizedCylinder


def encode(
    file: tyro.conf.Positional[Path],
    *,
    section: Section = _DEFAULT.section,
    stations: int = _DEFAULT.stations,
    align_by: AlignBy = _DEFAULT.align_by,
    units: Units = "auto",
    out: Place = None,
    json: bool = False,
) -> None:
    """Learn the tube of a file's demonstrations and say what it is like.

    Args:
        file: Recordings (.mat .csv .npy .npz .h5 .hdf5 .gcteach).
        section: Kind of the cross-sections.
        stations: Number of cross-sections along the middle line.
        align_by: What brings the demonstrations into correspondence.
        units: The file's unit of length.
        out: Where to write the tube: .npz (all numbers) or .glb (its surface).
        json: Print one JSON value instead of words.
    """
    if out is not None:
        _check_suffix(out, (".npz", ".glb"))
    learned = _learn(file, section, stations, align_by, units)
    if out is not None:
        _save(out, learned.cylinder)
    facts = _tube_facts(learned) | {"out": None if out is None else str(out)}
    _say(json_text.dumps(facts) if json else _tube_words(learned, out))


def reproduce(
    file: tyro.conf.Positional[Path],
    *,
    start: tuple[float, float, float],
    law: Law = "fixed",
    section: Section = _DEFAULT.section,
    stations: int = _DEFAULT.stations,
    align_by: AlignBy = _DEFAULT.align_by,
    units: Units = "auto",
    out: Place = None,
    json: bool = False,
) -> None:
    """Perform the skill of a file from a new start and say how it went.

    Args:
        file: Recordings (.mat .csv .npy .npz .h5 .hdf5 .gcteach).
        start: Where the run begins, x y z in metres.
        law: Keep the ratio eta, or let it shrink so that the run ends on the middle line.
        section: Kind of the cross-sections.
        stations: Number of cross-sections along the middle line.
        align_by: What brings the demonstrations into correspondence.
        units: The file's unit of length.
        out: Where to write the run: .csv or .npz.
        json: Print one JSON value instead of words.
    """
    if out is not None:
        _check_suffix(out, (".csv", ".npz"))
    learned = _learn(file, section, stations, align_by, units)
    run = run_from(learned.cylinder, start, law=law)
    if out is not None:
        write(out, [Demonstration(run.times, run.positions, run.orientations, run.gripper, "Reproduction")])
    facts = _run_facts(learned.cylinder, run) | {"out": None if out is None else str(out)}
    _say(json_text.dumps(facts) if json else _run_words(learned, run, out))


def _learn(file: Path, section: Section, stations: int, align_by: AlignBy, units: Units) -> Learned:
    reading = inspect(file)
    unit = reading.unit if units == "auto" else units
    demonstrations = reading.accepted(unit, "as recorded")
    cylinder = learn_cylinder(demonstrations, section=section, stations=stations, align_by=align_by)
    return Learned(reading, unit, cylinder)


def _widths(cylinder: GeneralizedCylinder) -> FloatArray:
    """How wide the tube is at each station: twice the mean distance of the boundary, (N,) [m]."""
    return 2.0 * cylinder.radii.mean(axis=1)


def _tube_facts(learned: Learned) -> dict[str, Any]:
    cylinder, reading = learned.cylinder, learned.reading
    widths = _widths(cylinder)
    return {
        "file": reading.name,
        "demonstrations": len(reading.demonstrations),
        "samples": list(reading.samples),
        "durations_s": list(reading.durations),
        "unit": learned.unit,
        "section": cylinder.section,
        "align_by": cylinder.diagnostics.align_by,
        "stations": len(cylinder.directrix),
        "length_m": float(cylinder.arc_length[-1]),
        "volume_m3": float(cylinder.volume),
        "width_start_m": float(widths[0]),
        "width_middle_m": float(widths[len(widths) // 2]),
        "width_end_m": float(widths[-1]),
        "crossing_stations": int(np.count_nonzero(cylinder.diagnostics.crossing)),
        "notes": list(cylinder.diagnostics.sentences()),
    }


def _tube_words(learned: Learned, out: Path | None) -> str:
    facts, reading = _tube_facts(learned), learned.reading
    start, middle, end = (100.0 * facts[f"width_{part}_m"] for part in ("start", "middle", "end"))
    lines = [
        f"{reading.name}: {reading.summary_in(learned.unit)}",
        reading.unit_reason if learned.unit == reading.unit else "The unit is the one that you asked for.",
        f"The tube is {100.0 * facts['length_m']:.1f} cm long and {start:.1f} cm wide at the start, "
        f"{middle:.1f} cm in the middle, {end:.1f} cm at the end "
        f"({facts['section']}, {facts['stations']} stations, aligned by {facts['align_by']}).",
        *learned.cylinder.diagnostics.sentences(),
        *([] if out is None else [f"Written to {out}."]),
    ]
    return "\n".join(lines)


def _run_facts(cylinder: GeneralizedCylinder, run: Reproduction) -> dict[str, Any]:
    return {
        "law": run.law,
        "start_inside": bool(run.start_inside),
        "eta_start": float(run.ratios[0]),
        "eta_end": float(run.ratios[-1]),
        "first_station": float(run.stations[0]),
        "duration_s": float(run.times[-1]),
        "end": run.positions[-1].tolist(),
        "end_off_centre_m": float(np.linalg.norm(run.positions[-1] - cylinder.directrix[-1])),
        "times": run.times.tolist(),
        "positions": run.positions.tolist(),
    }


def _run_words(learned: Learned, run: Reproduction, out: Path | None) -> str:
    facts = _run_facts(learned.cylinder, run)
    where = "inside the tube" if facts["start_inside"] else "outside of the tube, where nothing was shown"
    x, y, z = facts["end"]
    lines = [
        f"The start is {where}: its ratio eta is {facts['eta_start']:.2f}.",
        f"The run takes {facts['duration_s']:.1f} s and ends at {x:.3f} {y:.3f} {z:.3f} m, "
        f"{100.0 * facts['end_off_centre_m']:.1f} cm from the end of the middle line.",
        *([] if out is None else [f"Written to {out}."]),
    ]
    return "\n".join(lines)


def _check_suffix(path: Path, known: Sequence[str]) -> None:
    if path.suffix.lower() not in known:
        raise UnknownFormatError(path.name, path.suffix.lower(), known)


def _save(path: Path, cylinder: GeneralizedCylinder) -> None:
    put(path, format_tube(cylinder) if path.suffix.lower() == ".npz" else format_glb(cylinder))


def _say(text: str) -> None:
    print(text, flush=True)
