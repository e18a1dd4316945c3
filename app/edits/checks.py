"""What edits share: their error, and the checks of what they are given."""

from collections.abc import Sequence
from typing import Final, TypeVar

import numpy as np

from app.document import FloatArray, plain
from gc_core import GcError

LARGEST_COORDINATE: Final = 10.0
"""No point of a document lies farther from the base than this [m]."""
LONGEST_NAME: Final = 80
"""Of a skill or a thing in it [letters]."""
LONGEST_IN_SCENE: Final = 40
"""Of a thing that is named in the scene [letters]."""

_T = TypeVar("_T")


class EditError(GcError):
    """An edit asks for something that the document does not have or allow."""


def point(values: Sequence[float] | FloatArray) -> FloatArray:
    """Check and freeze one position.

    Returns
    -------
    (3,) array
        Read-only copy [m].

    Raises
    ------
    EditError
        If it is not three finite numbers within ``LARGEST_COORDINATE``.
    """
    try:
        p = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):  # words, or lists within the list
        p = np.empty(0)
    if p.shape != (3,) or not np.all(np.abs(p) <= LARGEST_COORDINATE):
        raise EditError(
            f"A position needs three numbers between -{LARGEST_COORDINATE:g} and "
            f"{LARGEST_COORDINATE:g} m, got {str(values)[:80]}."
        )
    p.setflags(write=False)
    return p


def name_from(name: str) -> str:
    """Make a name of what a person typed or a file says; empty where there is nothing to be seen."""
    return plain(name).strip()[:LONGEST_NAME]


def renamed(noun: str, name: str, former: str, taken: Sequence[str]) -> str:
    """Check a new name of a thing in the scene; the former one where nothing else was typed.

    Raises
    ------
    EditError
        If it is taken, or could not be a name in the scene.
    """
    name = plain(" ".join(name.split()))[:LONGEST_IN_SCENE]
    if not name or name == former:
        return former
    if "/" in name:
        raise EditError(f"The name of a {noun} cannot have a / in it. Use another sign.")
    if name in taken:
        raise EditError(f"There is something called {name} already. Choose another name.")
    return name


def next_number(noun: str, names: Sequence[str]) -> int:
    """One more than there are things, and than any name of the form ``<noun> <number>`` says."""
    said = (name.removeprefix(f"{noun} ") for name in names if name.startswith(f"{noun} "))
    numbers = [int(number) for number in said if number.isascii() and number.isdecimal() and len(number) < 7]
    return max([len(names), *numbers]) + 1


def without(items: tuple[_T, ...], index: int) -> tuple[_T, ...]:
    """All items but one."""
    return (*items[:index], *items[index + 1 :])


def at(items: tuple[_T, ...], index: int, noun: str) -> _T:
    """Find an item by its place."""
    if not 0 <= index < len(items):
        raise EditError(f"There is no {noun} {index + 1}; there are {len(items)}.")
    return items[index]


def one_of(noun: str, value: _T, valid: tuple[_T, ...]) -> _T:
    """Check a choice."""
    if value not in valid:
        raise EditError(f"{value!r} is no {noun}. Choose one of: {', '.join(map(str, valid))}.")
    return value
