"""A study's report: one HTML file that needs no network."""

from __future__ import annotations

import platform
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from app.resources import static_folder
from app.study.errors import FolderError
from app.study.executors import tool
from app.study.keeping import write_whole
from app.study.parts import versions
from app.study.plots import MARKS, small_multiples
from app.study.running import Outcome
from app.study.spec import Spec
from app.study.summary import CHAPTERS, Chapter, Line, Quartiles, failures, lines_of

MOST_NAMED = 4
"""In a finding."""
_MARK_NAMES = dict(zip(MARKS, ("dot", "square", "triangle"), strict=True))


def write_report(found: Outcome, folder: Path) -> Path:
    """Write ``report.html``.

    Returns
    -------
    Path
        Where it is.

    Raises
    ------
    FolderError
        If it cannot be written.
    """
    jinja: Any = tool("jinja2")
    source = static_folder() / "studies"
    pages = jinja.Environment(
        loader=jinja.FileSystemLoader(source), autoescape=True, trim_blocks=True, lstrip_blocks=True
    )
    page: str = pages.get_template("report.html").render(
        study=found,
        plan=found.spec.plan,
        versions=dict(versions()) | {"Python": platform.python_version()},
        chapters=[filled for chapter in CHAPTERS if (filled := _chapter(chapter, found))],
        findings=[said for chapter in CHAPTERS for said in findings(chapter, found)],
        marks=list(zip(_MARK_NAMES.values(), sorted(found.spec.alignments), strict=False)),
        failures=failures(found.found),
        cell=cell,
    )
    path = folder / "report.html"
    try:
        write_whole(path, page.encode())
    except OSError as error:
        raise FolderError(str(folder), error.strerror or str(error)) from error
    return path


def _chapter(chapter: Chapter, found: Outcome) -> Mapping[str, Any] | None:
    """Tables and plots of an experiment; None when the study has none of it."""
    lines = sorted(lines_of(chapter, found.found), key=lambda line: _as_asked(line, found.spec))
    if not lines:
        return None
    drawn = [
        each for each in chapter.measures if each.drawn and any(line.found[each.column] for line in lines)
    ]
    shown = [each for each in chapter.measures if any(line.found[each.column] for line in lines)]
    sets = sorted({line.part.data_set for line in lines})
    return {
        "title": chapter.title,
        "what": chapter.what,
        "measures": shown,
        "plots": [
            (each, small_multiples(each, lines, f"{chapter.experiment}-{each.column}")) for each in drawn
        ],
        "sets": [(name, [line for line in lines if line.part.data_set == name]) for name in sets],
    }


def _as_asked(line: Line, spec: Spec) -> tuple[str, int, str, str]:
    """Order of lines: methods as the spec names them."""
    part = line.part
    return part.data_set, spec.methods.index(part.method), part.section, part.alignment


def findings(chapter: Chapter, found: Outcome) -> list[str]:
    """Say of each number of an experiment who is the best on most data sets; nothing where one is alone."""
    lines = lines_of(chapter, found.found)
    said: list[str] = []
    for measure in chapter.measures:
        medians: dict[str, list[tuple[float, str]]] = {}
        for line in lines:
            if measure.better and (value := line.found[measure.column]) is not None:
                name = f"{line.label} {line.part.alignment if len(found.spec.alignments) > 1 else ''}".strip()
                medians.setdefault(line.part.data_set, []).append((float(_short(value.median)), name))
        first = min if measure.better == "least" else max
        ahead = Counter(
            name for each in medians.values() for value, name in each if value == first(each)[0] and each[1:]
        )
        if ahead:
            named = ", ".join(f"{name} ({count})" for name, count in ahead.most_common(MOST_NAMED))
            more = f" and {len(ahead) - MOST_NAMED} more" if len(ahead) > MOST_NAMED else ""
            said.append(f"{chapter.title}, {measure.title}: {measure.better} for {named}{more}.")
    return said


def cell(found: Quartiles | None) -> str:
    """Write a median with its quartiles where they differ; nothing where nothing was measured."""
    if found is None:
        return ""
    median, low, high = (_short(value) for value in (found.median, found.low, found.high))
    return median if low == high else f"{median} ({low}–{high})"


def _short(value: float) -> str:
    """Three digits, and no rounding errors."""
    if abs(value) < 5e-4:
        return "0"
    if abs(value) < 1e3:
        return f"{value:.3g}"
    return f"{value:.0f}" if abs(value) < 1e5 else f"{value:.1e}"
