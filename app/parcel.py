"""A file that a person takes along: being made, ready, or not to be had."""

from dataclasses import dataclass


@dataclass(frozen=True, eq=False)
class Parcel:
    """What was asked for, and what came of it."""

    suffix: str
    """Of the format, for instance ``.csv``."""
    name: str = ""
    """Of the file; empty while it is being made."""
    content: bytes = b""
    about: str = ""
    """What is in it, in sentences."""
    excerpt: str = ""
    """Its first lines, where it is text."""
    problem: str = ""
    """Why it cannot be made; empty: nothing is wrong."""

    @property
    def ready(self) -> bool:
        """Whether it can be taken."""
        return bool(self.name)
