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
from app.files.registry import FORMATTERS, LARGEST_FILE, PARSERS, inspect, inspect_bytes, read, write
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
    "inspect",
    "inspect_bytes",
    "read",
    "write",
]
