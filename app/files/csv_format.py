"""Tables of text: ``t,x,y,z[,qw,qx,qy,qz][,gripper][,demo]``, one sample a line.

Columns are found by name, in any order; without a header three columns are
x, y, z and four are t, x, y, z. Comma, semicolon, tab and blanks separate; where
the semicolon separates, numbers may have a decimal comma.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.document import FloatArray
from app.files.errors import BadValueError, UnreadableError
from app.files.recording import Contents, Recording, check_count, check_length
from gc_core import Demonstration

ALIASES: Final[Mapping[str, str]] = {
    "time": "t", "time_s": "t", "seconds": "t", "timestamp": "t", "t_s": "t",
    "px": "x", "pos_x": "x", "position_x": "x",
    "py": "y", "pos_y": "y", "position_y": "y",
    "pz": "z", "pos_z": "z", "position_z": "z",
    "demonstration": "demo", "trajectory": "demo",
}  # fmt: skip
QUATERNION: Final = ("qw", "qx", "qy", "qz")
NUMBERS: Final = ("t", "x", "y", "z", *QUATERNION, "gripper")


@dataclass(frozen=True)
class _Layout:
    """Which column holds what."""

    delimiter: str | None
    """None: any run of blanks."""
    columns: Mapping[str, int]
    width: int


def parse_csv(name: str, content: bytes) -> Contents:
    """Read demonstrations from a table of text.

    Raises
    ------
    FileError
        With the line and the column of what cannot be used.
    """
    rows = _rows(_text(name, content))
    first = next(rows, None)
    if first is None:
        raise UnreadableError(name, "it holds no line of numbers", "Write one sample a line: t,x,y,z.")
    delimiter = _delimiter(first[1])
    fields = _split(first[1].lstrip("# "), delimiter)
    header = not all(_is_number(field, delimiter) for field in fields)
    columns = _named_columns(name, fields) if header else _plain_columns(name, len(fields))
    layout = _Layout(delimiter, columns, len(fields))
    groups: dict[str, list[list[float]]] = {}
    for number, line in rows if header else _chain(first, rows):
        label, values = _sample(name, number, line, layout)
        group = groups.setdefault(label, [])
        group.append(values)
        check_count(name, len(groups))
        check_length(name, len(group))
    recordings = (_recording(label, np.array(group), layout) for label, group in groups.items())
    return Contents(tuple(recordings))


def format_csv(demonstrations: Sequence[Demonstration], decimals: int | None = None) -> bytes:
    """Write demonstrations as a table with a ``demo`` column.

    Parameters
    ----------
    demonstrations : sequence of Demonstration
        Positions in metres.
    decimals : int, optional
        Digits behind the point; None writes every number exactly.
    """
    oriented = any(d.orientations is not None for d in demonstrations)
    gripping = any(d.gripper is not None for d in demonstrations)
    extra = (*(QUATERNION if oriented else ()), *(("gripper",) if gripping else ()))
    out = io.StringIO(newline="")
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["t", "x", "y", "z", *extra, "demo"])
    for label, d in zip(labels(demonstrations), demonstrations, strict=True):
        blank = np.full(len(d.times), np.nan)
        blocks = [d.times[:, None], d.positions]
        if oriented:
            blocks.append(np.tile(blank[:, None], 4) if d.orientations is None else d.orientations)
        if gripping:
            blocks.append((blank if d.gripper is None else d.gripper)[:, None])
        for row in np.hstack(blocks).tolist():
            writer.writerow([*(_number(value, decimals) for value in row), label])
    return out.getvalue().encode()


def labels(demonstrations: Sequence[Demonstration]) -> list[str]:
    """One distinct label a demonstration: its name, or its number."""
    taken: list[str] = []
    for number, d in enumerate(demonstrations, start=1):
        base = " ".join(d.name.split()) or str(number)
        label, copy = base, 2
        while label in taken:
            label, copy = f"{base} ({copy})", copy + 1
        taken.append(label)
    return taken


def name_of(label: str) -> str:
    """Undo `labels`: a bare number is no name."""
    return "" if label.isdigit() else label


def _text(name: str, content: bytes) -> str:
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise BadValueError(
            name, f"line {line}", "it is not text in UTF-8", "Save the table as CSV (comma separated, UTF-8)."
        ) from error
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise BadValueError(name, f"line {line}", "it is not text", "Save the table as CSV.")
    return text


def _rows(text: str) -> Iterator[tuple[int, str]]:
    """Numbered lines with something on them; ``#`` starts a comment, except before a header."""
    seen = False
    for number, line in enumerate(io.StringIO(text, newline=None), start=1):
        stripped = line.strip("\r\n")
        comment = stripped.lstrip().startswith("#") and (seen or not _names(stripped))
        if comment or not stripped.strip(" ,;\t"):
            continue
        seen = True
        yield number, stripped


