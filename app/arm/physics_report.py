"""What physics found: how near, what was touched where and when, what was carried."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.arm.errors import ArmInputError
from app.arm.protocol import FloatArray


@dataclass(frozen=True, eq=False)
class Nearest:
    """Where a path comes nearest to a thing."""

    distance: float
    """Between the two bodies; negative: so deep in each other [m]."""
    index: int
    """Number of the configuration along the path."""
    link: str
    """Of the arm."""
    object: str
    """Name of the thing."""


@dataclass(frozen=True, eq=False)
class Distances:
    """Distances between the arm's links and things, along a path."""

    links: tuple[str, ...]
    """The L links that have a body."""
    objects: tuple[str, ...]
    """The O things that were measured."""
    distances: FloatArray
    """(K, L, O) between bodies; negative where they overlap; infinite beyond 10 m [m]."""

    @property
    def nearest(self) -> Nearest | None:
        """The smallest distance of all; None where there is nothing to be near to."""
        if self.distances.size == 0:
            return None
        index, link, thing = np.unravel_index(np.argmin(self.distances), self.distances.shape)
        least = float(self.distances[index, link, thing])
        return Nearest(least, int(index), self.links[link], self.objects[thing])


@dataclass(frozen=True, eq=False)
class Encounter:
    """One link in one thing, for a while: what would happen if the arm did as it was told."""

    link: str
    """Of the arm."""
    object: str
    """Name of the thing."""
    begins: float
    """First time they overlap [s]."""
    deepest: float
    """When they overlap most [s]."""
    ends: float
    """Last time they overlap [s]."""
    depth: float
    """How far one would have to be moved out of the other at the deepest [m]."""


@dataclass(frozen=True, eq=False)
class Contact:
    """One link touched one thing during a playback, for a while."""

    link: str
    """Of the arm."""
    object: str
    """Name of the thing."""
    begins: float
    """First time they touch [s]."""
    ends: float
    """Last time they touch [s]."""
    force: float
    """Largest force between them, all their points together [N]."""
    depth: float
    """How far physics let them sink into each other [m]; small, since they push each other away."""


@dataclass(frozen=True, eq=False)
class Carried:
    """A thing was held by the gripper."""

    object: str
    """Its name."""
    taken: float
    """[s]."""
    released: float | None
    """None: still held at the end [s]."""


@dataclass(frozen=True, eq=False)
class Playback:
    """What the arm really did under its limits, step by step."""

    times: FloatArray
    """(T,) [s]."""
    joints: FloatArray
    """(T, 6) [rad]."""
    positions: FloatArray
    """(T, 3) tool [m]."""
    errors: FloatArray
    """(T,) from the tool to where it should have been at that time [m]."""
    torque_shares: FloatArray
    """(6,) largest torque of each joint as a share of its limit."""
    speed_shares: FloatArray
    """(6,) largest speed of each joint as a share of its limit."""
    contacts: tuple[Contact, ...]
    """In the order in which they began."""
    carried: tuple[Carried, ...]
    """In the order in which they were taken."""
    objects: Mapping[str, FloatArray]
    """(T, 4, 4) pose of everything that can be carried."""


@dataclass(frozen=True)
class Touch:
    """One link and one thing at one step of a playback."""

    link: str
    object: str
    time: float
    force: float
    depth: float


def encounters(clearance: Distances, times: npt.ArrayLike, margin: float = 0.0) -> tuple[Encounter, ...]:
    """Say where a path leads the arm into things.

    Parameters
    ----------
    clearance : Distances
        Of the path, (K, L, O).
    times : (K,) array
        When the arm is there [s].
    margin : float
        Nearer than this counts as in it; the depth is still that of the overlap [m].

    Returns
    -------
    tuple of Encounter
        One for every link, thing and uninterrupted stay, in the order in which they begin.

    Raises
    ------
    ArmInputError
        If there is not one time for each configuration.
    """
    clock = np.asarray(times, dtype=np.float64)
    if clock.shape != clearance.distances.shape[:1]:
        raise ArmInputError("times", f"shape {clearance.distances.shape[:1]}", f"shape {clock.shape}")
    found: list[Encounter] = []
    for column, thing in enumerate(clearance.objects):
        for row, link in enumerate(clearance.links):
            along = clearance.distances[:, row, column]
            for first, last in _runs(along < margin):
                deepest = first + int(np.argmin(along[first : last + 1]))
                begins, at, ends = clock[[first, deepest, last]].tolist()
                found.append(Encounter(link, thing, begins, at, ends, -float(along[deepest])))
    return tuple(sorted(found, key=lambda encounter: encounter.begins))


def contacts_of(touches: list[Touch], pause: float) -> tuple[Contact, ...]:
    """Join touches of one link and one thing, unless they are farther apart than a pause [s]."""
    stays: dict[tuple[str, str], list[list[Touch]]] = {}
    for touch in touches:
        of_pair = stays.setdefault((touch.link, touch.object), [])
        if of_pair and touch.time - of_pair[-1][-1].time <= pause:
            of_pair[-1].append(touch)
        else:
            of_pair.append([touch])
    contacts = [
        Contact(
            link=link,
            object=thing,
            begins=stay[0].time,
            ends=stay[-1].time,
            force=max(touch.force for touch in stay),
            depth=max(touch.depth for touch in stay),
        )
        for (link, thing), of_pair in stays.items()
        for stay in of_pair
    ]
    return tuple(sorted(contacts, key=lambda contact: contact.begins))


def _runs(inside: npt.NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """Give first and last index of every uninterrupted stretch of True."""
    edges = np.diff(np.concatenate([[False], inside, [False]]).astype(np.int8))
    yield from zip(
        np.flatnonzero(edges == 1).tolist(), (np.flatnonzero(edges == -1) - 1).tolist(), strict=True
    )
