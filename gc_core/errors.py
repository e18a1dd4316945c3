"""What can be wrong with what was given to `gc_core`.

One class per cause. A message says what is wrong, where, and what to do, so that
it can be shown to the person as it is; the evidence is kept as attributes.
"""

from __future__ import annotations

from collections.abc import Iterable


class GcError(ValueError):
    """Something given to `gc_core` cannot be used; the fault is the input's."""


class ShapeError(GcError):
    """An array has the wrong shape."""

    def __init__(self, what: str, expected: str, got: tuple[int, ...]) -> None:
        super().__init__(f"{what} must have the shape {expected}, but has {got}. Reshape or transpose it.")
        self.expected = expected
        self.got = got


class TooFewSamplesError(GcError):
    """A demonstration has less than two samples."""

    def __init__(self, what: str, count: int) -> None:
        super().__init__(
            f"{what} has {count} sample{'' if count == 1 else 's'}, but a motion needs at least 2. "
            "Show it again, or leave it out."
        )
        self.count = count


class NotFiniteError(GcError):
    """An array holds a value that is not a number or infinite."""

    def __init__(self, what: str, index: int) -> None:
        super().__init__(
            f"{what}: the value at sample {index} is not a finite number. "
            "Remove that sample or repair the recording."
        )
        self.index = index


class TimesNotIncreasingError(GcError):
    """The times of a demonstration do not strictly increase."""

    def __init__(self, what: str, index: int, before: float, after: float) -> None:
        super().__init__(
            f"{what}: time does not move on from sample {index} ({before:g} s) to sample {index + 1} "
            f"({after:g} s). Sort the samples by time and remove those with equal times."
        )
        self.index = index


class TooFarError(GcError):
    """A position is further away than any arm reaches."""

    def __init__(self, what: str, index: int, distance: float, limit: float) -> None:
        super().__init__(
            f"{what}: the position at sample {index} is {distance:.3g} m away from the base, "
            f"beyond {limit:g} m. Give metres (millimetres must be divided by 1000), or remove that sample "
            "if it is a sensor's error."
        )
        self.index = index
        self.distance = distance


class TooLateError(GcError):
    """A time is further from zero than any clock in seconds."""

    def __init__(self, what: str, index: int, time: float, limit: float) -> None:
        super().__init__(
            f"{what}: the time at sample {index} is {time:.3g} s, beyond {limit:g} s. Give seconds "
            "(milliseconds must be divided by 1e3, microseconds by 1e6, nanoseconds by 1e9)."
        )
        self.index = index
        self.time = time


class NoMotionError(GcError):
    """All samples of a demonstration are in the same place."""

    def __init__(self, what: str, count: int, extent: float) -> None:
        super().__init__(
            f"{what} stands still: its {count} samples lie within {extent * 1000:.3g} mm of each other. "
            "Show a motion, or leave it out."
        )
        self.extent = extent


class ZeroQuaternionError(GcError):
    """A quaternion has no direction."""

    def __init__(self, what: str, index: int) -> None:
        super().__init__(
            f"{what}: the quaternion at sample {index} has length zero and is no orientation. "
            "Give unit quaternions in the order w, x, y, z."
        )
        self.index = index


class NoDemonstrationsError(GcError):
    """Nothing was shown."""

    def __init__(self) -> None:
        super().__init__("There is no demonstration to learn from. Show at least one motion.")


class NotADemonstrationError(GcError):
    """Something else was given in place of a demonstration."""

    def __init__(self, index: int, kind: str) -> None:
        super().__init__(
            f"Number {index + 1} of the demonstrations is of the kind {kind!r}. "
            "Make a Demonstration of its times and positions."
        )
        self.index = index


class OpposedDemonstrationsError(GcError):
    """The mean of the demonstrations does not move."""

    def __init__(self, length: float) -> None:
        super().__init__(
            f"The middle of the demonstrations moves by {length * 1000:.3g} mm only: they cancel each other "
            "out, as if some were shown backwards. Turn those round, or leave them out."
        )
        self.length = length


class DegenerateCurveError(GcError):
    """A curve has no direction at some point."""

    def __init__(self, index: int) -> None:
        super().__init__(
            f"The curve has no direction at point {index}: its neighbours coincide. "
            "Remove one of them or resample the curve."
        )
        self.index = index


class UnknownOptionError(GcError):
    """A named option has a value that does not exist."""

    def __init__(self, option: str, value: object, valid: Iterable[str]) -> None:
        self.valid = tuple(valid)
        names = ", ".join(repr(name) for name in self.valid)
        super().__init__(f"{option} cannot be {value!r}. Choose one of {names}.")
        self.option = option


class InvalidSettingError(GcError):
    """A number is outside the range in which it makes sense."""

    def __init__(self, setting: str, value: object, wanted: str) -> None:
        said = f"{value:g}" if isinstance(value, int | float) else repr(value)
        super().__init__(f"{setting} must be {wanted}, but is {said}. Choose another value.")
        self.setting = setting
        self.value = value


class LandmarkMismatchError(GcError):
    """There are not as many target landmarks as source landmarks."""

    def __init__(self, sources: int, targets: int) -> None:
        super().__init__(
            f"{sources} landmarks cannot be moved to {targets} places. "
            "Give each landmark exactly one new place."
        )
        self.sources = sources
        self.targets = targets
