"""What can go wrong with figures; each message says what, and what to do."""

from __future__ import annotations

from collections.abc import Sequence

from gc_core import GcError


class FigureError(GcError):
    """A figure cannot be made."""


class NoMatplotlibError(FigureError):
    """The library that draws is not installed."""

    def __init__(self) -> None:
        super().__init__(
            "Figures are drawn by the package matplotlib, which is missing. Install it with: "
            'pip install "gc-teach[study]"'
        )


class NoSuchFigureError(FigureError):
    """There is no figure of this name."""

    def __init__(self, name: str, known: Sequence[str]) -> None:
        super().__init__(
            f"There is no figure called {name[:40]!r}. Choose one of: {', '.join(known)}. "
            "`gc-teach figure` alone says what each shows."
        )
        self.name = name
        self.known = tuple(known)


class NothingToDrawError(FigureError):
    """A skill lacks what a figure shows."""

    def __init__(self, title: str, reason: str) -> None:
        super().__init__(f"There is no figure of {title[:80]!r}: {reason}")
        self.title = title
