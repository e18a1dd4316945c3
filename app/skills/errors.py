"""What can be wrong with a built-in skill; each message says what, where and what to do."""

from __future__ import annotations

from collections.abc import Sequence

from gc_core import GcError


class SkillError(GcError):
    """A built-in skill cannot be opened."""


class NoSuchSkillError(SkillError):
    """There is no built-in skill of this name."""

    def __init__(self, name: str, known: Sequence[str]) -> None:
        super().__init__(
            f"There is no built-in skill called {name[:80]!r}. Choose one of: {', '.join(known) or 'none'}."
        )
        self.name = name
        self.known = tuple(known)


class DamagedSkillError(SkillError):
    """A built-in skill's files do not belong together."""

    def __init__(self, name: str, problem: str) -> None:
        super().__init__(
            f"The built-in skill {name} is damaged: {problem}. Install gc-teach again, or write it anew with "
            "python -m app.skills."
        )
        self.name = name
        self.problem = problem
