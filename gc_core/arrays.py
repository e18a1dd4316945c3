"""Checked, read-only arrays, and what it means that two values have the same content."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import wraps
from typing import Any, Concatenate, ParamSpec, TypeVar, cast
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gc_core.errors import NotFiniteError, ShapeError

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.intp]
Scalar = TypeVar("Scalar", bound=np.generic)
Key = TypeVar("Key")
Result = TypeVar("Result")
Options = ParamSpec("Options")


def read_only(array: NDArray[Scalar]) -> NDArray[Scalar]:
    """Copy an array into one that cannot be written to."""
    copy = np.array(array, order="C")
    copy.setflags(write=False)
    return copy


def finite(values: ArrayLike, what: str, shape: tuple[int | None, ...]) -> FloatArray:
    """Check an input array once, and copy it.

    Parameters
    ----------
    values : array_like
        What was given.
    what : str
        How to call it in a message.
    shape : tuple
        Wanted shape; None stands for any length.

    Returns
    -------
    array
        A read-only float64 copy.

    Raises
    ------
    ShapeError
        If the shape differs, or the values are no numbers of equal row lengths.
    NotFiniteError
        If a value is NaN or infinite.
    """
    expected = "(" + ", ".join("any" if n is None else str(n) for n in shape) + ")"
    try:
        array = np.array(values, dtype=np.float64, order="C")
    except (TypeError, ValueError):
        raise ShapeError(f"{what} (which must be numbers in rows of equal length)", expected, ()) from None
    fits = array.ndim == len(shape) and all(n in (None, m) for n, m in zip(shape, array.shape, strict=True))
    if not fits:
        raise ShapeError(what, expected, array.shape)
    if not np.isfinite(array).all():
        raise NotFiniteError(what, int(np.argwhere(~np.isfinite(array))[0][0]) if array.ndim else 0)
    array.setflags(write=False)
    return array


def interpolated(at: FloatArray, x: FloatArray, y: FloatArray) -> FloatArray:
    """Interpolate the polyline y(x) (T,) at places (K,), its end values beyond its ends."""
    return np.asarray(np.interp(at, x, y), dtype=np.float64)


def following(values: NDArray[Scalar]) -> NDArray[Scalar]:
    """Values (N, P, ...) of the following place on each closed line; several times as quick as np.roll."""
    return np.concatenate((values[:, 1:], values[:, :1]), axis=1)


def preceding(values: NDArray[Scalar]) -> NDArray[Scalar]:
    """Values (N, P, ...) of the place before on each closed line."""
    return np.concatenate((values[:, -1:], values[:, :-1]), axis=1)


def evenly(count: int, most: int) -> IntArray:
    """At most ``most`` indices into ``count`` things, spread evenly, the first and the last among them."""
    most = min(most, count)
    return np.rint(np.arange(most) * (count - 1) / max(most - 1, 1)).astype(np.intp)


def fading(part: FloatArray) -> FloatArray:
    """Fall from 1 at part 0 to 0 at part 1, with level ends."""
    return (1.0 - part) ** 2 * (1.0 + 2.0 * part)


def remembered(
    function: Callable[Concatenate[Key, Options], Result],
) -> Callable[Concatenate[Key, Options], Result]:
    """Decorate a function of an immutable value, so that its latest result lives as long as the value does.

    Parameters
    ----------
    function : callable
        Its first argument is compared by identity, the others by their values.

    Returns
    -------
    callable
        The same function; one result is kept for each living first argument.
    """
    memory: WeakKeyDictionary[Key, tuple[object, Result]] = WeakKeyDictionary()

    @wraps(function)
    def lookup(value: Key, /, *options: Options.args, **named: Options.kwargs) -> Result:
        asked = (options, named)
        known = memory.get(value)
        if known is None or known[0] != asked:
            known = (asked, function(value, *options, **named))
            memory[value] = known
        return known[1]

    return lookup


def read_only_fields(value: object) -> None:
    """Replace every array of a frozen dataclass by a copy that cannot be written to."""
    for name, content in tuple(vars(value).items()):
        if isinstance(content, np.ndarray):
            object.__setattr__(value, name, read_only(cast("NDArray[Any]", content)))


def same_content(a: object, b: object) -> bool:
    """Compare two values of this package by what they hold.

    Parameters
    ----------
    a, b : object
        Dataclasses, arrays, tuples, lists, dictionaries or plain values, nested.

    Returns
    -------
    bool
        True when types, shapes and every value agree exactly (NaN equals NaN).
    """
    if a is b or type(a) is not type(b):
        return a is b
    if isinstance(a, np.ndarray):
        x, y = cast("NDArray[Any]", a), cast("NDArray[Any]", b)
        return x.dtype == y.dtype and np.array_equal(x, y, equal_nan=x.dtype.kind in "fc")
    if is_dataclass(a) and not isinstance(a, type):
        return all(same_content(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))
    if isinstance(a, (tuple, list)):
        left, right = cast("tuple[object, ...]", a), cast("tuple[object, ...]", b)
        return len(left) == len(right) and all(map(same_content, left, right))
    if isinstance(a, dict):
        one, two = cast("dict[object, object]", a), cast("dict[object, object]", b)
        return one.keys() == two.keys() and all(same_content(v, two[k]) for k, v in one.items())
    return bool(a == b) or (a != a and b != b)  # noqa: PLR0124 - only NaN differs from itself
