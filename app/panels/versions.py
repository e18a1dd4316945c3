"""What this skill was before: any version can be worked on again or copied."""

from datetime import UTC, datetime

import viser

from app.actions import Actions
from app.binding import Changed, assign, on_choice
from app.history import History
from app.panels import words
from app.panels.menu import Menu
from app.sentences import when
from app.store import State

GO_BACK = "Go back to it"
COPY = "Open as a copy"


class VersionsPanel:
    """One version an undo step, the newest first."""

    def __init__(self, gui: viser.GuiApi, actions: Actions) -> None:
        self._changed = Changed()
        folder = gui.add_folder("Earlier versions", expand_by_default=False)
        with folder:
            self._whose = gui.add_html("")
            self._menu: Menu[int] = Menu(gui, "Version", "After which step, and when that was.")
            group = gui.add_button_group("", (GO_BACK, COPY))
            gui.add_html(words.note("Going back is a step like any other: Undo takes it back."))

        def act(place: int) -> None:
            stamp = self._menu.chosen
            if stamp is not None:
                (actions.go_back, actions.copy_version)[place](stamp)

        on_choice(group, act)

    def draw(self, state: State) -> None:
        """List the versions, and say of which skill they are."""
        whose = f"Of {words.escape_line(state.document.title)}, which is open:"
        assign(self._whose, content=words.note(whose))
        if self._changed(state.history) and state.history is not None:
            self._menu.offer(versions(state.history, datetime.now(UTC)))


def versions(history: History, now: datetime) -> list[tuple[str, int]]:
    """Name all versions but the present one, the newest first, with their stamps."""
    return [
        (
            f"{when(datetime.fromtimestamp(version.made, UTC), now)} · {version.name or 'as it began'}",
            version.stamp,
        )
        for version in reversed(history.versions)
        if version is not history.present
    ]
