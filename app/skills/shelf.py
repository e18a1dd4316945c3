"""Built-in skills on disk: ``<name>.csv`` holds the motions, ``<name>.toml`` all else."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from app import measures
from app.arm.shapes import UPRIGHT
from app.document import SECTION_KINDS, Document, FloatArray, Place, SectionKind, Settings, Shape
from app.edits import add_demonstrations, point
from app.edits.things import NEW
from app.files import read
from app.skills.errors import DamagedSkillError, NoSuchSkillError
from gc_core import GcError

EMPTY_GOAL: Final = (0.0, -0.60, 0.06)
"""Where the ball stands in a new skill: in front of the arm, on a low stand [m]."""


@dataclass(frozen=True)
class Card:
    """What stands in a skill's TOML file."""

    title: str
    about: str
    section: SectionKind
    goal: tuple[float, float, float]
    """Where the object stands that the motion leads to [m]."""
    starts: tuple[tuple[float, float, float], ...]
    """Where its reproductions begin [m]."""
    law: Mapping[str, float]
    """Thresholds that the skill must keep; see `app.skills.recipes`."""
    new_goals: tuple[tuple[float, float, float], ...] = ()
    """Where to move the goal to, one after the other, to see the law kept [m]."""
    new_starts: tuple[tuple[float, float, float], ...] = ()
    """Where to move the start to, one after the other [m]."""
    things: tuple[Shape, ...] = ()
    """What stands around."""


def skill_names(folder: Path) -> tuple[str, ...]:
    """List the built-in skills of a folder, by name."""
    return tuple(sorted(path.stem for path in folder.glob("*.toml") if path.with_suffix(".csv").is_file()))


def load_skill(folder: Path, name: str) -> Document:
    """Open a built-in skill.

    Parameters
    ----------
    folder : Path
        Of the skills, ``static/skills``.
    name : str
        One of `skill_names`.

    Raises
    ------
    SkillError
        If there is no such skill, or its files are damaged.
    """
    card = load_card(folder, name)
    try:
        document = Document(
            title=card.title,
            about=card.about,
            settings=Settings(section=card.section),
            landmarks=(Place("start"), Place("goal", taught=point(card.goal))),
            tries=(
                *(Place("goal", now=point(place)) for place in card.new_goals),
                *(Place("start", now=point(place)) for place in card.new_starts),
            ),
            starts=tuple(point(start) for start in card.starts),
            things=card.things,
            built_in=True,
        )
        return add_demonstrations(document, read(folder / f"{name}.csv", units="m"))
    except GcError as error:
        raise DamagedSkillError(name, str(error)) from error


def load_card(folder: Path, name: str) -> Card:
    """Read what a built-in skill says of itself; as `load_skill`."""
    if name not in skill_names(folder):
        raise NoSuchSkillError(name, skill_names(folder))
    try:
        with (folder / f"{name}.toml").open("rb") as file:
            return _card(tomllib.load(file))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise DamagedSkillError(name, f"{name}.toml: {error}") from error


def format_card(card: Card) -> str:
    """Write a card as TOML; `load_card` reads it."""
    lines = [
        "# Made by `python -m app.skills`. A teacher may change the words and the thresholds.",
        f"title = {_quoted(card.title)}",
        f"about = {_quoted(card.about)}",
        f"section = {_quoted(card.section)}",
        f"goal = {_numbers(card.goal)}  # where the ball stands [m]",
        f"starts = [{', '.join(_numbers(start) for start in card.starts)}]  # of the reproductions [m]",
        "",
        "[law]",
        *(f"{name} = {value:g}" for name, value in card.law.items()),
    ]
    moves = (("goals", card.new_goals), ("starts", card.new_starts))
    tries = [f"{what} = [{', '.join(map(_numbers, places))}]" for what, places in moves if places]
    if tries:
        lines += ["", "[try]  # where landmarks can be moved to, one after the other [m]", *tries]
    for thing in card.things:
        lines += ["", "[[things]]  # measures and place of the middle [m], mass [kg]: 0 stands fixed"]
        lines += _thing_lines(thing)
    return "\n".join(lines) + "\n"


def empty_skill() -> Document:
    """Give a person a table with a ball, an arm, and nothing taught."""
    return Document(
        title="My skill",
        about="Take the hand, pull it to the ball, and let go: that is a demonstration.",
        landmarks=(Place("start"), Place("goal", taught=point(EMPTY_GOAL))),
    )


def _card(table: Mapping[str, Any]) -> Card:
    section = str(table["section"])
    if section not in SECTION_KINDS:
        raise ValueError(f"section is {section!r} and not one of {', '.join(SECTION_KINDS)}")
    tries: Mapping[str, Any] = table.get("try", {})
    return Card(
        title=str(table["title"]),
        about=str(table["about"]),
        section=section,
        goal=_triple(table["goal"]),
        starts=tuple(_triple(start) for start in table["starts"]),
        law={str(key): float(value) for key, value in table["law"].items()},
        new_goals=tuple(_triple(place) for place in tries.get("goals", ())),
        new_starts=tuple(_triple(place) for place in tries.get("starts", ())),
        things=tuple(map(_thing, table.get("things", ()))),
    )


def _thing(table: Mapping[str, Any]) -> Shape:
    kind, lengths = str(table["kind"]), tuple(float(length) for length in table["measures"])
    new = next((new for name, new in NEW.items() if name == kind), None)
    if new is None or len(lengths) != len(measures.measures(new)):
        raise ValueError(f"there is no {kind[:40]} of {len(lengths)} measures")
    w, x, y, z = (float(value) for value in table.get("wxyz", UPRIGHT))
    named = replace(new, name=str(table["name"]), position=_triple(table["position"]), wxyz=(w, x, y, z))
    return replace(measures.measured(named, lengths), mass=float(table.get("mass", 0.0)))


def _thing_lines(thing: Shape) -> list[str]:
    return [
        f"kind = {_quoted(measures.kind_of(thing))}",
        f"name = {_quoted(thing.name)}",
        f"position = {_numbers(thing.position)}",
        f"measures = {_numbers(measures.measures(thing))}",
        *([] if thing.wxyz == UPRIGHT else [f"wxyz = {_numbers(thing.wxyz)}"]),
        *([] if thing.mass == 0.0 else [f"mass = {thing.mass:g}"]),
    ]


def _triple(values: Any) -> tuple[float, float, float]:
    x, y, z = values
    return float(x), float(y), float(z)


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def _numbers(values: Sequence[float] | FloatArray) -> str:
    return "[" + ", ".join(f"{value:.4f}".rstrip("0").rstrip(".") for value in values) + "]"