def _names(line: str) -> bool:
    """Whether a comment is a header, as ``np.savetxt(header=...)`` writes it."""
    fields = {field.lower() for field in _split(line.lstrip("# "), _delimiter(line))}
    return {"x", "y", "z"} <= {ALIASES.get(field, field) for field in fields}


def _chain(first: tuple[int, str], rest: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    yield first
    yield from rest


def _delimiter(line: str) -> str | None:
    for candidate in (";", "\t", ","):
        if candidate in line:
            return candidate
    return None


def _split(line: str, delimiter: str | None) -> list[str]:
    if delimiter is None:
        return line.split()
    if '"' not in line:
        return [field.strip() for field in line.split(delimiter)]
    try:
        (fields,) = csv.reader([line], delimiter=delimiter)
        return [field.strip() for field in fields]
    except csv.Error:  # a field longer than the reader takes
        return [line]


def _value(field: str, delimiter: str | None) -> float:
    if not field:
        return float("nan")
    return float(field.replace(",", ".") if delimiter == ";" else field)


def _is_number(field: str, delimiter: str | None) -> bool:
    try:
        _value(field, delimiter)
    except ValueError:
        return False
    return True


def _named_columns(name: str, fields: Sequence[str]) -> dict[str, int]:
    columns: dict[str, int] = {}
    for index, field in enumerate(fields):
        column = ALIASES.get(field.lower(), field.lower())
        if column in columns:
            raise BadValueError(name, "line 1", f"there are two columns {column}", "Remove one of them.")
        columns[column] = index
    missing = [column for column in ("x", "y", "z") if column not in columns]
    if missing:
        raise BadValueError(
            name,
            "line 1",
            f"there is no column {' and no column '.join(missing)} among {', '.join(fields)}",
            "Name the columns t,x,y,z[,qw,qx,qy,qz][,demo].",
        )
    absent = [column for column in QUATERNION if column not in columns]
    if 0 < len(absent) < 4:
        raise BadValueError(
            name,
            "line 1",
            f"an orientation needs qw, qx, qy and qz, and there is no {' and no '.join(absent)}",
            "Add the column, or remove the others.",
        )
    return columns


def _plain_columns(name: str, width: int) -> dict[str, int]:
    if width not in (3, 4):
        raise BadValueError(
            name,
            "line 1",
            f"there are {width} columns and no names above them",
            "Write a first line with the names t,x,y,z[,qw,qx,qy,qz][,demo].",
        )
    return {column: index for index, column in enumerate(("t", "x", "y", "z")[4 - width :])}


def _sample(name: str, number: int, line: str, layout: _Layout) -> tuple[str, list[float]]:
    fields = _split(line, layout.delimiter)
    if len(fields) != layout.width:
        raise BadValueError(
            name,
            f"line {number}",
            f"there are {len(fields)} values, but {layout.width} in the first line",
            "Write one value for each column.",
        )
    values: list[float] = []
    for column in NUMBERS:
        index = layout.columns.get(column)
        if index is None:
            continue
        values.append(_field(name, number, column, fields[index], layout.delimiter))
    demo = layout.columns.get("demo")
    return "" if demo is None else fields[demo], values


def _field(name: str, number: int, column: str, field: str, delimiter: str | None) -> float:
    where = f"line {number}, column {column}"
    try:
        value = _value(field, delimiter)
    except ValueError:
        raise BadValueError(
            name, where, f"{field[:40]!r} is not a number", "Write a number such as 0.25, or remove the line."
        ) from None
    if not np.isfinite(value) and (field or column in ("t", "x", "y", "z")):
        raise BadValueError(
            name,
            where,
            "the value is missing" if not field else f"{field[:40]!r} is not a finite number",
            "Write the number that belongs there, or remove the line.",
        )
    return value


def _recording(label: str, table: FloatArray, layout: _Layout) -> Recording:
    present = [column for column in NUMBERS if column in layout.columns]
    column = {name: table[:, index] for index, name in enumerate(present)}
    quaternions = np.stack([column[q] for q in QUATERNION], axis=1) if "qw" in column else None
    gripper = column.get("gripper")
    return Recording(
        positions=np.stack([column["x"], column["y"], column["z"]], axis=1),
        times=column.get("t"),
        # A demonstration without them stands in the same table with empty fields.
        orientations=None if quaternions is None or np.isnan(quaternions).all() else quaternions,
        gripper=None if gripper is None or np.isnan(gripper).all() else gripper,
        name=name_of(label),
    )


def _number(value: float, decimals: int | None) -> str:
    if math.isnan(value):
        return ""
    if decimals is None:
        return repr(value)
    return f"{value:.{decimals}f}".rstrip("0").rstrip(".")
