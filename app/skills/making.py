"""From a recipe to the files of a built-in skill, through the arm.

The arm's inverse kinematics lead the hand along each motion; what is kept is where
the hand really was.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from app.arm import HERE, Arm
from app.files.csv_format import format_csv
from app.skills.errors import SkillError
from app.skills.motion import demonstrate
from app.skills.recipes import Recipe
from app.skills.shelf import Card, format_card
from gc_core import Demonstration, encode

DECIMALS: Final = 4
"""Digits kept of positions and times: 0.1 mm and 0.1 ms."""


@dataclass(frozen=True, eq=False)
class Made:
    """A built-in skill, ready to be written."""

    demonstrations: tuple[Demonstration, ...]
    card: Card


def make(recipe: Recipe, arm: Arm) -> Made:
    """Show a recipe's motions with an arm.

    Raises
    ------
    SkillError
        If the arm cannot follow one of them.
    """
    demonstrations = tuple(_performed(arm, shown) for shown in demonstrate(recipe.plan))
    card = Card(
        title=recipe.title,
        about=recipe.about,
        section=recipe.section,
        goal=recipe.goal,
        starts=_starts(recipe, demonstrations),
        law=recipe.law,
        new_goals=recipe.new_goals,
        new_starts=recipe.new_starts,
        things=recipe.things,
    )
    return Made(demonstrations, card)


def write(made: Made, folder: Path, name: str) -> None:
    """Write ``<name>.csv`` and ``<name>.toml``."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.csv").write_bytes(format_csv(made.demonstrations, decimals=DECIMALS))
    (folder / f"{name}.toml").write_text(format_card(made.card), encoding="utf-8")


def _performed(arm: Arm, shown: Demonstration) -> Demonstration:
    path = arm.follow(shown.positions)
    worst = int(np.argmax(path.errors))
    if path.errors[worst] > HERE:
        raise SkillError(
            f"The {arm.name} stays {100.0 * path.errors[worst]:.1f} cm away from {shown.name} at "
            f"{shown.times[worst]:.1f} s. Move the waypoints of the recipe into its reach."
        )
    hand = np.array([arm.tool_pose(joints)[:3, 3] for joints in path.joints])
    return Demonstration(shown.times, np.round(hand, DECIMALS), gripper=shown.gripper, name=shown.name)


def _starts(
    recipe: Recipe, demonstrations: Sequence[Demonstration]
) -> tuple[tuple[float, float, float], ...]:
    """Turn ratios and directions into places, in the second section: rounding keeps them in the tube."""
    cylinder = encode(demonstrations, section=recipe.section, align_by="arc_length")
    centre, rim = cylinder.directrix[1], cylinder.surface()[1]
    starts: list[tuple[float, float, float]] = []
    for ratio, direction in recipe.starts:
        nearest = int(np.argmin(np.abs(np.angle(np.exp(1j * (cylinder.angles - direction))))))
        x, y, z = centre + ratio * (rim[nearest] - centre)
        starts.append((round(float(x), DECIMALS), round(float(y), DECIMALS), round(float(z), DECIMALS)))
    return tuple(starts)
