"""The commands that work on a file: ``gc-teach encode`` and ``gc-teach reproduce``.

Each prints what it found, in words or as one JSON value; what is wrong with the
input is raised as a `GcError`, and the command line says it.
"""

from __future__ import annotations

import json as json_text
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Literal, TypeAlias, cast

import numpy as np
import tyro
from numpy.typing import NDArray

from app.document import FloatArray, Settings
from app.files import FileError, Reading, Unit, UnknownFormatError, inspect, write
from gc_core import Demonstration, GeneralizedCylinder, Reproduction
from gc_core import encode as learn_cylinder
from gc_core import reproduce as run_from

Section: TypeAlias = Literal["circle", "ellipse", "closed_spline", "hull"]
AlignBy: TypeAlias = Literal["time", "arc_length", "dtw"]
Law: TypeAlias = Literal["fixed", "convergent"]
Indices: TypeAlias = NDArray[np.int64]
Units: TypeAlias = Literal["auto"] | Unit

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
    out: Path | None = None,
    json: bool = False,
) -> None:
    """Learn the tube of a file's demonstrations and say what it is like.

    Args:
        file: Recordings (.mat .csv .npy .npz .h5 .hdf5).
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
    out: Path | None = None,
    json: bool = False,
) -> None:
    """Perform the skill of a file from a new start and say how it went.

    Args:
        file: Recordings (.mat .csv .npy .npz .h5 .hdf5).
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


def tube_mesh(cylinder: GeneralizedCylinder) -> tuple[FloatArray, Indices]:
    """Make a closed surface of a tube.

    Returns
    -------
    vertices : (N * M + 2, 3) array
        The sections' corners, then the centres of the two ends [m].
    faces : (2 * N * M, 3) array
        Corners of triangles, counter-clockwise from outside.
    """
    surface = cylinder.surface()
    n, m = surface.shape[:2]
    corner = np.arange(n * m, dtype=np.int64).reshape(n, m)
    beside = np.asarray(np.roll(corner, -1, axis=1), dtype=np.int64)
    a, b, c, d = corner[:-1], beside[:-1], corner[1:], beside[1:]
    start, end = np.full(m, n * m), np.full(m, n * m + 1)
    faces = [
        _triangles(a, b, c),
        _triangles(b, d, c),
        _triangles(start, beside[0], corner[0]),
        _triangles(end, corner[-1], beside[-1]),
    ]
    return np.concatenate([surface.reshape(-1, 3), cylinder.directrix[[0, -1]]]), np.concatenate(faces)


def _triangles(a: Indices, b: Indices, c: Indices) -> Indices:
    return np.stack([a.ravel(), b.ravel(), c.ravel()], axis=1)


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
    try:
        if path.suffix.lower() == ".npz":
            values: dict[str, Any] = {field.name: getattr(cylinder, field.name) for field in fields(cylinder)}
            arrays: dict[str, Any] = {
                name: value for name, value in values.items() if isinstance(value, np.ndarray)
            }
            with path.open("wb") as file:
                np.savez_compressed(
                    file,
                    allow_pickle=False,
                    surface=cylinder.surface(),
                    arc_length=cylinder.arc_length,
                    crossing=cylinder.diagnostics.crossing,
                    section=np.array(cylinder.section),
                    **arrays,
                )
        else:
            import trimesh  # noqa: PLC0415 - half a second that only this needs

            vertices, faces = tube_mesh(cylinder)
            tube = cast("Any", trimesh).Trimesh(vertices, faces, process=False)
            path.write_bytes(tube.export(file_type="glb"))
    except OSError as error:
        raise FileError(
            path.name, f"{path} cannot be written: {error.strerror}. Choose another folder."
        ) from error


def _say(text: str) -> None:
    print(text, flush=True)
