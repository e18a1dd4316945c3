"""What a command is given: a recording, or the name of a built-in skill."""

from __future__ import annotations

from pathlib import Path

from app.document import Document
from app.edits import skill_of
from app.files import Unit, inspect
from app.resources import static_folder
from app.skills import load_skill


def opened(file: Path, unit: Unit | None = None) -> Document:
    """Open a recording, or a built-in skill by its name.

    Parameters
    ----------
    file : Path
        Where no file is and the name has no suffix, a built-in skill.
    unit : str, optional
        Of the file's lengths; found from the numbers unless given.

    Raises
    ------
    GcError
        If there is neither, or it cannot be read.
    """
    if not file.suffix and not file.exists():
        return load_skill(static_folder() / "skills", str(file))
    reading = inspect(file)
    return skill_of(file.stem, reading.accepted(unit or reading.unit, "as recorded"))
