"""All drawing parts of one session."""

from collections.abc import Callable
from typing import Final, Protocol

import viser

from app.actions import Actions
from app.arm.protocol import Arm
from app.document import FloatArray
from app.scene.arm import ArmFrames
from app.scene.clicks import Missing
from app.scene.compared import ComparedRuns
from app.scene.cylinder import Directrix, FormerTube, Section, Tube
from app.scene.demonstrations import Demonstrations
from app.scene.drop import DropLine
from app.scene.hand import HandBall, Recording, Shortage
from app.scene.hatching import Hatching
from app.scene.landmarks import Landmarks
from app.scene.placing import Placing
from app.scene.pulls import checked_point
from app.scene.replay import Replay
from app.scene.reproductions import Reproductions, Starts
from app.scene.rings import ToolRings
from app.scene.rules import Rules
from app.scene.suggestion import SuggestionDisc
from app.scene.things import Things
from app.scene.view import Eye
from app.store import State

FARTHEST_CAMERA: Final = 1e6
"""A camera farther away than this was sent by nobody who looks [m]."""


class Part(Protocol):
    """Something that draws its share of the state."""

    def draw(self, state: State) -> None:
        """Bring what is on the screen up to date; sends nothing when it is already."""
        ...


class Scene:
    """What one person sees; call `draw` from one thread, inside ``client.atomic()``."""

    def __init__(self, api: viser.SceneApi, actions: Actions, arm: Arm, clock: Callable[[], float]) -> None:
        """Make the parts.

        Parameters
        ----------
        api : viser.SceneApi
            The scene of this person's client.
        actions : Actions
            Where pulls and clicks go.
        arm : Arm
            Whose links are moved; its `link_poses` is called by `draw`.
        clock : callable
            Session time now [s]; stamps the pulls.
        """
        self._eye = Eye()
        self._parts: tuple[Part, ...] = (
            Tube(api),  # first, see there
            FormerTube(api),
            Rules(api),
            ArmFrames(api, arm),
            Directrix(api, actions),
            Section(api),
            Demonstrations(api, actions, clock),
            Reproductions(api, actions, clock),
            ComparedRuns(api),
            Hatching(api),
            Starts(api, actions, clock, self._eye),
            Landmarks(api, actions, clock, self._eye),
            Replay(api),
            SuggestionDisc(api),
            Things(api, actions, clock),
            Recording(api),
            HandBall(api, actions, clock, self._eye),
            Shortage(api),
            DropLine(api),
            ToolRings(api, actions),
            Placing(api, actions),
            Missing(api, actions),
        )

    def draw(self, state: State) -> None:
        """Draw a state; what is unchanged since the last one costs nothing."""
        for part in self._parts:
            part.draw(state)

    def look_from(self, position: FloatArray) -> None:
        """Say where this person's camera is (3,) [m]; the next `draw` turns the grips of the balls to it."""
        place = checked_point(position, FARTHEST_CAMERA)
        if place is not None:
            self._eye.position = place
