"""Files in and out: the suffix chooses the format, here and nowhere else."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final, Literal, TypeAlias

from app.files.csv_format import format_csv, parse_csv
from app.files.errors import FileError, NoFileError, TooLargeError, UnknownFormatError, UnreadableError
from app.files.hdf5_format import format_hdf5, parse_hdf5
from app.files.mat_format import format_mat, parse_mat
from app.files.npy_format import format_npz, parse_npy, parse_npz
from app.files.reading import Reading, describe
from app.files.recording import Contents, Unit, checked
from app.files.skill_format import parse_skill
from app.files.units import Frame
from gc_core import Demonstration

LARGEST_FILE: Final = 64 * 2**20
"""[bytes]; checked before a file is opened."""

Parser: TypeAlias = Callable[[str, bytes], Contents]
Formatter: TypeAlias = Callable[[Sequence[Demonstration]], bytes]

PARSERS: Final[Mapping[str, Parser]] = {
    ".mat": parse_mat,
    ".csv": parse_csv,
    ".npy": parse_npy,
    ".npz": parse_npz,
    ".h5": parse_hdf5,
    ".hdf5": parse_hdf5,
    ".gcteach": parse_skill,
}
FORMATTERS: Final[Mapping[str, Formatter]] = {
    ".csv": format_csv,
    ".npz": format_npz,
    ".mat": format_mat,
    ".h5": format_hdf5,
    ".hdf5": format_hdf5,
}


def inspect(path: str | Path) -> Reading:
    """Read a file and say what is in it, in the file's own unit.

    Raises
    ------
    FileError
        If it is missing, a folder, of no known kind, larger than
        ``LARGEST_FILE``, or holds something that is no demonstration.
    """
    path = Path(path)
    if path.is_dir():
        raise NoFileError(path.name, f"{path} is a folder. Choose one of the files in it.")
    _known(path.name, PARSERS, "read")
    return inspect_bytes(path.name, content_of(path))


def inspect_bytes(name: str, content: bytes) -> Reading:
    """Say what is in an uploaded file; as `inspect`."""
    name = Path(name).name
    suffix = _known(name, PARSERS, "read")
    _check_size(name, len(content))
    if not content.strip():
        raise UnreadableError(name, "it is empty", "Record the motion again, or choose another file.")
    contents = PARSERS[suffix](name, content)
    found = checked(name, contents.recordings)
    timed = all(recording.times is not None for recording in contents.recordings)
    return describe(name, found, contents.unit, timed)


def read(
    path: str | Path, *, units: Literal["auto"] | Unit = "auto", frame: Frame = "as recorded"
) -> list[Demonstration]:
    """Read the demonstrations of a file.

    Parameters
    ----------
    path : str or Path
        A ``.mat``, ``.csv``, ``.npy``, ``.npz``, ``.h5``, ``.hdf5`` or ``.gcteach`` file.
    units : {"auto", "m", "cm", "mm"}
        The file's unit of length; "auto" guesses, as `inspect` shows.
    frame : {"as recorded", "moved in front of the arm"}
        The second is for data of other robots; see `app.files.units.converted`.

    Returns
    -------
    list of Demonstration
        In metres.

    Raises
    ------
    FileError
        As `inspect`.
    """
    return inspect(path).accepted(None if units == "auto" else units, frame)


def write(path: str | Path, demonstrations: Sequence[Demonstration]) -> None:
    """Write demonstrations [m] so that `read` gives them back, whatever the suffix in ``FORMATTERS``.

    Raises
    ------
    FileError
        If the suffix is another, there is nothing to write, or the file cannot be written.
    """
    path = Path(path)
    suffix = _known(path.name, FORMATTERS, "written")
    if not demonstrations:
        raise FileError(path.name, f"There is nothing to write to {path.name}. Show the motion first.")
    put(path, FORMATTERS[suffix](demonstrations))


def put(path: Path, content: bytes) -> None:
    """Write a file.

    Raises
    ------
    FileError
        If it cannot be written.
    """
    try:
        path.write_bytes(content)
    except OSError as error:
        raise FileError(
            path.name, f"{path} cannot be written: {error.strerror}. Choose another folder."
        ) from error


def _known(name: str, registry: Mapping[str, object], done: Literal["read", "written"]) -> str:
    suffix = Path(name).suffix.lower()
    if suffix not in registry:
        raise UnknownFormatError(name, suffix, tuple(registry), done)
    return suffix


def _check_size(name: str, size: int) -> None:
    if size > LARGEST_FILE:
        raise TooLargeError(name, "has", size, LARGEST_FILE, unit="bytes")


def content_of(path: Path) -> bytes:
    """Read a file that is not too large.

    Raises
    ------
    FileError
        If it is missing, larger than ``LARGEST_FILE``, or may not be read.
    """
    try:
        if not path.is_file():
            raise NoFileError(path.name, f"There is no file {path}. Check the name and the folder.")
        _check_size(path.name, path.stat().st_size)
        return path.read_bytes()
    except OSError as error:
        raise NoFileError(
            path.name, f"{path} cannot be opened: {error.strerror}. Check who may read it."
        ) from error
