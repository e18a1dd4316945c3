"""Whether a document that a stranger wrote is one: every field of its type, every number within bounds.

What the library saved is our own; a file that was sent is not, and a dataclass believes what it is given.
"""

from __future__ import annotations

import types
import typing
from collections.abc import Sequence
from dataclasses import fields, is_dataclass, replace
from typing import Any, Final, Literal, Union, cast, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from app import measures
from app.document import Document, Place, Rule, Shape, plain
from app.edits import LARGEST_COORDINATE, MOST_LANDMARKS, MOST_THINGS, point, set_smoothing, set_stations
from app.edits.checks import LONGEST_IN_SCENE, LONGEST_NAME
from app.edits.things import HEAVIEST, LARGEST
from app.files import MOST_SAMPLES
from gc_core import GcError

MOST_STARTS: Final = 12
MOST_SHOWN: Final = 1000
MOST_RULES: Final = 1000
MOST_TRIES: Final = 1000
"""Nobody makes so many by hand: what was made here must be read here."""
LONGEST_TEXT: Final = 2000
"""Of any text in a skill [letters]."""


class ForeignSkillError(GcError):
    """A file describes no skill that could have been made here."""

    def __init__(self, problem: str) -> None:
        super().__init__(f"{problem}. The skill was not opened; ask for the file again.")
        self.problem = problem


def checked(document: Document) -> Document:
    """Give a document back if it could have been made here.

    Raises
    ------
    GcError
        Naming the field that is of another type, out of bounds, or too many.
    """
    _check(document, Document, "the skill")
    for what, items, most in (
        ("demonstrations", document.demonstrations, MOST_SHOWN),
        ("landmarks", document.landmarks, MOST_LANDMARKS),
        ("things", document.things, MOST_THINGS),
        ("starts", document.starts, MOST_STARTS),
        ("rules", document.rules, MOST_RULES),
        ("places to try", document.tries, MOST_TRIES),
    ):
        if len(items) > most:
            raise ForeignSkillError(f"The file has {len(items)} {what}, and a skill at most {most}")
    if not document.title.strip() or len(document.title) > LONGEST_NAME:
        raise ForeignSkillError("The skill in the file has no name, or one that is too long")
    _check_landmarks(document)
    _check_scene_names("thing", [thing.name for thing in document.things])
    for start in document.starts:
        point(start)
    for thing in document.things:
        _check_thing(thing)
    for shown in document.demonstrations:
        if len(shown.demonstration.times) > MOST_SAMPLES:
            raise ForeignSkillError(f"A demonstration of the file has more than {MOST_SAMPLES} samples")
    for rule in document.rules:
        _check_rule(rule)
    # Their bounds are those of the edits, which give the same document back.
    set_stations(replace(document, settings=replace(document.settings)), document.settings.stations)
    return set_smoothing(document, document.smoothing)


def _check_landmarks(document: Document) -> None:
    _check_scene_names("landmark", [place.name for place in document.landmarks])
    kinds = [place.kind for place in document.landmarks]
    if max(kinds.count("start"), kinds.count("goal")) > 1:
        raise ForeignSkillError("The motion in the file has two starts or two goals")
    for place in (*document.landmarks, *document.tries):
        _check_place(place)


def _check_scene_names(noun: str, names: Sequence[str]) -> None:
    for name in names:
        if not name or len(name) > LONGEST_IN_SCENE or "/" in name or "\n" in name:
            raise ForeignSkillError(f"A {noun} of the file is called {name[:40]!r}, which cannot be a name")
    if len(set(names)) < len(names):
        raise ForeignSkillError(f"Two {noun}s of the file have the same name")


def _check_place(place: Place) -> None:
    for position in (place.taught, place.now):
        if position is not None:
            point(position)
    if place.turn is not None and (place.turn.shape != (3,) or np.abs(place.turn).max() > 100.0):
        raise ForeignSkillError(f"The turn of {place.name} is not three angles")


def _check_thing(thing: Shape) -> None:
    point(thing.position)
    turned = 0.1 <= float(np.linalg.norm(np.clip(thing.wxyz, -100.0, 100.0))) <= 10.0
    if not turned or max(measures.measures(thing)) > LARGEST or thing.mass > HEAVIEST:
        raise ForeignSkillError(
            f"No thing can be turned, as large or as heavy as the {thing.name} of the file"
        )


def _check_rule(rule: Rule) -> None:
    constraint = rule.constraint
    n = len(np.atleast_1d(constraint.stations))
    fits = constraint.stations.shape == constraint.lengths.shape == (n,)
    fits = fits and constraint.points.shape == constraint.normals.shape == (n, 3) and 2 <= n <= MOST_SAMPLES
    if not fits or np.any(np.diff(constraint.stations) <= 0.0):
        raise ForeignSkillError(f"The rule {rule.name[:40]!r} of the file does not fit together")
    if max(np.abs(constraint.points).max(), np.abs(constraint.lengths).max()) > LARGEST_COORDINATE:
        raise ForeignSkillError(f"The rule {rule.name[:40]!r} of the file is far beyond the arm")


def _check(value: object, hint: Any, where: str) -> None:
    """Check a value against an annotation of `app.document` or `gc_core`, all the way down."""
    if not _fits(value, hint, where):
        raise ForeignSkillError(f"In the file, {where} is no {_noun(hint)}")


def _fits(value: object, hint: Any, where: str) -> bool:
    origin, arguments = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return any(_passes(value, one, where) for one in arguments)
    if origin is Literal:
        return isinstance(value, str) and value in arguments
    if origin is tuple:
        return isinstance(value, tuple) and _fits_tuple(cast("tuple[object, ...]", value), arguments, where)
    if origin is np.ndarray:
        return isinstance(value, np.ndarray) and _sound(cast("NDArray[Any]", value))
    return _fits_plain(value, hint, where)


def _fits_plain(value: object, hint: Any, where: str) -> bool:
    if hint is float:
        return type(value) in (float, int) and bool(np.isfinite(cast(float, value)))
    if hint is str:
        return isinstance(value, str) and len(value) <= LONGEST_TEXT and plain(value) == value
    return type(value) is hint and (not is_dataclass(hint) or _fits_fields(value, where))


def _passes(value: object, hint: Any, where: str) -> bool:
    """Whether one of several kinds fits; what is wrong inside of the only dataclass is said at once."""
    if is_dataclass(hint) and type(value) is not hint:
        return False
    return _fits(value, hint, where)


def _fits_tuple(values: tuple[object, ...], hints: tuple[Any, ...], where: str) -> bool:
    if len(hints) == 2 and hints[1] is Ellipsis:
        for number, value in enumerate(values, 1):
            _check(value, hints[0], f"number {number} of {where}")
        return True
    return len(values) == len(hints) and all(
        _fits(value, hint, where) for value, hint in zip(values, hints, strict=True)
    )


def _fits_fields(value: Any, where: str) -> bool:
    kind: type = value.__class__
    hints = get_type_hints(kind)
    for field in fields(value):
        _check(getattr(value, field.name), hints[field.name], f"{field.name} of {where}")
    return True


def _sound(array: NDArray[Any]) -> bool:
    return array.dtype == np.float64 and bool(np.isfinite(array).all())


def _noun(hint: Any) -> str:
    origin = typing.get_origin(hint)
    words: dict[Any, str] = {
        np.ndarray: "array of finite numbers",
        tuple: "list",
        Literal: "known word",
        str: "readable text of moderate length",
        int: "whole number",
        float: "finite number",
        bool: "yes or no",
    }
    return words.get(origin or hint, getattr(hint, "__name__", "known value").lower())
