"""The paper's computed figures: what each shows, of which built-in skills, and which module draws it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

Form: TypeAlias = Literal["svg", "png"]
"""Kinds of file."""


@dataclass(frozen=True)
class Entry:
    """One figure of the paper."""

    about: str
    """What it shows, in a sentence."""
    skills: tuple[str, ...]
    """Built-in skills of which it is made, unless a file is given."""
    module: str
    """In `app.figures`."""
    function: str = "draw"
    """Makes a sheet of a tuple of subjects."""
    of_a_file: str = ""
    """What it shows of a file, where `about` is told of the built-in skills alone."""

    def of(self, title: str) -> str:
        """Say what it shows of one skill."""
        return f"{self.of_a_file or self.about} Drawn of {title!r}."


FIGURES: Final[Mapping[str, Entry]] = {
    "2": Entry(
        "What a generalized cylinder is: directrix, cross-sections, and frames T, N, B that do not twist.",
        ("needle",),
        "anatomy",
    ),
    "4": Entry("The steps from demonstrations to the cylinder.", ("reaching",), "encoding"),
    "5": Entry("How a new run is made: the ratio rule in two cross-sections.", ("reaching",), "ratio"),
    "6": Entry(
        "Reaching from above with three kinds of cross-section.",
        ("reaching",),
        "kinds",
        of_a_file="One motion with three kinds of cross-section.",
    ),
    "7": Entry(
        "Three new goals and four new starts, nothing shown again.",
        ("curved_reach_and_place", "pick_and_place"),
        "moving",
    ),
    "8": Entry(
        "Four skills with new runs; of a file, its skill.",
        ("needle", "curved_reach_and_place", "around_an_obstacle", "pick_and_place"),
        "skills",
        of_a_file="A skill with new runs.",
    ),
    "9": Entry("Five starts beside DMP and GMM/GMR.", ("around_an_obstacle",), "comparing"),
    "10": Entry("A demonstration is corrected and the skill learned again.", ("the_dip",), "refining"),
    "11": Entry("A run is corrected: the refinement matrix.", ("the_lid",), "constraint", "draw_matrix"),
    "12": Entry("Later runs obey the correction.", ("the_lid",), "constraint", "draw_obeying"),
}
