"""A study's tables, as Parquet and as CSV.

`results` holds what was found and is the same bit by bit wherever it was worked out; how long that
took is never the same twice, and stands in `timings`.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, Final

from app.study.executors import tool
from app.study.experiments import Done, Timing
from app.study.keeping import write_whole
from app.study.measures import Row
from app.study.parts import Part


@dataclass(frozen=True)
class Column:
    """A column of a table."""

    name: str
    kind: str
    """"str", "int" or "float"; any may be empty."""


def columns(of: type[Row] | type[Part] | type[Timing]) -> tuple[Column, ...]:
    """Give the fields of a dataclass as columns."""
    kinds = {"str", "int", "float"}
    return tuple(
        Column(each.name, kind if (kind := str(each.type).partition(" ")[0]) in kinds else "str")
        for each in fields(of)
    )


RESULTS: Final = columns(Row)
TIMINGS: Final = (*columns(Part), *columns(Timing))


def write_tables(folder: Path, found: Sequence[tuple[Part, Done]]) -> None:
    """Write ``results`` and ``timings`` (.parquet, .csv), sorted by part.

    Raises
    ------
    OSError
        If they cannot be written.
    """
    ordered = sorted(found, key=lambda each: each[0])
    results = [asdict(row) for _, done in ordered for row in done.rows]
    timings = [asdict(part) | asdict(done.timing) for part, done in ordered]
    for name, head, rows in (("results", RESULTS, results), ("timings", TIMINGS, timings)):
        write_whole(folder / f"{name}.parquet", as_parquet(head, rows))
        write_whole(folder / f"{name}.csv", as_csv(head, rows))


def as_parquet(head: Sequence[Column], rows: Sequence[dict[str, Any]]) -> bytes:
    """Make a Parquet file of rows."""
    arrow = tool("pyarrow")
    kinds = {"str": arrow.string(), "int": arrow.int64(), "float": arrow.float64()}
    table = arrow.table(
        [arrow.array([row[each.name] for row in rows], kinds[each.kind]) for each in head],
        names=[each.name for each in head],
    )
    file = io.BytesIO()
    tool("pyarrow.parquet").write_table(table, file)
    return file.getvalue()


def as_csv(head: Sequence[Column], rows: Sequence[dict[str, Any]]) -> bytes:
    """Make a CSV file of rows; numbers with all their digits, nothing where nothing was measured."""
    text = io.StringIO()
    writer = csv.DictWriter(text, [each.name for each in head], lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue().encode()
