"""Reading and writing files of demonstrations; the suffix chooses the format."""

from app.files.errors import (
    BadValueError,
    FileError,
    NoFileError,
    PickledError,
    TooLargeError,
    UnknownFormatError,
    UnreadableError,
)
from app.files.reading import Reading
from app.files.recording import MOST_DEMONSTRATIONS, MOST_SAMPLES, Unit
from app.files.registry import (
    FORMATTERS,
    LARGEST_FILE,
    PARSERS,
    content_of,
    inspect,
    inspect_bytes,
    put,
    read,
    write,
)
from app.files.skill_format import SUFFIX, format_skill, open_skill
from app.files.tube_format import format_glb, format_tube, tube_mesh
from app.files.units import FRAMES, IN_FRONT, METRES, Frame

__all__ = [
    "FORMATTERS",
    "FRAMES",
    "IN_FRONT",
    "LARGEST_FILE",
    "METRES",
    "MOST_DEMONSTRATIONS",
    "MOST_SAMPLES",
    "PARSERS",
    "SUFFIX",
    "BadValueError",
    "FileError",
    "Frame",
    "NoFileError",
    "PickledError",
    "Reading",
    "TooLargeError",
    "Unit",
    "UnknownFormatError",
    "UnreadableError",
    "content_of",
    "format_glb",
    "format_skill",
    "format_tube",
    "inspect",
    "inspect_bytes",
    "open_skill",
    "put",
    "read",
    "tube_mesh",
    "write",
]
