"""All that a skill can be written as, by suffix: what each file is for, and what is in it."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

from app.arm.conditions import Conditions
from app.arm.protocol import Arm
from app.document import Document, View
from app.exports.joint_trajectory import as_json, as_yaml, joint_trajectory
from app.exports.skill_file import pack
from app.exports.snippet import snippet
from app.figures import skill_figure
from app.files import FORMATTERS, SUFFIX, UnknownFormatError, format_glb
from app.model import Model
from app.parcel import Parcel
from app.planning import plan_run
from app.store import Plan
from app.surroundings import conditions_of
from gc_core import Demonstration, GcError, GeneralizedCylinder

LONGEST_NAME: Final = 60
"""Of a file, without its suffix [letters]."""
FOR_A_REAL_ARM: Final = (
    "The played run as trajectory_msgs/JointTrajectory of ROS 2: six joints, 50 points a second, at rest at "
    "both ends, within the limits of speed. The fingers are not in it. Nothing here has moved a real arm: "
    "try it slowly, with a hand on the stop."
)
_LINES: Final = 12
_WIDTH: Final = 72
_TEXT: Final = (".csv", ".yaml", ".json", ".py")


class NothingToExportError(GcError):
    """A skill lacks what a file should hold."""


@dataclass(frozen=True, eq=False)
class Subject:
    """A skill to be written, and how to get what only an arm knows."""

    document: Document
    model: Model
    """Of ``document``."""
    make_arm: Callable[[], Arm]
    run: int = 0
    """The reproduction that is played, or given to an arm."""
    plan: Plan | None = None
    """What the arm makes of it, where it is known."""

    @property
    def demonstrations(self) -> list[Demonstration]:
        """All that was shown, also what is muted."""
        if not self.document.demonstrations:
            raise NothingToExportError(
                "Nothing was shown yet, so there is nothing to export. Show the motion first."
            )
        return [shown.demonstration for shown in self.document.demonstrations]

    @property
    def tube(self) -> GeneralizedCylinder:
        """The tube where the landmarks stand now."""
        if self.model.cylinder is None:
            why = self.model.problem or "Nothing was shown yet."
            raise NothingToExportError(f"There is no tube to export: {why}")
        return self.model.cylinder

    def planned(self, arm: Arm) -> Plan:
        """Give what an arm makes of the run."""
        if self.run >= len(self.model.runs):
            raise NothingToExportError("There is no run to export. Show the motion, and add a start in Try.")
        if self.plan is not None and self.plan.run == self.run:
            return self.plan
        around = Conditions(conditions_of(self.model, View()).obstacles)
        return plan_run(arm, self.model, self.run, around, arm.home)


@dataclass(frozen=True, eq=False)
class Format:
    """One kind of file."""

    label: str
    """In the list to choose from."""
    about: str
    """What it is for and what is in it; sentences."""
    make: Callable[[Subject], bytes]


def parcel(suffix: str, subject: Subject) -> Parcel:
    """Write a skill in a format.

    Parameters
    ----------
    suffix : str
        One of ``FORMATS``.
    subject : Subject

    Raises
    ------
    GcError
        If the suffix is another, or the skill has nothing to be written so.
    """
    chosen = format_of(f"skill{suffix}")
    content = chosen.make(subject)
    about = f"{summary(subject.document)} {chosen.about}"
    return Parcel(
        suffix, file_name(subject.document.title, suffix), content, about, _excerpt(suffix, content)
    )


def format_of(name: str) -> Format:
    """Find the format that a file's name asks for."""
    suffix = Path(name).suffix.lower()
    if suffix not in FORMATS:
        raise UnknownFormatError(name, suffix, tuple(FORMATS))
    return FORMATS[suffix]


def file_name(title: str, suffix: str) -> str:
    """Make a file's name of a skill's: letters, digits and hyphens, which no system minds."""
    plain = unicodedata.normalize("NFKD", title).encode("ascii", "ignore").decode().lower()
    stem = re.sub(r"[^a-z0-9]+", "-", plain).strip("-")[:LONGEST_NAME].strip("-")
    stem = stem or "skill"
    return f"{stem.replace('-', '_') if suffix == '.py' else stem}{suffix}"  # a program can be imported


