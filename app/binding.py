"""Widgets and the truth: what a widget shows is read from the `State`, what a person does is posted.

Three rules keep the two apart. An assignment by this program also calls viser's callbacks,
but without a client, and is ignored. viser checks nothing that a browser sends, so every value
is checked here, and one that makes no sense is dropped. Callbacks are coroutines on viser's
event loop and only post.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, Generic, Protocol, TypeVar

import viser

from app.store import State

T = TypeVar("T")
R = TypeVar("R", bound="Row")

QUIET: Final = (96, 104, 116)
STRONG: Final = (31, 63, 168)
"""Colours of buttons: white text keeps 4.5:1 on both, in the light and in the dark theme."""
MOST_PENDING: Final = 64
"""Values of one widget that can be under way to the session at once."""


class Widget(Protocol):
    """An input with a value: slider, checkbox, dropdown, text, numbers."""

    @property
    def value(self) -> Any:
        """What it shows, as far as the server knows."""
        ...

    @value.setter
    def value(self, value: Any) -> None: ...

    def on_update(self, func: Callable[..., Any]) -> Any:
        """Call a coroutine function after every change."""
        ...


class Binding(Generic[T]):
    """Ties one widget to one value of the `State`.

    Parameters
    ----------
    widget : Widget
        Any viser input.
    read : callable
        The truth: what the widget must show.
    write : callable
        Posts what a person set; called only with values that `accept` allows.
    accept : callable
        Whether a value from a browser makes sense.
    typed : bool
        For fields that are changed many times in a row (letters, digits, slider steps): while
        newer values are on their way to the session, an older one does not overwrite them, and a
        value that is not acceptable yet (an empty name) stays until the truth changes.
    """

    def __init__(
        self,
        widget: Widget,
        *,
        read: Callable[[State], T],
        write: Callable[[T], None],
        accept: Callable[[T], bool],
        typed: bool = False,
    ) -> None:
        self._widget, self._read, self._write, self._accept = widget, read, write, accept
        self._typed = typed
        self._pending: tuple[Any, ...] = ()
        self._truth: Any = None

        async def changed(event: viser.GuiEvent[Any]) -> None:
            if event.client is not None:
                self._take(event.target.value)

        widget.on_update(changed)

    def draw(self, state: State) -> None:
        """Show the truth, if the widget does not show it already."""
        truth, former = self._read(state), self._truth
        self._truth = truth
        if self._widget.value == truth:
            self._pending = ()
            return
        if self._typed and self._waits(truth, former):
            return
        self._pending = ()
        self._widget.value = truth

    def _take(self, value: T) -> None:
        if self._accept(value):
            if self._typed:
                self._pending = (*self._pending[-MOST_PENDING:], _settled(value))
            self._write(value)
        elif not _waitable(value):
            self._pending = ()

    def _waits(self, truth: T, former: Any) -> bool:
        """Whether the person's own, newer value should stay."""
        if _waitable(self._widget.value):
            return truth == former
        pending = self._pending
        if truth in pending:
            pending = pending[len(pending) - 1 - pending[::-1].index(truth) :]
            self._pending = pending
            return len(pending) > 1 or _settled(self._widget.value) == truth
        return truth == former and bool(pending)


def name_field(
    gui: viser.GuiApi, label: str, read: Callable[[State], str], write: Callable[[str], None]
) -> Binding[str]:
    """Add a text field for a name, which is never empty."""
    field = gui.add_text(label, "")
    return Binding(field, read=read, write=write, accept=lambda name: bool(name.strip()), typed=True)


def on_press(button: viser.GuiButtonHandle, action: Callable[[], None]) -> None:
    """Post an action whenever a person presses a button."""

    async def pressed(event: viser.GuiEvent[Any]) -> None:
        if event.client is not None:
            action()

    button.on_click(pressed)


def element_id(button: viser.GuiButtonHandle) -> str:
    """Id of a button's element in the page, so that HTML may be its label; a browser story watches it."""
    own: Any = button
    return str(own._impl.uuid)  # viser 1.1.1 gives it nowhere else


def on_choice(group: viser.GuiButtonGroupHandle, action: Callable[[int], None]) -> None:
    """Post an action with the place of the option that a person pressed in a row of buttons."""

    async def chosen(event: viser.GuiEvent[Any]) -> None:
        options: Sequence[str] = group.options
        if event.client is not None and event.target.value in options:
            action(options.index(event.target.value))

    group.on_click(chosen)


def on_command(command: viser.CommandHandle, action: Callable[[], None]) -> None:
    """Post an action whenever a person uses a keyboard command."""

    async def triggered(event: viser.CommandEvent) -> None:
        if event.client is not None:
            action()

    command.on_trigger(triggered)


def assign(handle: Any, **props: Any) -> None:
    """Set properties of a handle that differ: a comparison costs 1 us, an assignment 40 us."""
    for name, value in props.items():
        if getattr(handle, name) != value:
            setattr(handle, name, value)


class Changed:
    """Says whether anything that a drawing depends on is another object than last time."""

    def __init__(self) -> None:
        self._last: tuple[object, ...] | None = None

    def __call__(self, *parts: object) -> bool:
        """Compare plain values by equality and everything else by identity."""
        last, self._last = self._last, parts
        return last is None or not all(map(_same, parts, last))


class Row(Protocol):
    """One line of a list."""

    def show(self, visible: bool) -> None:
        """Show or hide it."""
        ...


class Rows(Generic[R]):
    """A list that grows: rows are made when first needed, then reused, never removed."""

    def __init__(self, container: viser.GuiFolderHandle, make: Callable[[int], R]) -> None:
        self._container, self._make = container, make
        self._rows: list[R] = []
        self._count = 0

    def fit(self, count: int) -> Sequence[R]:
        """Make, show and hide rows so that ``count`` are shown; returns those."""
        if count != self._count:
            self._count = count
            with self._container:
                while len(self._rows) < count:
                    self._rows.append(self._make(len(self._rows)))
            for index, row in enumerate(self._rows):
                row.show(index < count)
        return self._rows[:count]


def place_of(item: T, index: int, items: Sequence[T], same: Callable[[T, T], bool]) -> int | None:
    """Find where the item of a row is by now.

    Parameters
    ----------
    item
        As the row shows it; it may be renamed since, for instance by the letter that was typed before.
    index : int
        Of the row.
    items : sequence
        What there is now.
    same : callable
        Whether two of them are one and the same, whatever they are called.

    Returns
    -------
    int or None
        Preferably the very item, then one in the row's own place; None: it is not there any more.
    """
    alike = [place for place, one in enumerate(items) if one is item or same(one, item)]
    return min(alike, key=lambda place: (items[place] is not item, place != index), default=None)


def anything(_: object) -> bool:
    """Accept every value: viser has made a boolean of it."""
    return True


def one_of(options: Mapping[str, Any] | Sequence[str]) -> Callable[[str], bool]:
    """Accept only these options."""
    return lambda value: value in options


_PLAIN = (str, int, float, bool, type(None))


def _same(one: object, other: object) -> bool:
    return one is other or (isinstance(one, _PLAIN) and one == other)


def _settled(value: Any) -> Any:
    return value.strip() if isinstance(value, str) else value


def _waitable(value: Any) -> bool:
    return isinstance(value, str) and not value.strip()
