"""Checked, read-only arrays, and what it means that two values have the same content."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gc_core.errors import NotFiniteError, ShapeError

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.intp]
Scalar = TypeVar("Scalar", bound=np.generic)


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
