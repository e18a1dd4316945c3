"""What a second tab on the same skill sees: it watches, and may take over."""

from collections.abc import Callable

import viser

from app.binding import assign
from app.panels import words
from app.store import State


class WatchPanel:
    """Says that the skill is open elsewhere."""

    def __init__(self, gui: viser.GuiApi, take_over: Callable[[], None]) -> None:
        self._title = gui.add_html("")
        gui.add_markdown(
            "This skill is **open in another tab**, which works on it. Here you watch: everything that is "
            "done there shows here at once."
        )
        button = gui.add_button("Work on it here", hint="The other tab then watches.")

        @button.on_click
        async def _(_: object) -> None:
            take_over()

    def draw(self, state: State) -> None:
        """Show the skill's name."""
        assign(self._title, content=words.note(words.escape(state.document.title), strong=True))
