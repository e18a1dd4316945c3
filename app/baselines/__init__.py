"""Methods to compare with: each learns the same demonstrations and runs from the same starts.

`methods(names)` makes them from names such as ``gc``, ``ramp``, ``dmp-5``, ``promp-10`` or ``gmr-5``,
where the number counts weights for each axis, or Gaussians. Their packages, `gmr` and
`movement_primitives`, are imported only when a method is used.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from app.baselines.dmp import Primitive
from app.baselines.gmr import Mixture, mixture_directrix
from app.baselines.promp import Distribution
from app.baselines.protocol import (
    SAMPLES,
    BaselineError,
    CannotLearnError,
    CannotReproduceError,
    Method,
    MissingPackageError,
    Run,
    Skill,
    Taught,
    places_at,
    taught,
)
from app.baselines.ramp import Ramp
from app.baselines.tube import Tube
from app.document import Alignment

__all__ = (
    "DEFAULT",
    "BaselineError",
    "CannotLearnError",
    "CannotReproduceError",
    "Distribution",
    "Method",
    "MissingPackageError",
    "Mixture",
    "NoMethodError",
    "Primitive",
    "Ramp",
    "Run",
    "Skill",
    "Taught",
    "Tube",
    "UnknownMethodError",
    "methods",
    "mixture_directrix",
    "places_at",
    "taught",
)

DEFAULT: Final = ("gc", "ramp", "dmp-5", "dmp-10", "promp-5", "promp-10", "gmr-5", "gmr-10")
"""What is compared unless told otherwise: the methods and the numbers of Fig. 9, and two more kinds."""

_COUNTED: Final[dict[str, Callable[[int, Alignment], Method]]] = {
    "dmp": Primitive,
    "promp": Distribution,
    "gmr": Mixture,
}
"""Kinds with a number."""


_POSSIBLE: Final = (
    "Choose gc, ramp, or dmp, promp or gmr with a number of weights or components from 2 to "
    f"{SAMPLES}: dmp-5."
)


class UnknownMethodError(BaselineError):
    """A name stands for no method."""

    def __init__(self, name: str) -> None:
        super().__init__(f"There is no method {name!r}. {_POSSIBLE}")
        self.name = name


class NoMethodError(BaselineError):
    """Nothing is to be compared."""

    def __init__(self) -> None:
        super().__init__(f"No method is named. {_POSSIBLE}")


def methods(names: Sequence[str] = DEFAULT, tube: Tube | None = None) -> tuple[Method, ...]:
    """Make methods by their names.

    Parameters
    ----------
    names : sequence of str
        ``gc``, ``ramp``, or ``dmp``, ``promp`` or ``gmr`` with a number: ``dmp-5``.
    tube : Tube or None
        The cylinder; its alignment is everyone's.

    Raises
    ------
    NoMethodError
        If there are no names.
    UnknownMethodError
        If a name stands for none.
    """
    if not names:
        raise NoMethodError
    cylinder = tube or Tube()
    return tuple(_method(name, cylinder) for name in names)


def _method(name: str, tube: Tube) -> Method:
    if name == tube.name:
        return tube
    if name == "ramp":
        return Ramp(tube.align_by)
    kind, _, number = name.partition("-")
    make = _COUNTED.get(kind)
    if make is None or not (number.isdecimal() and 2 <= int(number) <= SAMPLES):
        raise UnknownMethodError(name)
    return make(int(number), tube.align_by)
