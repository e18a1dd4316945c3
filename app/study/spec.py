"""What a study does, read from a TOML file: data sets x methods x kinds of slices x alignments.

Every key and value that is wrong is told in a sentence with what is possible. The file says what
to do; `app.study.sources` opens the data that it names.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, TypeVar, cast, get_args

from app.baselines import DEFAULT, methods
from app.comparison import MOST_STARTS
from app.document import Alignment
from app.resources import static_folder
from app.study.errors import BadSpecError
from gc_core import GcError
from gc_core.sections import SECTIONS

_T = TypeVar("_T")

FARTHEST: Final = 2.0
"""Landmarks are moved by no more than this [m]."""


@dataclass(frozen=True)
class Plan:
    """How much is done with each data set; all that the numbers depend on beside the data and the part."""

    seed: int = 0
    starts: int = 0
    """Random starts in the first slice, for each method; 0: none."""
    moves: int = 0
    """Random moves of start and goal; 0: none."""
    farthest_m: float = 0.2
    """By how much each of them is moved at most [m]."""
    leave_one_out: bool = False
    """Learn without each demonstration in turn, and compare with it."""


@dataclass(frozen=True)
class Choice:
    """Data sets that a spec names."""

    files: str
    """A built-in skill, or a pattern of files relative to the data's folder."""
    name: str | None = None
    """Of the one data set that all files make together; None: each file is a data set, called as it is."""


@dataclass(frozen=True)
class Spec:
    """A study."""

    file: str
    """Where it was read, for messages."""
    title: str
    data: Path
    """Folder that patterns are relative to."""
    data_sets: tuple[Choice, ...]
    methods: tuple[str, ...] = DEFAULT
    sections: tuple[str, ...] = tuple(SECTIONS)
    """Kinds of slices of the tube; other methods have none."""
    alignments: tuple[Alignment, ...] = ("arc_length",)
    plan: Plan = field(default_factory=Plan)


def spec_path(named: Path) -> Path:
    """Find a study's file: a path, or the name of one that comes with gc-teach (``paper``).

    Raises
    ------
    BadSpecError
        If there is none.
    """
    if named.is_file():
        return named
    shipped = static_folder() / "studies"
    found = shipped / f"{named.name.removesuffix('.toml')}.toml"
    if len(named.parts) == 1 and found.is_file():
        return found
    names = ", ".join(sorted(path.stem for path in shipped.glob("*.toml")))
    raise BadSpecError(str(named), f"there is no such file. Give a TOML file, or one of: {names}.")


def read_spec(path: Path, data: Path | None = None) -> Spec:
    """Read a study.

    Parameters
    ----------
    path : Path
        TOML file.
    data : Path or None
        Folder of the data in place of the one that the file names.

    Raises
    ------
    BadSpecError
        If it is no TOML, or a key or a value is wrong.
    """
    try:
        values = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise BadSpecError(path.name, f"this is no TOML file ({error}).") from error
    return _Reader(path.name, values).spec(path, data)


KEYS: Final = (
    "title",
    "seed",
    "data",
    "data_sets",
    "methods",
    "sections",
    "alignments",
    "starts",
    "moves",
    "farthest_m",
    "leave_one_out",
)


