"""Edits of a skill's name, settings, demonstrations, starts and rules."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from app.document import (
    ALIGNMENTS,
    SECTION_KINDS,
    Alignment,
    Document,
    FloatArray,
    Rule,
    SectionKind,
    Shown,
)
from app.edits.checks import EditError, at, name_from, next_number, one_of, point, without
from gc_core import Constraint, Demonstration


def edit(document: Document, f: Callable[[Document], Document]) -> Document:
    """Apply an edit; the first one of a built-in skill makes it the person's own copy."""
    edited = f(document)
    if edited is document or not document.built_in:
        return edited
    own = f"My {document.title.lower().removeprefix('the ')}"
    title = edited.title if edited.title != document.title else own
    return replace(edited, title=title, built_in=False)


def skill_of(title: str, demonstrations: Sequence[Demonstration]) -> Document:
    """Make a skill of demonstrations that come from elsewhere."""
    about = f"{len(demonstrations)} demonstrations, and the tube that was learned from them."
    return add_demonstrations(Document(name_from(title) or "My skill", about), demonstrations)


def rename_skill(document: Document, title: str) -> Document:
    """Change the skill's name."""
    title = name_from(title)
    if title == document.title:
        return document
    if not title:
        raise EditError("A skill needs a name. Type at least one letter.")
    return replace(document, title=title)


def set_section(document: Document, section: SectionKind) -> Document:
    """Choose the kind of cross-section."""
    return _with_settings(document, section=one_of("cross-section", section, SECTION_KINDS))


def set_align_by(document: Document, align_by: Alignment) -> Document:
    """Choose how demonstrations are brought into correspondence."""
    return _with_settings(document, align_by=one_of("alignment", align_by, ALIGNMENTS))


def set_stations(document: Document, stations: int) -> Document:
    """Choose the number of stations along the directrix."""
    if not 20 <= stations <= 1000:
        raise EditError(f"The number of stations must be between 20 and 1000, got {stations}.")
    return _with_settings(document, stations=int(stations))


def add_demonstrations(document: Document, demonstrations: Sequence[Demonstration]) -> Document:
    """Append demonstrations; those without a name are numbered."""
    first = next_number("Demonstration", [shown.demonstration.name for shown in document.demonstrations])
    named = tuple(
        Shown(d if d.name else replace(d, name=f"Demonstration {first + i}"))
        for i, d in enumerate(demonstrations)
    )
    return replace(document, demonstrations=document.demonstrations + named) if named else document


def bring_back_demonstration(document: Document, shown: Shown) -> Document:
    """Append a demonstration that was deleted, as it was; nothing changes where it is back already."""
    if any(one.demonstration is shown.demonstration for one in document.demonstrations):
        return document
    return replace(document, demonstrations=(*document.demonstrations, shown))


def replace_demonstration(document: Document, index: int, demonstration: Demonstration) -> Document:
    """Put a corrected demonstration in the place of its original."""
    shown = at(document.demonstrations, index, "demonstration")
    if demonstration is shown.demonstration:
        return document
    return _with_shown(document, index, replace(shown, demonstration=demonstration))


def rename_demonstration(document: Document, index: int, name: str) -> Document:
    """Change a demonstration's name."""
    shown = at(document.demonstrations, index, "demonstration")
    name = name_from(name)
    if not name or name == shown.demonstration.name:
        return document
    return _with_shown(document, index, replace(shown, demonstration=replace(shown.demonstration, name=name)))


def mute_demonstration(document: Document, index: int, muted: bool) -> Document:
    """Keep a demonstration but do not learn from it, or learn from it again."""
    shown = at(document.demonstrations, index, "demonstration")
    if shown.muted == muted:
        return document
    return _with_shown(document, index, replace(shown, muted=muted))


def duplicate_demonstration(document: Document, index: int) -> Document:
    """Append a copy of a demonstration, to be corrected into a variant."""
    shown = at(document.demonstrations, index, "demonstration")
    copy = replace(shown.demonstration, name=f"{shown.demonstration.name} (copy)")
    return replace(document, demonstrations=(*document.demonstrations, Shown(copy)))


def delete_demonstration(document: Document, index: int) -> Document:
    """Take a demonstration out of the list."""
    at(document.demonstrations, index, "demonstration")
    return replace(document, demonstrations=without(document.demonstrations, index))


def trim_demonstration(document: Document, index: int, start: float, stop: float) -> Document:
    """Keep the part of a demonstration between two times of its own clock [s]."""
    shown = at(document.demonstrations, index, "demonstration")
    d = shown.demonstration
    keep = (d.times >= start - 1e-9) & (d.times <= stop + 1e-9)
    if bool(np.all(keep)):
        return document
    if np.count_nonzero(keep) < 2:
        raise EditError(
            f"Nothing would be left of {d.name} between {start:.1f} s and {stop:.1f} s. Keep a longer part."
        )
    part = Demonstration(
        times=d.times[keep] - d.times[keep][0],
        positions=d.positions[keep],
        orientations=None if d.orientations is None else d.orientations[keep],
        gripper=None if d.gripper is None else d.gripper[keep],
        name=d.name,
    )
    return _with_shown(document, index, replace(shown, demonstration=part))


def add_start(document: Document, position: FloatArray) -> Document:
    """Add a place from which the skill is reproduced."""
    if len(document.starts) >= 12:
        raise EditError("There are twelve starts already. Remove one before you add another.")
    return replace(document, starts=(*document.starts, point(position)))


def move_start(document: Document, index: int, position: FloatArray) -> Document:
    """Reproduce from somewhere else; moving the start that every skill has makes it one's own."""
    moved = point(position)
    if not document.starts and index == 0:
        return replace(document, starts=(moved,))
    former = at(document.starts, index, "start")
    if np.array_equal(moved, former):
        return document
    starts = (*document.starts[:index], moved, *document.starts[index + 1 :])
    return replace(document, starts=starts)


def remove_start(document: Document, index: int) -> Document:
    """Take a start, and its reproduction, away."""
    at(document.starts, index, "start")
    return replace(document, starts=without(document.starts, index))


def add_rule(document: Document, constraint: Constraint, name: str = "") -> Document:
    """Keep a correction of a reproduction as a rule."""
    number = next_number("Rule", [rule.name for rule in document.rules])
    rule = Rule(constraint, name or f"Rule {number}")
    return replace(document, rules=(*document.rules, rule))


def enable_rule(document: Document, index: int, enabled: bool) -> Document:
    """Switch a rule on or off."""
    rule = at(document.rules, index, "rule")
    if rule.enabled == enabled:
        return document
    rules = (*document.rules[:index], replace(rule, enabled=enabled), *document.rules[index + 1 :])
    return replace(document, rules=rules)


def rename_rule(document: Document, index: int, name: str) -> Document:
    """Change a rule's name."""
    rule = at(document.rules, index, "rule")
    name = name_from(name)
    if not name or name == rule.name:
        return document
    rules = (*document.rules[:index], replace(rule, name=name), *document.rules[index + 1 :])
    return replace(document, rules=rules)


def delete_rule(document: Document, index: int) -> Document:
    """Forget a rule."""
    at(document.rules, index, "rule")
    return replace(document, rules=without(document.rules, index))


def _with_settings(document: Document, **changes: Any) -> Document:
    settings = replace(document.settings, **changes)
    return document if settings == document.settings else replace(document, settings=settings)


def _with_shown(document: Document, index: int, shown: Shown) -> Document:
    before, after = document.demonstrations[:index], document.demonstrations[index + 1 :]
    return replace(document, demonstrations=(*before, shown, *after))
