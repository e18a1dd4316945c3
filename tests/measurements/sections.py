"""How good are the tubes of real recordings? ``python -m tests.measurements.sections``.

Every public set is encoded with every kind of section and every alignment, and measured by plain
geometry (`geometry`) and by runs from random starts (`runs`). What must hold is in `broken`.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
import tyro

from gc_core import Demonstration, GeneralizedCylinder, encode
from gc_core.alignment import ALIGNMENTS
from gc_core.arrays import FloatArray
from gc_core.radius import GREATEST_SLOPE
from gc_core.sections import SECTIONS
from tests.helpers_data import ALL_SETS, DATA, load
from tests.measurements import geometry, runs
from tests.measurements.pages import put

STATIONS: Final = 200
TIGHT_ANGLES: Final = 128
"""From this number of angles on, `hull` must be as tight as `TIGHT`."""
TIGHT: Final = 1.05
"""Greatest median area of `hull` by that of the convex hull of its points [-]."""
CUTTING: Final = 0.02
"""Greatest part of the stations that may cut a neighbour [-]."""
SLACK: Final = 1e-6


@dataclass(frozen=True)
class Measured:
    """One set, encoded in one way."""

    name: str
    section: str
    align_by: str
    angles: int
    demonstrations: int
    trimmed: float
    """Most time cut from one demonstration [s]."""
    missed_ends: int
    """Effective points that are no crossing, in one run from an end of the tube."""
    missed_inside: int
    """All others that are no crossing."""
    finite: bool
    flat: float
    """Farthest distance of an effective point or a vertex from its plane [m]."""
    off: float
    """Farthest distance of an effective point that was not missed from the demonstration's crossings [m]."""
    ratio: float
    """Worst effective point by its polygon [-]."""
    centres_outside: int
    """Stations whose polygon does not go round its centre."""
    area: float
    """Median area by that of the hull of the effective points [-]."""
    area_most: float
    area_skipped: int
    """Stations left out of the area, where the minimum half-width rules."""
    cutting: int
    """Stations whose section truly cuts a neighbour."""
    overlapping: int
    """Stations with a vertex behind a neighbour, by the stricter test."""
    named: int
    """Stations in `diagnostics.crossing`."""
    unnamed: int
    """Cutting or overlapping stations that `diagnostics.crossing` does not name."""
    tilt: tuple[float, float, float]
    """50th and 95th percentile and maximum [deg]."""
    tilt_error: float
    """Farthest `diagnostics.tilt` from the angle between normal and tangent [deg]."""
    slope: float
    """Greatest |dR| / ds [-]."""
    jump: float
    """Longest step of an effective point between stations [mm]."""
    jump_ratio: float
    """Longest step of an effective point by the median of the steps around it [-]."""
    first: runs.Runs
    """Runs from random places in section 0."""
    anywhere: runs.Runs
    """Runs from random places anywhere."""
    milliseconds: float
    """Of the processor to encode fresh demonstrations, median of 5; 0: not measured."""


def measure(
    name: str, shown: list[Demonstration], cylinder: GeneralizedCylinder, align_by: str, count: int
) -> Measured:
    """Measure a cylinder encoded from `shown`, with `count` runs from each kind of start."""
    facts = cylinder.diagnostics
    ends, inside = geometry.missed_at_ends_and_inside(facts.missed)
    area = geometry.area_ratios(cylinder)
    cutting, overlapping = geometry.cutting_stations(cylinder), geometry.overlapping_stations(cylinder)
    tilt = geometry.tilts(cylinder)
    points = np.swapaxes(cylinder.effective_points, 0, 1)
    rng = np.random.default_rng(0)
    return Measured(
        name=name,
        section=cylinder.section,
        align_by=align_by,
        angles=len(cylinder.angles),
        demonstrations=len(shown),
        trimmed=float((facts.trimmed_start + facts.trimmed_end).max()),
        missed_ends=ends,
        missed_inside=inside,
        finite=_finite(cylinder),
        flat=geometry.heights(cylinder),
        off=geometry.off_demonstrations(cylinder, shown),
        ratio=float(geometry.ratios_to_polygons(cylinder).max()),
        centres_outside=int((~geometry.centres_inside(cylinder)).sum()),
        area=float(np.median(area)) if len(area) else 0.0,
        area_most=float(area.max(initial=0.0)),
        area_skipped=len(cylinder.directrix) - len(area),
        cutting=int(cutting.sum()),
        overlapping=int(overlapping.sum()),
        named=int(facts.crossing.sum()),
        unnamed=int(((cutting | overlapping) & ~facts.crossing).sum()),
        tilt=_degrees(np.array([*np.percentile(tilt, [50, 95]), tilt.max()])),
        tilt_error=float(np.degrees(np.abs(tilt - facts.tilt).max())),
        slope=float(geometry.slopes(cylinder).max()),
        jump=1000.0 * float(np.linalg.norm(np.diff(points, axis=1), axis=2).max()),
        jump_ratio=float(geometry.steps_by_median(points).max()),
        first=runs.follow(cylinder, runs.in_first_section(cylinder, count, rng)),
        anywhere=runs.follow(cylinder, runs.anywhere(cylinder, count, rng)),
        milliseconds=0.0,
    )


