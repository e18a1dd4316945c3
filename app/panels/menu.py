"""A menu of things that come and go, and a question before something is lost."""

from collections.abc import Callable, Sequence
from typing import Any, Final, Generic, TypeVar

import viser

from app.binding import assign, on_choice
from app.panels import words

T = TypeVar("T")

NO: Final = "No"


class Menu(Generic[T]):
    """Offers things by name; equal names are numbered.

    What a person chose stays chosen, under whatever name, as long as it is offered; until then the
    likeliest thing is.

    Parameters
    ----------
    key : callable, optional
        What makes two things one and the same; without it they are compared themselves.
    nothing : str
        Shown where nothing is likely and nobody has chosen; empty: the first thing is likely.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        label: str,
        hint: str,
        *,
        key: Callable[[T], object] = lambda thing: thing,
        nothing: str = "",
        on_chosen: Callable[[], None] = lambda: None,
    ) -> None:
        self._named: dict[str, T] = {}
        self._key, self._nothing = key, nothing
        self._kept: object = None
        """Key of what is chosen."""
        self._widget = gui.add_dropdown(label, ("",), initial_value="", hint=hint, visible=False)

        async def changed(event: viser.GuiEvent[Any]) -> None:
            if event.client is None:
                return
            if event.target.value not in self._named:
                event.target.value = self._label()
            chosen = self.chosen
            self._kept = None if chosen is None else self._key(chosen)
            on_chosen()

        self._widget.on_update(changed)

    @property
    def chosen(self) -> T | None:
        """What is chosen; None when nothing is."""
        return self._named.get(self._widget.value)

    @property
    def name(self) -> str:
        """What it is called in the menu."""
        return self._widget.value

    def offer(self, things: Sequence[tuple[str, T]], likeliest: object = None, *, anew: bool = False) -> None:
        """Offer these.

        Parameters
        ----------
        things : sequence of (name, thing)
        likeliest : object
            Key of what is chosen unless something offered was before; None: the first.
        anew : bool
            What was chosen before does not count.
        """
        labels = distinct([name for name, _ in things])
        self._named = {label: thing for label, (_, thing) in zip(labels, things, strict=True)}
        keys = [self._key(thing) for thing in self._named.values()]
        if anew or self._kept not in keys:
            first = keys[0] if keys and not self._nothing else None
            self._kept = likeliest if likeliest in keys else first
        label = self._label()
        options = tuple(self._named) if label in self._named else (label, *self._named)
        assign(self._widget, options=options, visible=bool(self._named))
        assign(self._widget, value=label)  # viser takes the first one where the former has gone

    def _label(self) -> str:
        return next(
            (label for label, one in self._named.items() if self._key(one) == self._kept), self._nothing
        )


def distinct(names: Sequence[str]) -> list[str]:
    """Number equal names from the last one on: what comes before them later renames none of them."""
    used: dict[str, int] = {}
    labels: list[str] = []
    for name in reversed(names):
        label = name
        while label in used:
            used[name] += 1
            label = f"{name} ({used[name]})"
        used[label] = 1
        labels.append(label)
    return labels[::-1]


class Question:
    """Asks once more before something is lost."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._text = gui.add_html("", visible=False)
        self._answers = gui.add_button_group("", ("Yes", NO), visible=False)
        self._action: Callable[[], None] | None = None
        on_choice(self._answers, self._answered)

    def ask(self, question: str, yes: str, action: Callable[[], None]) -> None:
        """Show the question and do something if it is answered with ``yes``."""
        self._action = action
        assign(self._answers, options=(yes, NO), visible=True)
        assign(self._text, content=words.note(words.escape(question), color=words.AMBER), visible=True)

    def withdraw(self) -> None:
        """Ask no longer."""
        self._action = None
        assign(self._text, visible=False)
        assign(self._answers, visible=False)

    def _answered(self, place: int) -> None:
        action = self._action
        self.withdraw()
        if place == 0 and action is not None:
            action()
