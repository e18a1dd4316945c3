"""What is drawn in 3-D: `Scene` for one person's session, `draw_world` for what all share.

One drawing part a file; a part takes a `viser.SceneApi`, never a client, keeps its
handles, and sends something only when the object that it drew changed. Nothing here
changes a document: a pull or a click becomes a call of `app.actions.Actions`.
"""

from app.scene.scene import Scene
from app.scene.view import FIELD_OF_VIEW, VIEWS, Viewpoint, look_from_here
from app.scene.world import draw_world

__all__ = ["FIELD_OF_VIEW", "VIEWS", "Scene", "Viewpoint", "draw_world", "look_from_here"]