def summary(document: Document) -> str:
    """Say in one line what a skill is made of."""
    counts = (
        (len(document.demonstrations), "demonstration"),
        (len(document.landmarks), "landmark"),
        (len(document.starts), "start"),
        (len(document.rules), "rule"),
        (len(document.things), "thing"),
    )
    parts = [f"{n} {noun}{'' if n == 1 else 's'}" for n, noun in counts if n]
    return f"{document.title}: {', '.join(parts) or 'nothing yet'}."


def _demonstrations_as(suffix: str) -> Callable[[Subject], bytes]:
    return lambda subject: FORMATTERS[suffix](subject.demonstrations)


def _trajectory_as(write: Callable[[dict[str, object]], bytes]) -> Callable[[Subject], bytes]:
    def make(subject: Subject) -> bytes:
        arm = subject.make_arm()
        try:
            return write(joint_trajectory(arm, subject.planned(arm)))
        finally:
            arm.close()

    return make


def _film(subject: Subject) -> bytes:
    from app.scene.film import film  # noqa: PLC0415 - viser, which no other format needs

    arm = subject.make_arm()
    try:
        plan = subject.planned(arm) if subject.model.runs else None
        return film(arm, subject.model, plan).encode()
    finally:
        arm.close()


def _figure_as(form: Literal["svg", "png"]) -> Callable[[Subject], bytes]:
    return lambda subject: skill_figure(
        subject.tube,
        [demonstration.positions for demonstration in subject.model.demonstrations],
        [run.reproduction.positions for run in subject.model.runs],
        things=subject.document.things,
        title=subject.document.title,
        form=form,
    )


def _excerpt(suffix: str, content: bytes) -> str:
    if suffix not in _TEXT:
        return ""
    # A line of data is long; of all lines only the first are looked at.
    lines = content[: 64 * 2**10].decode(errors="ignore").splitlines()
    shown = [line if len(line) <= _WIDTH else f"{line[: _WIDTH - 1]}…" for line in lines[:_LINES]]
    return "\n".join([*shown, *(["…"] if len(lines) > _LINES else [])])


FORMATS: Final[Mapping[str, Format]] = {
    SUFFIX: Format(
        "Skill file, to keep or send",
        "All of the skill in one file. Open it here, or on another computer, with Add a recording… in Teach.",
        lambda subject: pack(subject.document),
    ),
    ".html": Format(
        "Replay, a page that plays by itself",
        "The arm plays the run, with the tube and the demonstrations. It opens in any browser, without "
        "gc-teach and without a network.",
        _film,
    ),
    ".csv": Format(
        "Demonstrations as a table",
        "One sample a line: time [s], place [m]; turn of the tool and gripper where they were recorded.",
        _demonstrations_as(".csv"),
    ),
    ".mat": Format(
        "Demonstrations for MATLAB",
        "Cells smoothData (T x 3, metres), as in the TLGC data, with times, turns and gripper beside them.",
        _demonstrations_as(".mat"),
    ),
    ".npz": Format(
        "Demonstrations for NumPy",
        "Arrays positions [m], times [s] and lengths; orientations and gripper where recorded.",
        _demonstrations_as(".npz"),
    ),
    ".h5": Format(
        "Demonstrations as HDF5",
        "One group a demonstration, laid out as in the canal-surface lab's recordings.",
        _demonstrations_as(".h5"),
    ),
    ".yaml": Format(
        "Run for a real Jaco",
        FOR_A_REAL_ARM,
        _trajectory_as(as_yaml),
    ),
    ".json": Format(
        "Run for a real Jaco",
        FOR_A_REAL_ARM,
        _trajectory_as(as_json),
    ),
    ".glb": Format(
        "Tube as a 3-D shape",
        "The closed surface of the tube (generalized cylinder) in metres, for 3-D programs.",
        lambda subject: format_glb(subject.tube),
    ),
    ".svg": Format(
        "Figure for a paper",
        "Tube, demonstrations, middle line and runs in the paper's colours, as lines that can be edited.",
        _figure_as("svg"),
    ),
    ".png": Format(
        "Figure for a paper",
        "Tube, demonstrations, middle line and runs in the paper's colours, as a picture.",
        _figure_as("png"),
    ),
    ".py": Format(
        "Python program",
        "It holds the skill, and opens it again where gc-teach is installed: demonstrations, tube and runs.",
        lambda subject: snippet(subject.document, Path(file_name(subject.document.title, ".py")).stem),
    ),
}
"""By suffix, in the order of the list to choose from."""
