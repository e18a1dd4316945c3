"""The built-in skills: what is shown, what it is called, and the law that it must show."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from app.document import SectionKind
from app.skills.motion import Plan


@dataclass(frozen=True)
class Recipe:
    """One built-in skill."""

    name: str
    """Of its files."""
    title: str
    about: str
    """One sentence for the person who opens it."""
    plan: Plan
    section: SectionKind
    goal: tuple[float, float, float]
    """Where the object stands that the motion leads to [m]."""
    starts: tuple[tuple[float, float], ...]
    """Of its reproductions: (ratio eta, direction in the first section [rad])."""
    law: Mapping[str, float]
    """What the skill must show; the tests read it from the skill's file. In metres: how far from the
    goal demonstrations and reproductions end at most; how wide the tube is, at least near its
    beginning and at most at its end. As a part of the narrower end: how wide it is at most half of
    the way along. Width is the mean over all directions of the distance from boundary to boundary
    through the middle line: twice the mean radius of the slice."""


_BALL: Final = (-0.11, -0.60, 0.06)

REACHING: Final = Recipe(
    name="reaching",
    title="Reaching",
    about="This robot was shown five times how to reach the ball. It learned this tube.",
    plan=Plan(
        waypoints=((0.42, -0.27, 0.40), (0.29, -0.42, 0.53), (0.01, -0.58, 0.42), _BALL),
        spread=((0.0, 0.095), (0.3, 0.088), (0.65, 0.05), (0.9, 0.02), (1.0, 0.014)),
        seed=2017,
    ),
    section="closed_spline",
    goal=_BALL,
    starts=((0.65, 0.9),),
    law={"demonstration_end_m": 0.02, "reproduction_end_m": 0.02, "widest_m": 0.12, "narrowest_m": 0.04},
)

_BEYOND_THE_EYE: Final = (-0.36, -0.44, 0.24)

NEEDLE: Final = Recipe(
    name="needle",
    title="Needle",
    about="This robot was shown five times how to thread the eye of a needle: free before and after, exact "
    "in the middle.",
    plan=Plan(
        waypoints=(
            (0.44, -0.26, 0.42),
            (0.24, -0.46, 0.42),
            (0.04, -0.55, 0.36),
            (-0.16, -0.55, 0.27),
            _BEYOND_THE_EYE,
        ),
        spread=((0.0, 0.088), (0.2, 0.066), (0.44, 0.012), (0.56, 0.012), (0.8, 0.064), (1.0, 0.084)),
        seed=8,
        care=0.3,
        rate=60.0,
    ),
    section="closed_spline",
    goal=_BEYOND_THE_EYE,
    starts=((0.65, 0.6), (0.7, 3.9)),
    law={"middle_to_ends": 0.25, "middle_m": 0.03},
)

RECIPES: Final = (REACHING, NEEDLE)
