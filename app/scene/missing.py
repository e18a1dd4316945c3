"""A click beside the hand of a replay: it corrects nothing, and that is said."""

from typing import Any

import viser

from app.actions import Actions
from app.store import State


class Missing:
    """Listens for clicks anywhere in the scene while a replay runs."""

    def __init__(self, api: viser.SceneApi, actions: Actions) -> None:
        self._api, self._actions = api, actions
        self._listens = False

    def draw(self, state: State) -> None:
        """Begin to listen, or stop."""
        wanted = state.replay is not None and state.view.placing is None
        if wanted == self._listens:
            return
        self._listens = wanted
        scene: Any = self._api  # its hints know neither coroutines nor what a callback is
        if wanted:
            scene.on_click()(self._on_click)
        else:
            scene.remove_click_callback(self._on_click)

    async def _on_click(self, _: viser.SceneClickEvent) -> None:
        self._actions.miss_hand()
