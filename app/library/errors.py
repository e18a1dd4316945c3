"""What can go wrong with saved skills; each message says what, where and what to do."""

from __future__ import annotations

from typing import Any, cast

from gc_core import GcError


class LibraryError(GcError):
    """The library cannot be opened, read or written."""


def cause_of(error: BaseException) -> str:
    """Say in one line why a database did not do something, in the words of whoever refused."""
    cause = getattr(error, "orig", None) or error
    cause = cause.__cause__ or cause  # of "no connection": why there is none
    first: Any = cause.args[0] if cause.args else ""
    if isinstance(first, dict):  # PostgreSQL's own answer, by letters
        first = cast("dict[str, str]", first).get("M", "")
    said = getattr(cause, "strerror", None) or str(first) or type(cause).__name__
    return said.splitlines()[0].strip().rstrip(".")


class ForeignDatabaseError(LibraryError):
    """The address leads to something that is no library of this version; it was not changed."""

    def __init__(self, where: str, problem: str) -> None:
        super().__init__(
            f"{where} {problem}; it was left as it is. Choose another place with --library, "
            "for instance sqlite:///my-skills.db."
        )
        self.where = where


class UnreadableSkillError(LibraryError):
    """A saved skill is not in a form that this version understands."""

    def __init__(self, problem: str) -> None:
        super().__init__(
            f"This skill cannot be opened: {problem}. It was probably saved by a newer version of gc-teach; "
            "update gc-teach and open it again."
        )
        self.problem = problem


class BadCodeError(LibraryError):
    """A skill's code is empty, too long, or holds characters that do not fit into an address."""

    def __init__(self, code: str) -> None:
        super().__init__(
            f"{code[:80]!r} is no code of a skill. Use 1 to 64 letters, digits, hyphens and underscores."
        )
        self.code = code
