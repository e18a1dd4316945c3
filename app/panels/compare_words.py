"""A comparison of methods in a teacher's words: sentences that follow from the numbers, and a table."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from app.compared import LOOKS, TUBE, Compared, Look
from app.comparison import Claim, Comparison, Row, claims, width_half_way
from app.panels import words

CLEARLY: Final = 0.8
"""The best number stands out where it is this part of the second best, or less [-]."""
WAITS: Final = "…"
NONE: Final = "–"
HINTS: Final[Mapping[str, str]] = {
    "dmp-5": "Dynamic movement primitive: a spring to the goal and a learned push, of 5 weights an axis.",
    "dmp-10": "Dynamic movement primitive with 10 weights an axis.",
    "gmr-5": "Gaussian mixture regression over time (GMM/GMR), of 5 Gaussians.",
    "gmr-10": "Gaussian mixture regression over time (GMM/GMR), of 10 Gaussians.",
    "promp-10": "Probabilistic movement primitive: a Gaussian over motions, bent to its start.",
    "ramp": "The mean of what was shown, bent to its start: the least a method must beat.",
}
ROW: Final = 1.6
"""How high a line is [em]; what is wrong with a method fills its column and makes no line higher."""
PAPER: Final = "background:#f4f5f7;color:#22262c;color-scheme:light"
"""Behind the colours of methods, which are made for a light ground, in the dark theme too."""


@dataclass(frozen=True)
class Line:
    """One line of the table."""

    label: str
    hint: str
    """What it says, and the expert term."""
    value: Callable[[Row], float | None]
    """In the unit of the label."""
    form: str
    """How it is written."""
    least_is_best: bool = False


def _cm(length: float | None) -> float | None:
    return None if length is None else 100.0 * length


def _kept(row: Row) -> float | None:
    if row.spread_mid_m is None or not row.spread_start_m:
        return None
    return 100.0 * row.spread_mid_m / row.spread_start_m


LINES: Final = (
    Line("Kept apart [%]", "Of the starts' distance, what is left half way (spread).", _kept, ".0f"),
    Line("End off [cm]", "From the end of the middle line.", lambda r: _cm(r.end_error_m), ".1f", True),
    Line("Farthest [cm]", "From what was shown (Frechet).", lambda r: _cm(r.frechet_m), ".1f", True),
    Line("On average [cm]", "Likewise, a sample (DTW).", lambda r: _cm(r.dtw_m), ".1f", True),
    Line("Jerk [m²/s⁶]", "How abruptly the speed changes; 0 is smooth.", lambda r: r.jerk, ".2g"),
    Line("Learn [ms]", "Time to learn.", lambda r: r.fit_ms, ".0f", True),
    Line("One run [ms]", "Time to make one run.", lambda r: r.reproduce_ms, ".2g", True),
)
AMONG_THINGS: Final = (
    Line("Clear by [cm]", "Of what stands around; the whole arm.", lambda r: _cm(r.clearance_m), ".1f"),
    Line("Touch [runs]", "Runs that touch something.", lambda r: r.contacts, ".0f"),
)
"""Only where something stands around."""


def claims_in_words(found: Comparison) -> list[str]:
    """Say from the numbers what became of starts that lie apart, and where Fig. 9 does not hold."""
    told = claims(found)
    count = words.count(len(found.starts), "path")
    said = [_of_tube(claim, found, count) for claim in told if claim.method == TUBE]
    others = [claim for claim in told if claim.method != TUBE]
    for holds in (True, False):
        if named := [claim for claim in others if claim.holds == holds]:
            labels = [LOOKS[claim.method].label for claim in named]
            verb = _verb(len(named), holds=holds)
            said.append(f"{_list(labels)} {verb}: {_parts(named)} is left.")
    return said


def _verb(count: int, *, holds: bool) -> str:
    if holds:
        return "brings them together" if count == 1 else "bring them together"
    return f"{'does' if count == 1 else 'do'} not bring them together here"


def _of_tube(claim: Claim, found: Comparison, count: str) -> str:
    wide = f"the tube is {100.0 * width_half_way(found.cylinder):.0f} % as wide there"
    left = f"half way {100.0 * claim.kept:.0f} % of the starts' distance is left, and {wide}"
    if claim.holds:
        return f"The tube keeps the {count} apart as far as it is wide: {left}."
    return f"The tube does not keep the {count} apart as far as it is wide: {left}."


def _parts(named: Sequence[Claim]) -> str:
    kept = [100.0 * claim.kept for claim in named]
    low, high = f"{min(kept):.0f}", f"{max(kept):.0f}"
    return f"{low} %" if low == high else f"{low} to {high} %"


def _list(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def meaning(found: Comparison) -> str:
    """Explain the table's words, and what the numbers are not."""
    clear = (
        " Clear by: the least distance of the whole arm from what stands around, or of the point that it "
        "leads where the motion goes through a ring."
        if any(row.contacts is not None for row in found.rows)
        else ""
    )
    return (
        "Kept apart: of the distance between the starts, what is left half way. End off: from the end of the "
        "middle line. Farthest and on average: from the nearest demonstration (Frechet, DTW). Bold: clearly "
        f"the least.{clear} Times are measured once, on a machine that also serves this page."
    )


