"""The built-in skills: what is shown, what it is called, and the law that it must show."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from app.document import Box, Cylinder, Ring, SectionKind, Shape
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
    """What the skill must show; the tests read it from the skill's file, and ask it of the tube that was
    taught and after each move to `new_goals` and `new_starts`. In metres: how far from the
    goal demonstrations and reproductions end at most; how wide the tube is, at least near its
    beginning and at most at its end; how far from the start the hand closes and from the goal it opens
    at most. As a part of the narrower end: how wide it is at most half of
    the way along; as a part of the width there: how wide the ends are at most. Width is the mean over all
    directions of the distance from boundary to boundary through the middle line: twice the mean radius of
    the slice. As a part of the distance from start to goal: how far the middle line bows out at least
    (`bow`), and how far it may lie at most from the one that was taught, turned and scaled from the old
    start and goal to the new ones (`shape_change`). How far every run within the tube keeps the hand, and
    the whole arm, from what stands around at least. For refinement: how far and over which width a
    line is pulled down (`pull_m`, `press_m`, `width_m`); how deep the corrected demonstration dips at least;
    how much ends and other demonstrations move at most; and by which part of its share the middle line and a
    run beside it may miss it (`of_the_mean`). For a rule: how far behind it a run may be (`obeys_m`), and how
    many times its former largest step a run may make (`leap`)."""
    new_goals: tuple[tuple[float, float, float], ...] = ()
    """Where the goal is moved to, one after the other [m]."""
    new_starts: tuple[tuple[float, float, float], ...] = ()
    """Where the start is moved to, one after the other [m]."""
    things: tuple[Shape, ...] = ()
    """What stands around [m]."""


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
    law={"middle_to_ends": 0.25, "middle_m": 0.03, "hand_clear_m": 0.015},
    things=(Ring("eye", (0.0662, -0.5433, 0.3706), 0.045, 0.006, wxyz=(0.5695, 0.2251, -0.7906, 0.0)),),
)

_SHELF: Final = (-0.30, -0.42, 0.07)

CURVED: Final = Recipe(
    name="curved_reach_and_place",
    title="Curved reach and place",
    about="This robot was shown five times how to go round in a wide curve and put something down. Move the "
    "goal, and it keeps the curve.",
    plan=Plan(
        waypoints=((0.36, -0.24, 0.25), (0.33, -0.47, 0.33), (0.08, -0.64, 0.36), (-0.2, -0.6, 0.24), _SHELF),
        spread=((0.0, 0.055), (0.35, 0.06), (0.7, 0.04), (0.92, 0.016), (1.0, 0.012)),
        seed=13,
    ),
    section="closed_spline",
    goal=_SHELF,
    starts=((0.65, 0.9), (0.6, 3.6)),
    law={"demonstration_end_m": 0.02, "reproduction_end_m": 0.02, "bow": 0.4, "shape_change": 0.2},
    new_goals=((-0.40, -0.27, 0.07), (-0.14, -0.36, 0.07), (-0.36, -0.52, 0.20)),
)

_BEHIND_THE_BOX: Final = (-0.34, -0.38, 0.07)

AROUND: Final = Recipe(
    name="around_an_obstacle",
    title="Around an obstacle",
    about="Nobody told this robot of the box. It was shown five times how to go around it, so every run "
    "in the tube stays clear.",
    plan=Plan(
        waypoints=(
            (0.40, -0.36, 0.20),
            (0.27, -0.58, 0.23),
            (0.02, -0.71, 0.22),
            (-0.22, -0.58, 0.19),
            _BEHIND_THE_BOX,
        ),
        spread=((0.0, 0.075), (0.3, 0.062), (0.55, 0.055), (0.9, 0.016), (1.0, 0.012)),
        seed=9,
    ),
    section="closed_spline",
    goal=_BEHIND_THE_BOX,
    starts=((0.65, 0.9), (0.8, 3.6)),
    law={"reproduction_end_m": 0.02, "hand_clear_m": 0.05, "arm_clear_m": 0.03},
    things=(Box("box", (0.02, -0.41, 0.13), (0.18, 0.14, 0.26)),),
)

_PUT_DOWN: Final = (-0.28, -0.48, 0.06)

PICK: Final = Recipe(
    name="pick_and_place",
    title="Pick and place",
    about="This robot was shown five times how to pick something up and put it down: exact where the hand "
    "closes and opens, free in between.",
    plan=Plan(
        waypoints=(
            (0.36, -0.32, 0.06),
            (0.32, -0.37, 0.24),
            (0.06, -0.50, 0.38),
            (-0.20, -0.51, 0.26),
            _PUT_DOWN,
        ),
        spread=((0.0, 0.01), (0.06, 0.012), (0.5, 0.075), (0.94, 0.012), (1.0, 0.01)),
        seed=3,
        seconds=(5.0, 6.2),
        unevenness=0.08,
        care=0.12,
        grip=(0.012, 0.988),
    ),
    section="closed_spline",
    goal=_PUT_DOWN,
    things=(Cylinder("cup", (0.36, -0.32, 0.03), 0.02, 0.06, mass=0.1),),
    starts=((0.7, 0.6), (0.7, 3.8)),
    law={"ends_to_middle": 0.25, "grip_m": 0.03, "reproduction_end_m": 0.02},
    new_starts=((0.46, -0.22, 0.06), (0.24, -0.46, 0.06), (0.46, -0.44, 0.06), (0.24, -0.24, 0.16)),
)

_ACROSS: Final = (-0.36, -0.44, 0.30)

DIP: Final = Recipe(
    name="the_dip",
    title="The dip",
    about="This robot was shown three times how to cross the table. Pull a red line down in its middle, and "
    "the tube dips with it, by a third.",
    plan=Plan(
        waypoints=((0.42, -0.30, 0.30), (0.24, -0.48, 0.32), (-0.02, -0.56, 0.32), _ACROSS),
        spread=((0.0, 0.045), (0.5, 0.055), (1.0, 0.018)),
        seed=10,
        demonstrations=3,
    ),
    section="closed_spline",
    goal=_ACROSS,
    starts=((0.5, 3.14),),
    law={"pull_m": 0.09, "width_m": 0.25, "dip_m": 0.05, "others_m": 0.001, "of_the_mean": 0.1},
)

LID: Final = Recipe(
    name="the_lid",
    title="The lid",
    about="Two runs cross the table, one high and one low. Press the high one down: that is a rule "
    "(constraint) for all runs, and the low one does not notice.",
    plan=Plan(
        waypoints=((0.42, -0.30, 0.30), (0.24, -0.48, 0.32), (-0.02, -0.56, 0.32), _ACROSS),
        spread=((0.0, 0.085), (0.6, 0.09), (1.0, 0.02)),
        seed=11,
        demonstrations=5,
    ),
    section="closed_spline",
    goal=_ACROSS,
    starts=((0.75, 4.6), (0.75, 1.47)),
    law={"press_m": 0.07, "width_m": 0.25, "obeys_m": 1e-9, "leap": 3.0},
)

RECIPES: Final = (REACHING, NEEDLE, CURVED, AROUND, PICK, DIP, LID)
