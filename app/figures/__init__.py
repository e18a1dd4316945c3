"""Figures for paper: those of the paper, and one of any skill. Matplotlib is imported when one is made."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from contextlib import contextmanager
from importlib import import_module
from threading import Lock
from typing import Any, Final

from app.arm.shapes import Shape
from app.document import Document, FloatArray
from app.figures.catalogue import FIGURES, Form
from app.figures.errors import FigureError, NoMatplotlibError, NoSuchFigureError, NothingToDrawError
from app.figures.subject import Subject
from app.resources import static_folder
from app.skills import load_skill
from gc_core import GeneralizedCylinder

_ONE_AT_A_TIME: Final = Lock()
"""Matplotlib's style belongs to the process, and skills are exported by several threads."""

__all__ = (
    "FIGURES",
    "FigureError",
    "Form",
    "NoMatplotlibError",
    "NoSuchFigureError",
    "NothingToDrawError",
    "paper_figure",
    "skill_figure",
)


def paper_figure(
    name: str, document: Document | None = None, forms: Sequence[Form] = ("svg", "png")
) -> dict[Form, bytes]:
    """Make a figure of the paper.

    Parameters
    ----------
    name : str
        One of `FIGURES`.
    document : Document, optional
        The skill that it is made of; the built-in ones of the figure unless given.
    forms : sequence of "svg", "png"
        Kinds of file.

    Returns
    -------
    dict
        The bytes of each kind; the same for the same skill.

    Raises
    ------
    FigureError
        If there is no such figure, nothing was shown, or the library that draws is not installed.
    GcError
        If the skill cannot be learned.
    """
    if name not in FIGURES:
        raise NoSuchFigureError(name, tuple(FIGURES))
    entry = FIGURES[name]
    with _drawing() as sheet:
        if document is None:
            documents = [load_skill(static_folder() / "skills", skill) for skill in entry.skills]
        else:
            documents = [document]
        draw = getattr(import_module(f"app.figures.{entry.module}"), entry.function)
        figure = draw(tuple(map(Subject, documents)))
        return {form: sheet.saved(figure, form) for form in forms}


def skill_figure(
    cylinder: GeneralizedCylinder,
    demonstrations: Sequence[FloatArray] = (),
    runs: Sequence[FloatArray] = (),
    *,
    things: Sequence[Shape] = (),
    title: str = "",
    form: Form = "svg",
) -> bytes:
    """Draw a skill in the paper's style and colours.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
        The tube, where it is now.
    demonstrations, runs : sequences of (K, 3) arrays
        What was shown, and reproductions [m].
    things : sequence of Shape
        What stands around.
    title : str
        Written above.
    form : "svg" or "png"
        Kind of file.

    Returns
    -------
    bytes
        The file; the same for the same skill.

    Raises
    ------
    NoMatplotlibError
        If the library that draws is not installed.
    """
    with _drawing() as sheet:
        figure = import_module("app.figures.skill").draw(cylinder, demonstrations, runs, things, title)
        return sheet.saved(figure, form)


@contextmanager
def _drawing() -> Generator[Any]:
    """Give the module that draws, with the style of all figures in force."""
    try:
        sheet: Any = import_module("app.figures.sheet")
    except ImportError as error:
        raise NoMatplotlibError from error
    with _ONE_AT_A_TIME, sheet.styled():
        yield sheet