def broken(measured: Measured) -> list[str]:
    """Sentences about what must hold and does not."""
    m, stations = measured, STATIONS
    tight = m.section == "hull" and m.angles >= TIGHT_ANGLES
    checks = (
        (m.finite, "there are numbers that are not finite"),
        (m.flat <= 1e-9, f"a point is {m.flat:.1e} m off its plane"),
        (m.off <= 1e-9, f"an effective point is {m.off:.1e} m off the crossings of its demonstration"),
        (m.ratio <= geometry.HELD, f"an effective point is outside, at {m.ratio:.6f}"),
        (m.centres_outside == 0, f"{m.centres_outside} centres are outside"),
        (m.slope <= GREATEST_SLOPE + SLACK, f"|dR|/ds is {m.slope:.3f}"),
        (m.cutting <= CUTTING * stations, f"{m.cutting} stations cut a neighbour"),
        (m.overlapping <= CUTTING * stations, f"{m.overlapping} stations overlap a neighbour"),
        (m.unnamed == 0, f"{m.unnamed} stations cut a neighbour and are not named"),
        (m.tilt_error <= 1e-3, f"diagnostics.tilt is {m.tilt_error:.2f} deg off"),
        (m.first.outside == 0, f"{m.first.outside} runs from section 0 leave the tube"),
        (m.anywhere.outside == 0, f"{m.anywhere.outside} runs from anywhere leave the tube"),
        (m.first.jumping == 0, f"{m.first.jumping} runs from section 0 jump ({m.first.worst:.1f})"),
        (m.anywhere.jumping == 0, f"{m.anywhere.jumping} runs from anywhere jump ({m.anywhere.worst:.1f})"),
        (not tight or m.area <= TIGHT, f"hull has {m.area:.3f} of the convex hull's area"),
    )
    return [words for holds, words in checks if not holds]


def encode_time(load_fresh: Callable[[], list[Demonstration]], section: str, align_by: str) -> float:
    """Median of 5 processor times to encode demonstrations that were not seen before [ms]."""
    took: list[float] = []
    for _ in range(5):
        shown = load_fresh()
        begin = time.process_time()
        encode(shown, section=section, align_by=align_by)
        took.append(time.process_time() - begin)
    return 1000.0 * float(np.median(took))


def fresh(shown: Sequence[Demonstration]) -> list[Demonstration]:
    """Equal demonstrations that no cache knows."""
    return [replace(demonstration) for demonstration in shown]


def _finite(cylinder: GeneralizedCylinder) -> bool:
    arrays = (
        cylinder.surface(),
        cylinder.frames,
        cylinder.effective_points,
        cylinder.aligned,
        cylinder.times,
    )
    return all(bool(np.isfinite(array).all()) for array in arrays) and bool(np.isfinite(cylinder.volume))


def _degrees(angles: FloatArray) -> tuple[float, float, float]:
    low, high, most = np.degrees(angles).tolist()
    return low, high, most


def measure_all(
    sets: Sequence[str], kinds: Sequence[str], alignments: Sequence[str], angles: Sequence[int], count: int
) -> Iterator[Measured]:
    """Measure every combination, alignment by alignment."""
    for align_by in alignments:
        for name in sets:
            shown = load(name)
            for section in kinds:
                took = encode_time(lambda shown=shown: fresh(shown), section, align_by)
                for rays in angles:
                    cylinder = encode(
                        shown, section=section, align_by=align_by, stations=STATIONS, angles=rays
                    )
                    yield replace(measure(name, shown, cylinder, align_by, count), milliseconds=took)


SET_HEADINGS: Final = (
    "set | shown | trimmed [s] | missed: ends | inside | ratio | centres outside | cut | unnamed "
    "| worst step by median | with something broken"
)
HEADINGS: Final = (
    "set | section | angles | area: median | area: most | left out | cut | overlap | named "
    "| tilt 50 / 95 / 100 % [deg] | dR/ds | points jump [mm] | by median "
    "| section 0: out | jump | worst | anywhere: out | jump | worst | encode [ms]"
)


def line(m: Measured) -> str:
    """One row of the table."""
    values = (
        f"{m.name} | {m.section} | {m.angles} | {m.area:.3f} | {m.area_most:.2f} | {m.area_skipped} "
        f"| {m.cutting} | {m.overlapping} | {m.named} | {' / '.join(f'{angle:.1f}' for angle in m.tilt)} "
        f"| {m.slope:.2f} | {m.jump:.1f} | {m.jump_ratio:.1f} "
        f"| {m.first.outside} | {m.first.jumping} | {m.first.worst:.2f} "
        f"| {m.anywhere.outside} | {m.anywhere.jumping} | {m.anywhere.worst:.2f} | {m.milliseconds:.1f}"
    )
    return f"| {values} |"


