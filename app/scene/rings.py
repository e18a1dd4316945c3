"""Rings about the hand that turn the tool; there only when asked for."""

from typing import Final

import numpy as np
import viser

from app.actions import Actions
from app.store import State

SIZE: Final = 0.13
"""Of the rings [m]: they lie outside of the hand's ball."""


class ToolRings:
    """``/tool``: three rings, turned as the tool is, or shall be."""

    def __init__(self, api: viser.SceneApi, actions: Actions) -> None:
        self._api, self._actions = api, actions
        self._handle: viser.TransformControlsHandle | None = None
        self._visible = False
        self._pulled = False
        """Whether somebody pulls a ring: then the page knows best how it is turned."""

    def draw(self, state: State) -> None:
        """Follow the hand; while a ring is pulled it stays under the pointer."""
        if not state.view.rings:
            self._hide()
            return
        handle = self._handle or self._add(state)
        if not self._visible:
            self._visible = handle.visible = True
        if self._pulled:
            return
        turned = state.view.tool or state.hand.turned
        if not np.array_equal(handle.position, state.hand.position):
            handle.position = state.hand.position
        if not np.array_equal(handle.wxyz, turned):
            handle.wxyz = np.array(turned)

    def _hide(self) -> None:
        self._pulled = False
        if self._handle is not None and self._visible:
            self._visible = self._handle.visible = False

    def _add(self, state: State) -> viser.TransformControlsHandle:
        self._visible = True
        self._handle = self._api.add_transform_controls(
            "/tool",
            scale=SIZE,
            line_width=4.0,
            disable_axes=True,
            disable_sliders=True,
            depth_test=False,
            position=state.hand.position,
            wxyz=state.view.tool or state.hand.turned,
        )
        self._handle.on_update(self._turned)
        return self._handle

    async def _turned(self, event: viser.TransformControlsEvent) -> None:
        if event.client is None:
            return
        self._pulled = event.phase != "end"
        # A copy: viser writes into its own array. It is checked where it is used.
        self._actions.turn_tool(np.array(event.target.wxyz))