def table(known: Compared) -> str:
    """Build the table as HTML: a line a measure, a column a method; a failed method says so in its cell.

    Parameters
    ----------
    known : Compared
        With what is found so far.
    """
    rows = {} if known.found is None else {row.method: row for row in known.found.rows}
    around = any(row.contacts is not None for row in rows.values())
    lines = (*LINES[:5], *(AMONG_THINGS if around else ()), *LINES[5:])
    head = "".join(_head(name) for name in known.names)
    body = "".join(_line(line, known, rows, 0 if i else len(lines)) for i, line in enumerate(lines))
    style = (
        "<style>.gc-compare{border-collapse:collapse;width:100%;font-size:0.7rem;line-height:1.3;"
        "font-variant-numeric:tabular-nums}.gc-compare th{font-weight:600;padding:2px}.gc-compare td{"
        "text-align:right;padding:2px 3px;border-top:1px solid light-dark(#dde1e7,#3a3f47)}"
        f".gc-compare th+th{{{PAPER}}}.gc-compare td:first-child{{text-align:left;white-space:nowrap}}"
        f".gc-compare td.gc-why{{color:{words.AMBER};vertical-align:top}}"
        ".gc-compare td.gc-why div{text-align:left;writing-mode:vertical-lr;overflow-wrap:anywhere}</style>"
    )
    return (
        f'{style}<div style="padding:0 0.5rem 0.5rem;overflow-x:auto">'
        f'<table class="gc-compare"><tr><th></th>{head}</tr>{body}</table></div>'
    )


def _head(name: str) -> str:
    hint = words.escape(HINTS.get(name, "The tube (generalized cylinder)."))
    return f'<th title="{hint}">{_swatch(LOOKS[name])}<br>{LOOKS[name].label}</th>'


def _line(line: Line, known: Compared, rows: Mapping[str, Row], height: int) -> str:
    """One line; where a method failed, its cell of all lines is in the first one, which has a height."""
    values = {name: line.value(row) for name, row in rows.items() if row.failed is None}
    written = {name: float(format(value, line.form)) for name, value in values.items() if value is not None}
    best = best_of(written) if line.least_is_best else None
    cells = [f'<td title="{words.escape(line.hint)}">{line.label}</td>']
    for name in known.names:
        failed = rows[name].failed if name in rows else None
        if failed is None:
            cells.append(f"<td>{_number(values.get(name), line, known, bold=name == best)}</td>")
        elif height:
            why = f'<div style="height:{ROW * height:.1f}em">{words.escape(failed)}</div>'
            cells.append(f'<td class="gc-why" rowspan="{height}">{why}</td>')
    return f"<tr>{''.join(cells)}</tr>"


def _number(value: float | None, line: Line, known: Compared, *, bold: bool) -> str:
    if value is None:
        return WAITS if known.doing else NONE
    text = format(float(format(value, line.form)), ",.0f") if value >= 100.0 else format(value, line.form)
    return f"<b>{text}</b>" if bold else text


def best_of(values: Mapping[str, float]) -> str | None:
    """Name the clearly least of values as they are written; None where there is no such one."""
    known = sorted((value, name) for name, value in values.items())
    if len(known) < 2 or known[0][0] > CLEARLY * known[1][0] or known[0][0] == known[1][0]:
        return None
    return known[0][1]


def _swatch(look: Look) -> str:
    style = "dashed" if look.dashed else "solid"
    return f'<span style="display:inline-block;width:2em;border-top:4px {style} {look.hex}"></span>'
