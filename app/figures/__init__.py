"""Figures for paper: those of the paper, and one of any skill. Matplotlib is imported when one is made."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from contextlib import contextmanager
from importlib import import_module
from threading import Lock
from typing import TYPE_CHECKING, Any, Final

from app.arm.shapes import Shape
from app.document import FloatArray
from app.figures.errors import FigureError, NoMatplotlibError
from gc_core import GeneralizedCylinder

if TYPE_CHECKING:
    from app.figures.sheet import Form

_ONE_AT_A_TIME: Final = Lock()
"""Matplotlib's style belongs to the process, and skills are exported by several threads."""

__all__ = ("FigureError", "NoMatplotlibError", "skill_figure")


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
