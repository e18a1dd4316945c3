"""Things in the scene that are added once, then updated in place, and hidden instead of removed.

viser compares and copies on every assignment, which costs tens of microseconds; these
remember which object they drew and send nothing when it is the same one.
"""

from typing import Any

import numpy as np
import viser
from viser._messages import SetOrientationMessage, SetPositionMessage

from app.document import FloatArray
from app.scene.geometry import Faces, Vertices
from app.scene.style import GUIDE, THIN, Color


def turn(node: viser.SceneNodeHandle, wxyz: FloatArray) -> None:
    """Turn a node that is known to be turned otherwise (4,); see `move`."""
    own: Any = node
    own._impl.wxyz[:] = wxyz
    own._impl.api._queue_scene_message(SetOrientationMessage(own.name, tuple(wxyz.tolist())))


def move(node: viser.SceneNodeHandle, position: FloatArray) -> None:
    """Move a node that is known to be elsewhere (3,) [m].

    What assigning ``position`` does in viser 1.1.1, without its comparison, which is 25 of 30 us; an arm
    has twenty poses.
    """
    own: Any = node
    own._impl.position[:] = position
    own._impl.api._queue_scene_message(SetPositionMessage(own.name, tuple(position.tolist())))


class Line:
    """Straight segments of a constant width in pixels."""

    def __init__(
        self, api: viser.SceneApi, name: str, *, color: Color = GUIDE, thickness: float = THIN
    ) -> None:
        self._api, self._name = api, name
        self._color, self._thickness = color, thickness
        self._handle: viser.LineSegmentsHandle | None = None
        self._visible = False

    def show(self, segments: FloatArray) -> None:
        """Draw segments (k, 2, 3) [m]; none at all hides the line."""
        if len(segments) == 0:
            self.hide()
            return
        if self._handle is None:
            self._handle = self._api.add_line_segments(
                self._name, segments, self._color, thickness=self._thickness, thickness_units="screen"
            )
            self._visible = True
            return
        self._handle.points = segments.astype(np.float32)
        if not self._visible:
            self._visible = self._handle.visible = True

    def look(self, color: Color, thickness: float) -> None:
        """Change how it looks, from the next time that it is shown."""
        if self._handle is not None:
            if color != self._color:
                self._handle.colors = np.array(color, dtype=np.uint8)
            self._handle.thickness = thickness
        self._color, self._thickness = color, thickness

    def hide(self) -> None:
        """Take it out of sight."""
        if self._handle is not None and self._visible:
            self._visible = self._handle.visible = False


class Mesh:
    """A body of triangles; `looks` are viser's options for `add_mesh_simple`."""

    def __init__(self, api: viser.SceneApi, name: str, **looks: Any) -> None:
        self._api, self._name = api, name
        self._looks: dict[str, Any] = {"cast_shadow": False, "receive_shadow": False, **looks}
        self._vertices: Vertices | None = None
        self._faces: Faces | None = None
        self._visible = False
        self._handle: viser.MeshHandle | None = None

    def show(self, vertices: Vertices, faces: Faces) -> viser.MeshHandle:
        """Draw it; the same objects are not sent again."""
        if self._handle is None:
            self._handle = self._api.add_mesh_simple(self._name, vertices, faces, **self._looks)
            self._vertices, self._faces, self._visible = vertices, faces, True
        if vertices is not self._vertices:
            self._handle.vertices = vertices
        if faces is not self._faces:
            self._handle.faces = faces
        if not self._visible:
            self._visible = self._handle.visible = True
        self._vertices, self._faces = vertices, faces
        return self._handle

    def reveal(self) -> None:
        """Show it as it was, if it was hidden."""
        if self._handle is not None and not self._visible:
            self._visible = self._handle.visible = True

    def hide(self) -> None:
        """Take it out of sight."""
        if self._handle is not None and self._visible:
            self._visible = self._handle.visible = False

    @property
    def handle(self) -> viser.MeshHandle | None:
        """Of viser, once it was shown."""
        return self._handle


class Ball:
    """A sphere."""

    def __init__(self, api: viser.SceneApi, name: str, *, radius: float, color: Color) -> None:
        self._api, self._name = api, name
        self._radius, self._color = radius, color
        self._visible = False
        self._handle: viser.IcosphereHandle | None = None

    def show(self, position: FloatArray, *, color: Color | None = None) -> viser.IcosphereHandle:
        """Put it at a position (3,) [m]."""
        color = color or self._color
        handle = self._handle or self._add(position)
        handle.position = position
        if color != self._color:
            handle.color = self._color = color
        if not self._visible:
            self._visible = handle.visible = True
        return handle

    def _add(self, position: FloatArray) -> viser.IcosphereHandle:
        self._visible = True
        self._handle = self._api.add_icosphere(
            self._name,
            radius=self._radius,
            color=self._color,
            subdivisions=3,
            cast_shadow=False,
            receive_shadow=False,
            position=position,
        )
        return self._handle

    def hide(self) -> None:
        """Take it out of sight."""
        if self._handle is not None and self._visible:
            self._visible = self._handle.visible = False


class Label:
    """Words beside a place."""

    def __init__(self, api: viser.SceneApi, name: str) -> None:
        self._api, self._name = api, name
        self._visible = False
        self._handle: viser.LabelHandle | None = None

    def show(self, position: FloatArray, text: str) -> None:
        """Write a text next to a position (3,) [m]."""
        if self._handle is None:
            self._handle = self._api.add_label(self._name, text, position=position, anchor="bottom-left")
            self._visible = True
            return
        self._handle.position = position
        self._handle.text = text
        if not self._visible:
            self._visible = self._handle.visible = True

    def hide(self) -> None:
        """Take it out of sight."""
        if self._handle is not None and self._visible:
            self._visible = self._handle.visible = False
