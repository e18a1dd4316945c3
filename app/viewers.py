"""One tab that looks at a session: the scene, and panels to work with or to watch by.

A viewer draws inside ``client.atomic()`` and sends at once, since viser would
otherwise wait up to a frame.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import viser

from app.actions import Actions
from app.arm.protocol import Arm
from app.panels import Panels
from app.panels.watch import WatchPanel
from app.parcel import Parcel
from app.scene import Scene, Viewpoint
from app.store import State


class _Draws(Protocol):
    def draw(self, state: State) -> None: ...


@dataclass(frozen=True, eq=False)
class Viewer:
    """What is drawn in one tab."""

    client: viser.ClientHandle
    scene: Scene
    panels: _Draws

    def draw(self, state: State) -> None:
        """Show a state."""
        with self.client.atomic():
            self.scene.draw(state)
            self.panels.draw(state)
        self.client.flush()

    def send(self, parcel: Parcel) -> None:
        """Let the browser save a file."""
        self.client.send_file_download(parcel.name, parcel.content, save_immediately=True)

    def see_from(self, viewpoint: Viewpoint) -> None:
        """Move the camera of this tab."""
        with self.client.atomic():
            self.client.camera.position = viewpoint.position
            self.client.camera.look_at = viewpoint.look_at
        self.client.flush()


def working(
    client: viser.ClientHandle,
    actions: Actions,
    arm: Arm,
    clock: Callable[[], float],
    skills: Sequence[tuple[str, str]],
) -> Viewer:
    """Make a tab that works on the session, in the place of what it showed before."""
    client.gui.reset()
    client.scene.reset()
    panels = Panels(client.gui, actions, skills)
    return Viewer(client, Scene(client.scene, actions, arm, clock), panels)


def watching(
    client: viser.ClientHandle,
    actions: Actions,
    arm: Arm,
    clock: Callable[[], float],
    *,
    take_over: Callable[[], None],
    copy: Callable[[Callable[[str], None]], None],
) -> Viewer:
    """Make a tab that watches another one work, and may take the work over or make a copy of it."""
    client.gui.reset()
    client.scene.reset()
    return Viewer(client, Scene(client.scene, actions, arm, clock), WatchPanel(client.gui, take_over, copy))
