"""``gc-teach figure``: the figures of the paper, as files."""

from __future__ import annotations

import json as json_text
from pathlib import Path
from typing import Annotated, Final

import tyro

from app.commands import Place, Units
from app.figures import FIGURES, Form, NoSuchFigureError, paper_figure
from app.files import FileError, UnknownFormatError
from app.opening import opened

FORMS: Final[tuple[Form, ...]] = ("svg", "png")


def figure(
    name: Annotated[tyro.conf.Positional[str], tyro.conf.arg(metavar="[NUMBER]", help_behavior_hint="")] = "",
    file: Annotated[
        tyro.conf.Positional[Path | None], tyro.conf.arg(metavar="[PATH]", help_behavior_hint="")
    ] = None,
    *,
    out: Place = None,
    units: Units = "auto",
    json: bool = False,
) -> None:
    """Make one of the paper's figures, of the built-in skills or of a file's demonstrations.

    Args:
        name: Number of the figure; without one, say what each shows.
        file: Recordings (.mat .csv .npy .npz .h5 .hdf5), or the name of a built-in skill.
        out: A file (.svg or .png), or a folder for both; by default the folder one is in.
        units: The file's unit of length.
        json: Print one JSON value instead of words.
    """
    if not name:
        print(_listed(json=json), flush=True)
        return
    if name not in FIGURES:
        raise NoSuchFigureError(name, tuple(FIGURES))
    paths = _paths(name, out)
    document = None if file is None else opened(file, None if units == "auto" else units)
    made = paper_figure(name, document, tuple(paths))
    for form, path in paths.items():
        _write(path, made[form])
    about = FIGURES[name].about if document is None else FIGURES[name].of(document.title)
    files = [str(path) for path in paths.values()]
    facts = {"figure": name, "about": about, "files": files}
    print(json_text.dumps(facts) if json else f"{about} Written to {' and '.join(files)}.", flush=True)


def _listed(*, json: bool) -> str:
    if json:
        return json_text.dumps([{"figure": name, "about": each.about} for name, each in FIGURES.items()])
    return "\n".join(f"{name:>3}  {each.about}" for name, each in FIGURES.items())


def _paths(name: str, out: Path | None) -> dict[Form, Path]:
    """Where each kind of file goes."""
    if out is None or out.is_dir() or not out.suffix:
        return {form: (out or Path()) / f"figure-{name}.{form}" for form in FORMS}
    for form in FORMS:
        if out.suffix.lower() == f".{form}":
            return {form: out}
    raise UnknownFormatError(out.name, out.suffix.lower(), [f".{form}" for form in FORMS])


def _write(path: Path, content: bytes) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    except OSError as error:
        raise FileError(
            path.name, f"{path} cannot be written: {error.strerror}. Choose another folder."
        ) from error
