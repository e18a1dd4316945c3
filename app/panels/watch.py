"""What a second tab on the same skill sees: it watches, and may take over."""

from collections.abc import Callable
from html import escape

import viser

from app.store import State


class WatchPanel:
    """Says that the skill is open elsewhere."""

    def __init__(self, gui: viser.GuiApi, take_over: Callable[[], None]) -> None:
        self._title = gui.add_markdown("")
        self._shown = ""
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
        title = escape(state.document.title)
        if title != self._shown:
            self._title.content = f"### {title}"
            self._shown = title
