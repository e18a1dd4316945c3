"""What every method of learning a motion can do here, and what all of them learn from.

A `Method` is a name with its parameters; `fit` makes a `Skill` of demonstrations, which
reproduces from any start. A method that cannot cope with some data raises a `BaselineError`,
so that whoever compares methods reports it and goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Final, Protocol

import numpy as np

from app.document import Alignment, FloatArray
from gc_core import Demonstration, GcError
from gc_core.alignment import align
from gc_core.arrays import interpolated, read_only_fields
from gc_core.demonstration import trim

SAMPLES: Final = 200
"""Samples of what methods learn from, and of what they reproduce."""

_INSTALL: Final[dict[str, str]] = {
    "gmr": "Install it with: pip install gmr",
    "movement_primitives": (
        "It is compiled while it is installed: install a C++ compiler and Python's headers (on Debian: "
        "apt-get install g++ python3-dev), then: pip install movement_primitives pytransform3d"
    ),
}


class BaselineError(GcError):
    """A method cannot be used, or not on these data."""


class MissingPackageError(BaselineError):
    """A method's package is not installed."""

    def __init__(self, method: str, package: str) -> None:
        super().__init__(f"{method} needs the package {package}, which is missing. {_INSTALL[package]}")
        self.package = package


class CannotLearnError(BaselineError):
    """A method fails on some demonstrations."""

    def __init__(self, method: str, reason: str) -> None:
        super().__init__(
            f"{method} cannot learn these demonstrations: {reason}. "
            "Show some that differ more, or give it fewer components or weights."
        )


class CannotReproduceError(BaselineError):
    """A method fails from some start."""

    def __init__(self, method: str, reason: str) -> None:
        super().__init__(
            f"{method} cannot reproduce from this start: {reason}. Choose another start or goal."
        )


@dataclass(frozen=True, eq=False)
class Run:
    """A reproduced motion."""

    times: FloatArray
    """(K,) from 0, strictly increasing [s]."""
    positions: FloatArray
    """(K, 3) [m]."""

    def __post_init__(self) -> None:
        read_only_fields(self)


class Skill(Protocol):
    """What a method made of demonstrations."""

    def reproduce(self, start: FloatArray, goal: FloatArray | None = None) -> Run:
        """Perform the motion.

        Parameters
        ----------
        start : (3,) array
            Where the tool is now [m].
        goal : (3,) array or None
            Where to end [m]; None: where the demonstrations ended, in the mean.

        Raises
        ------
        BaselineError
            If the method fails.
        """
        ...


class Method(Protocol):
    """A way to learn a motion, with its parameters."""

    @property
    def name(self) -> str:
        """How it is called in tables: kind and parameter, ``gmr-5``."""
        ...

    def ready(self) -> None:
        """Import what the method needs, which takes a moment the first time.

        Raises
        ------
        MissingPackageError
            If its package is not installed.
        """
        ...

    def fit(self, demonstrations: Sequence[Demonstration]) -> Skill:
        """Learn.

        Parameters
        ----------
        demonstrations : sequence of n Demonstration
            n >= 1.

        Raises
        ------
        BaselineError
            If the method fails.
        GcError
            If the demonstrations cannot be used by any method.
        """
        ...


@dataclass(frozen=True, eq=False)
class Taught:
    """Demonstrations in correspondence, as all methods but the cylinder get them."""

    times: FloatArray
    """(N,) even, from 0 to the mean duration [s]."""
    paths: FloatArray
    """(n, N, 3) corresponding places on the demonstrations [m]."""

    def __post_init__(self) -> None:
        read_only_fields(self)

    @property
    def phase(self) -> FloatArray:
        """(N,) times from 0 to 1 [-]."""
        return self.times / self.times[-1]

    @property
    def mean(self) -> FloatArray:
        """(N, 3) the mean of the paths [m]."""
        return self.paths.mean(axis=0)


def taught(demonstrations: Sequence[Demonstration], align_by: Alignment, samples: int = SAMPLES) -> Taught:
    """Trim demonstrations and put them in correspondence, with the same functions as the cylinder.

    Parameters
    ----------
    demonstrations : sequence of n Demonstration
        n >= 1.
    align_by : {"time", "arc_length", "dtw"}
        What corresponds.
    samples : int
        N.

    Returns
    -------
    Taught

    Raises
    ------
    GcError
        As `gc_core.encode`.
    """
    found = align(tuple(trim(each) for each in demonstrations), samples, align_by, None)
    times = np.linspace(0.0, float(found.times[-1]), samples)
    paths = [places_at(times, found.times, path) for path in found.aligned]
    return Taught(times, np.array(paths))


def places_at(at: FloatArray, where: FloatArray, places: FloatArray) -> FloatArray:
    """Give the places (K, 3) at `at` (K,) on a line through places (N, 3) that are at `where` (N,)."""
    return np.stack([interpolated(at, where, places[:, axis]) for axis in range(3)], axis=1)


def package(method: str, name: str) -> Any:
    """Import a module of an optional package when a method needs it.

    Parameters
    ----------
    method : str
        Which method asks, for the message.
    name : str
        Full name of the module.

    Raises
    ------
    MissingPackageError
        If it, or what it needs, is not installed.
    """
    try:
        return import_module(name)
    except ImportError as error:
        raise MissingPackageError(method, name.partition(".")[0]) from error


@contextmanager
def failing_as(error: Callable[[str, str], BaselineError], method: str) -> Generator[None]:
    """Turn what the libraries raise on singular or useless data into a sentence about the method."""
    try:
        with np.errstate(divide="raise", invalid="raise", over="raise"):
            yield
    except (np.linalg.LinAlgError, ValueError, ArithmeticError) as cause:
        if isinstance(cause, GcError):
            raise
        raise error(method, str(cause).rstrip(".") or type(cause).__name__) from cause


def finite_run(method: str, times: FloatArray, positions: FloatArray) -> Run:
    """Make a run of positions (K, 3) [m], or say that they are no numbers."""
    if not np.isfinite(positions).all():
        raise CannotReproduceError(method, "its path holds values that are no numbers")
    return Run(times, positions)