@dataclass(frozen=True)
class _Reader:
    """Takes values out of a TOML table, or says what is wrong with them."""

    file: str
    values: Mapping[str, Any]

    def spec(self, path: Path, data: Path | None) -> Spec:
        self._known(self.values, KEYS)
        plan = Plan(
            seed=self._whole("seed", 0, 2**63 - 1),
            starts=self._whole("starts", 0, MOST_STARTS),
            moves=self._whole("moves", 0, MOST_STARTS),
            farthest_m=self._length("farthest_m", Plan().farthest_m),
            leave_one_out=self._value("leave_one_out", bool, "true or false", default=False),
        )
        folder = Path(self._value("data", str, "a folder in quotes", default="."))
        spec = Spec(
            file=self.file,
            title=self._value("title", str, "words in quotes", default=path.stem),
            data=data or path.resolve().parent / folder,
            data_sets=self._data_sets(),
            methods=self._methods(),
            sections=self._chosen("sections", tuple(SECTIONS), tuple(SECTIONS)),
            alignments=cast(
                "tuple[Alignment, ...]", self._chosen("alignments", get_args(Alignment), ("arc_length",))
            ),
            plan=plan,
        )
        if not (plan.starts or plan.moves or plan.leave_one_out):
            raise BadSpecError(
                self.file, "there is nothing to do. Give starts, moves or leave_one_out = true."
            )
        return spec

    def _known(self, given: Mapping[str, Any], keys: tuple[str, ...]) -> None:
        unknown = [repr(key) for key in given if key not in keys]
        if unknown:
            named = f"is no key {unknown[0]}" if len(unknown) == 1 else f"are no keys {', '.join(unknown)}"
            raise BadSpecError(self.file, f"there {named}. Possible are: {', '.join(keys)}.")

    def _value(self, key: str, kind: type[_T], wanted: str, *, default: _T) -> _T:
        value = self.values.get(key, default)
        if type(value) is not kind:
            raise self._wrong(key, value, wanted)
        return value

    def _whole(self, key: str, least: int, most: int) -> int:
        wanted = f"a whole number from {least} to {most}"
        value = self._value(key, int, wanted, default=0)
        if not least <= value <= most:
            raise self._wrong(key, value, wanted)
        return value

    def _length(self, key: str, default: float) -> float:
        value = self.values.get(key, default)
        if type(value) not in (int, float) or not 0.0 < value <= FARTHEST:
            raise self._wrong(key, value, f"a number of metres above 0, {FARTHEST:g} at most")
        return float(value)

    def _wrong(self, key: str, value: object, wanted: str) -> BadSpecError:
        return BadSpecError(self.file, f"{key} cannot be {value!r}. Give {wanted}.")

    def _list(self, key: str, default: tuple[str, ...] | None, what: str) -> list[Any]:
        value: Any = self.values.get(key, None if default is None else list(default))
        found = cast("list[Any]", value)
        if value is None:
            raise BadSpecError(self.file, f"the key {key} is missing. Give it a list of {what} in brackets.")
        if not isinstance(value, list) or not found:
            raise self._wrong(key, found, f"a list of {what} in brackets")
        for place, each in enumerate(found):
            if each in found[:place]:
                raise BadSpecError(self.file, f"{key} names {each!r} twice. Leave one of them out.")
        return found

    def _chosen(self, key: str, possible: tuple[str, ...], default: tuple[str, ...]) -> tuple[str, ...]:
        names = self._list(key, default, "names")
        for name in names:
            if name not in possible:
                raise self._wrong(key, name, f"some of: {', '.join(possible)}")
        return tuple(names)

    def _methods(self) -> tuple[str, ...]:
        names = self._list("methods", DEFAULT, "names")
        try:
            methods([str(name) for name in names])
        except GcError as error:
            raise BadSpecError(self.file, f"methods: {error}") from error
        return tuple(names)

    def _data_sets(self) -> tuple[Choice, ...]:
        what = 'built-in skills, patterns such as "*.csv", or {name = "one set", files = "*.h5"}'
        return tuple(self._choice(each, what) for each in self._list("data_sets", None, what))

    def _choice(self, given: object, what: str) -> Choice:
        if isinstance(given, str):
            return Choice(given)
        if not isinstance(given, dict):
            raise self._wrong("data_sets", given, what)
        table = cast("dict[str, Any]", given)
        self._known(table, ("name", "files"))
        if not all(isinstance(table.get(key), str) for key in ("name", "files")):
            raise self._wrong("data_sets", table, 'both a name and files: {name = "one set", files = "*.h5"}')
        return Choice(table["files"], table["name"])
