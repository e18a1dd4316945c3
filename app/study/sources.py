"""The data of a study: built-in skills and recordings, each known by its content."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

from app.files import PARSERS, read
from app.resources import static_folder
from app.skills import load_skill, skill_names
from app.study.errors import BadSpecError
from app.study.spec import Choice, Spec
from gc_core import Demonstration


@dataclass(frozen=True)
class DataSet:
    """Demonstrations of one skill. Two are the same when their content is."""

    name: str
    digest: str
    """Of all times and places, as they were read."""
    demonstrations: tuple[Demonstration, ...] = field(compare=False, repr=False)


def data_set(name: str, demonstrations: Sequence[Demonstration]) -> DataSet:
    """Name demonstrations and take their digest."""
    content = sha256()
    for each in demonstrations:
        for values in (each.times, each.positions):
            content.update(f"{values.shape}".encode())
            content.update(values.tobytes())
    return DataSet(name, content.hexdigest(), tuple(demonstrations))


def open_data(spec: Spec) -> tuple[DataSet, ...]:
    """Read all that a study names.

    Returns
    -------
    tuple of DataSet
        Sorted by name.

    Raises
    ------
    BadSpecError
        If a pattern fits no file, or two data sets have one name.
    GcError
        If a file cannot be read.
    """
    found: dict[str, DataSet] = {}
    for choice in spec.data_sets:
        for each in _opened(choice, spec):
            if each.name in found:
                raise BadSpecError(
                    spec.file, f"two data sets are called {each.name!r}. Leave one out, or give it a name."
                )
            found[each.name] = each
    return tuple(found[name] for name in sorted(found))


def _opened(choice: Choice, spec: Spec) -> Iterator[DataSet]:
    skills = static_folder() / "skills"
    names = skill_names(skills)
    if choice.name is None and choice.files in names:
        shown = load_skill(skills, choice.files).demonstrations
        yield data_set(choice.files, [each.demonstration for each in shown if not each.muted])
        return
    try:
        files = _files(choice.files, spec.data)
    except (IndexError, ValueError) as error:  # pathlib's, of a pattern that is none
        raise BadSpecError(
            spec.file, f"{choice.files!r} is no pattern of files. Give one such as '*.csv' or '**/*.csv'."
        ) from error
    if not files:
        raise BadSpecError(
            spec.file,
            f"{choice.files!r} is no built-in skill ({', '.join(names)}), and no recording in "
            f"{spec.data.resolve()} is called so. Check the pattern, or say with --data where the data are.",
        )
    if choice.name is None:
        yield from (data_set(path.stem, read(path)) for path in files)
    else:
        yield data_set(choice.name, [each for path in files for each in read(path)])


def _files(pattern: str, folder: Path) -> list[Path]:
    """Recordings that a pattern fits, sorted."""
    if Path(pattern).is_absolute():
        folder, pattern = Path(Path(pattern).anchor), str(Path(pattern).relative_to(Path(pattern).anchor))
    found = folder.glob(pattern) if folder.is_dir() and pattern else ()
    return sorted(path for path in found if path.is_file() and path.suffix.lower() in PARSERS)
