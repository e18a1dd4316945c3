"""What physics found, in a teacher's words.

"The hand stays inside the tube" and "the whole arm clears the box" are two
different facts: the first is about one point and what was taught, the second
about every link and what stands around. No sentence here says both.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from app.arm import urdf
from app.arm.physics_report import Distances, Encounter, Nearest, Playback

FOLLOWED = 0.005
"""A tool that was never farther than this from where it should have been followed its path [m]."""

ON_THE_EDGE = 0.01
"""A hand that is outside by less than this part of the radius is on the tube's edge, which is inside."""

_PARTS = {
    "link_base": "base",
    "link_1": "shoulder",
    "link_2": "upper arm",
    "link_3": "forearm",
    "link_4": "wrist",
    "link_5": "wrist",
    "link_6": "hand",
}


def part_in_words(link: str) -> str:
    """Name a link as a person would: ``forearm``, ``hand``; both fingers are ``finger``."""
    return _PARTS.get(link.removeprefix(urdf.PREFIX), "finger")


def thing_in_words(name: str) -> str:
    """Name a thing in a sentence: ``the box``, but ``box 2``."""
    return name if name[-1:].isdecimal() or name.startswith("the ") else f"the {name}"


def inside_tube(ratios: npt.ArrayLike, times: npt.ArrayLike) -> str:
    """Say whether the hand, one point, stays in the tube.

    Parameters
    ----------
    ratios : (K,) array
        Distance from the directrix over the radius there; up to 1 is inside.
    times : (K,) array
        When the hand is there [s].

    Returns
    -------
    str
        One sentence.
    """
    eta, clock = np.asarray(ratios, dtype=np.float64), np.asarray(times, dtype=np.float64)
    outside = eta > 1.0 + ON_THE_EDGE
    if not outside.any():
        return "The hand stays inside the tube."
    first, worst = int(np.argmax(outside)), int(np.argmax(eta))
    if outside[0]:
        inside = int(np.argmin(outside))
        if outside[inside]:
            return "The hand is never inside the tube."
        if not outside[inside:].any():
            return f"The hand begins outside the tube and is inside it from {clock[inside]:.1f} s on."
    return (
        f"The hand leaves the tube at {clock[first]:.1f} s; at {clock[worst]:.1f} s it is "
        f"{100.0 * (eta[worst] - 1.0):.0f} % of the radius outside."
    )


def clear_of_things(clearance: Distances, times: npt.ArrayLike) -> str:
    """Say how clear the whole arm stays of what stands around it.

    Parameters
    ----------
    clearance : Distances
        Of the path.
    times : (K,) array
        When the arm is there [s].

    Returns
    -------
    str
        One sentence, about the nearest thing.
    """
    return clear_of_nearest(clearance.nearest, times)


def clear_of_nearest(nearest: Nearest | None, times: npt.ArrayLike) -> str:
    """Say the same of the nearest thing alone; None: there is nothing around."""
    if nearest is None:
        return "There is nothing around the arm to keep clear of."
    time = float(np.asarray(times, dtype=np.float64)[nearest.index])
    part, thing = part_in_words(nearest.link), thing_in_words(nearest.object)
    length = length_in_words(abs(nearest.distance))
    if nearest.distance >= 0.0:
        return f"The whole arm clears {thing} by {length}; its {part} comes nearest, at {time:.1f} s."
    return (
        f"The {part} would be {length} deep in {thing} at {time:.1f} s. Move {thing} or lead the path "
        "around it."
    )


def met(encounter: Encounter) -> str:
    """Say one encounter: link, thing, time and depth."""
    return (
        f"The {part_in_words(encounter.link)} would go through {thing_in_words(encounter.object)} from "
        f"{encounter.begins:.1f} s to {encounter.ends:.1f} s, {length_in_words(encounter.depth)} deep at "
        f"{encounter.deepest:.1f} s."
    )


def played(playback: Playback) -> tuple[str, ...]:
    """Say what happened when the arm played a path under its limits: following, touching, carrying."""
    worst = int(np.argmax(playback.errors))
    error, time = float(playback.errors[worst]), float(playback.times[worst])
    if error <= FOLLOWED:
        said = [f"The arm follows the path to {length_in_words(error)}."]
    else:
        said = [
            f"The arm cannot follow: at {time:.1f} s its hand is {length_in_words(error)} from where it "
            "should be."
        ]
    said += [
        f"The {part_in_words(contact.link)} touches {thing_in_words(contact.object)} at "
        f"{contact.begins:.1f} s with up to {contact.force:.0f} N."
        for contact in playback.contacts
    ]
    for carried in playback.carried:
        until = "to the end" if carried.released is None else f"to {carried.released:.1f} s"
        said.append(f"The hand carries {thing_in_words(carried.object)} from {carried.taken:.1f} s {until}.")
    return tuple(said)


def length_in_words(metres: float) -> str:
    """Write a length to the millimetre: ``3.1 cm``, ``0.4 mm``, ``less than 0.1 mm``."""
    if metres < 1e-4:
        return "less than 0.1 mm"
    return f"{1000.0 * metres:.1f} mm" if metres < 0.01 else f"{100.0 * metres:.1f} cm"
