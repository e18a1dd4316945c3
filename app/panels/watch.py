"""What a second tab on the same skill sees: it watches, and may take over or go on with a copy."""

from collections.abc import Callable

import viser

from app.binding import QUIET, assign, on_press
from app.panels import words
from app.store import State


class WatchPanel:
    """Says that the skill is open elsewhere."""

    def __init__(
        self,
        gui: viser.GuiApi,
        take_over: Callable[[], None],
        copy: Callable[[Callable[[str], None]], None],
    ) -> None:
        self._title = gui.add_html("")
        gui.add_markdown(
            "This skill is **open in another tab**, which works on it. Here you watch: everything that is "
            "done there shows here at once."
        )
        on_press(gui.add_button("Work on it here", hint="The other tab then watches."), take_over)
        own = gui.add_button(
            "Make my own copy", color=QUIET, hint="As it is now; what is done there does not change it."
        )
        on_press(own, lambda: copy(self._copied))
        self._link = gui.add_html("", visible=False)

    def draw(self, state: State) -> None:
        """Show the skill's name."""
        assign(self._title, content=words.note(words.escape(state.document.title), strong=True))

    def _copied(self, code: str) -> None:
        assign(self._link, content=words.note(words.link(code, "Your copy is ready: open it")), visible=True)
