"""The same skill in every kind of cross-section: which kind suits is then seen, not guessed.

Made in a worker when a document is at rest. Choosing a kind changes none of it, so that
what was made stays until something is shown, muted, corrected or moved.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final

from app.document import SECTION_KINDS, SectionKind
from app.model import Model, encode_as
from app.tube_svg import cut_of, projection_of, slice_svg, tube_svg
from gc_core import GcError, GeneralizedCylinder, encode, generalize

TIGHTEST: Final = "hull"
"""The kind with the least room: the convex hull of what was shown."""


@dataclass(frozen=True)
class Picture:
    """The skill with one kind of cross-section."""

    tube: str
    """An ``<svg>`` element; those of one `Shapes` have one scale."""
    widest: str
    """Its widest slice, likewise; the same slice for all kinds."""
    volume: float
    """[m^3]."""


@dataclass(frozen=True, eq=False)
class Shapes:
    """One skill as a cylinder of each kind, where its landmarks stand now."""

    source: Model
    """What they were made for."""
    pictures: Mapping[SectionKind, Picture]
    """A kind that cannot be made of these demonstrations is not among them."""
    least: float
    """Volume of the tightest tube round what was shown [m^3]."""


def same_but_for_section(one: Model, other: Model) -> bool:
    """Whether two models differ at most in the kind of their cross-sections, starts and rules."""
    settings = replace(one.source.settings, section=other.source.settings.section)
    return (
        settings == other.source.settings
        and len(one.demonstrations) == len(other.demonstrations)
        and all(a is b for a, b in zip(one.demonstrations, other.demonstrations, strict=True))
        and one.registration is other.registration
    )


def shapes_of(model: Model) -> Shapes:
    """Encode and draw what a model was learned from once for each kind of cross-section.

    Raises
    ------
    GcError
        If not even the tightest tube can be made.
    """
    settings = model.source.settings
    tightest = encode(
        model.demonstrations,
        section=TIGHTEST,
        stations=settings.stations,
        align_by=settings.align_by,
    )
    made = _cylinders(model)
    view, cut = projection_of(tuple(made.values())), cut_of(tuple(made.values()))
    pictures: dict[SectionKind, Picture] = {
        kind: Picture(tube_svg(cylinder, view), slice_svg(cylinder, cut), cylinder.volume)
        for kind, cylinder in made.items()
    }
    return Shapes(model, MappingProxyType(pictures), _moved(model, tightest).volume)


def _cylinders(model: Model) -> dict[SectionKind, GeneralizedCylinder]:
    """The model's own, and those of the other kinds."""
    settings = model.source.settings
    made: dict[SectionKind, GeneralizedCylinder] = {}
    for kind in SECTION_KINDS:
        if kind == settings.section and model.cylinder is not None:
            made[kind] = model.cylinder
            continue
        try:
            made[kind] = _moved(model, encode_as(model.demonstrations, replace(settings, section=kind)))
        except GcError:  # choosing this kind says why
            continue
    return made


def _moved(model: Model, cylinder: GeneralizedCylinder) -> GeneralizedCylinder:
    return cylinder if model.registration is None else generalize(cylinder, model.registration)
