"""Clicks anywhere in the scene, heard only while somebody waits for them."""

from collections.abc import Callable, Coroutine
from typing import Any

import viser

from app.actions import Actions
from app.store import State


class Clicks:
    """Begins to listen, and stops."""

    def __init__(
        self, api: viser.SceneApi, heard: Callable[[viser.SceneClickEvent], Coroutine[Any, Any, None]]
    ) -> None:
        self._api, self._heard = api, heard
        self._listens = False

    def listen(self, wanted: bool) -> None:
        """Listen, or no longer."""
        if wanted == self._listens:
            return
        self._listens = wanted
        scene: Any = self._api  # its hints know neither coroutines nor what a callback is
        if wanted:
            scene.on_click()(self._heard)
        else:
            scene.remove_click_callback(self._heard)


class Missing:
    """A click beside the hand of a replay: it corrects nothing, and that is said."""

    def __init__(self, api: viser.SceneApi, actions: Actions) -> None:
        self._clicks, self._actions = Clicks(api, self._on_click), actions

    def draw(self, state: State) -> None:
        """Listen while a replay runs."""
        self._clicks.listen(state.replay is not None and state.view.placing is None)

    async def _on_click(self, _: viser.SceneClickEvent) -> None:
        self._actions.miss_hand()