def set_line(rows: Sequence[Measured]) -> str:
    """One row on what was shown: the worst of all sections of a set."""
    m = rows[0]
    return (
        f"| {m.name} | {m.demonstrations} | {m.trimmed:.2f} | {max(r.missed_ends for r in rows)} "
        f"| {max(r.missed_inside for r in rows)} | {max(r.ratio for r in rows):.10f} "
        f"| {max(r.centres_outside for r in rows)} | {max(r.cutting for r in rows)} "
        f"| {max(r.unnamed for r in rows)} | {max(max(r.first.worst, r.anywhere.worst) for r in rows):.2f} "
        f"| {sum(bool(broken(r)) for r in rows)} of {len(rows)} |"
    )


INTRODUCTION: Final = """# Sections of real recordings

Made by `python -m tests.measurements.sections --out docs/sections.md` from public recordings
that are not part of the project:
{sets}.
{stations} stations, {count} random starts with eta <= 1 of each kind, one BLAS thread.

- *trimmed*: most time cut from one demonstration.
- *missed*: effective points that are no crossing of the demonstration with the plane, in one run
  from an end of the tube (*ends*), and others (*inside*).
- *ratio*: worst effective point by its polygon, at most 1 inside.
- *centres outside*: stations whose polygon does not go round its centre.
- *area*: area of the polygon by that of the convex hull of its effective points; stations are
  *left out* where that hull is thinner than the stated minimum half-width, which rules there.
- *cut*: stations whose polygon truly meets that of a neighbour in space. *overlap*: stations with a
  vertex on the wrong side of a neighbour's plane, above or below the neighbour's polygon.
  *named*: in `diagnostics.crossing`. *unnamed*: cut or overlap without being named.
- *tilt*: angle between the section's normal and the tangent.
- *dR/ds*: greatest over stations and angles.
- *points jump*: longest step of an effective point between neighbouring stations, and by the median
  of the 21 steps around it.
- Runs from random places in section 0 and anywhere in the tube: how many leave the tube (*out*), how
  many have a step above {jump:g} times the median of the 21 steps around it (*jump*; at the ends, of
  those that exist), and the longest step by that median (*worst*).
- *encode*: processor time, median of 5, of demonstrations that no cache knows, 64 angles.
"""


def report(measured: Sequence[Measured], count: int) -> str:
    """The page, in Markdown."""
    sets = ", ".join(dict.fromkeys(m.name for m in measured))
    parts = [INTRODUCTION.format(sets=sets, stations=STATIONS, count=count, jump=runs.JUMP)]
    for align_by in dict.fromkeys(m.align_by for m in measured):
        rows = [m for m in measured if m.align_by == align_by]
        by_set = [[m for m in rows if m.name == name] for name in dict.fromkeys(m.name for m in rows)]
        parts.append(f'\n## `align_by="{align_by}"`\n\nThe worst of all sections of a set:\n')
        parts += [_head(SET_HEADINGS), *map(set_line, by_set), "", _head(HEADINGS), *map(line, rows)]
    parts.append("\n## What does not hold\n")
    faults = [
        f"- {m.name}, {m.section}, {m.align_by}, {m.angles} angles: {'; '.join(broken(m))}."
        for m in measured
        if broken(m)
    ]
    parts += faults or [
        "Nothing: every row keeps what is required, which allows 4 of 200 stations to cut a neighbour when "
        "they are named\n(only *pouring* has such), and missed points that are reported."
    ]
    return "\n".join(parts) + "\n"


def _head(headings: str) -> str:
    columns = headings.count("|") + 1
    return f"| {headings} |\n|{'---|' * columns}"


def main(
    *,
    sets: tuple[str, ...] = ALL_SETS,
    kinds: tuple[str, ...] = tuple(SECTIONS),
    align: tuple[str, ...] = ALIGNMENTS,
    angles: tuple[int, ...] = (64, 128),
    starts: int = 1000,
    out: Path | None = None,
    numbers: Path | None = None,
) -> None:
    """Measure the sections of real recordings and write the page.

    Parameters
    ----------
    sets
        Which recordings.
    kinds
        Kinds of sections.
    align
        Alignments.
    angles
        Numbers of vertices.
    starts
        Random starts of each kind.
    out
        Markdown file; the screen when not given.
    numbers
        JSON file with everything that was measured, for comparing later.
    """
    if not DATA.is_dir():
        sys.exit("The public recordings are not there; set GC_TEACH_DATA to their folder.")
    measured: list[Measured] = []
    for one in measure_all(sets, kinds, align, angles, starts):
        measured.append(one)
        print(line(one), *broken(one), sep="\n    ", file=sys.stderr, flush=True)
    page = report(measured, starts)
    put(page, out)
    if numbers is not None:
        numbers.write_text(json.dumps([asdict(one) for one in measured], indent=1), encoding="utf-8")


if __name__ == "__main__":
    tyro.cli(main)
