"""What the arm must heed: the things around it, and how a person wants the tool to be held."""

from typing import Final

import numpy as np

from app.anchors import Anchor
from app.arm.conditions import Conditions
from app.arm.shapes import pose_of
from app.document import Cylinder, FloatArray, Ring, Shape, View
from app.model import Model

POST_RADIUS: Final = 0.03
"""Of the post that a landmark of kind obstacle is drawn as; its top is this far above the landmark [m]."""


def conditions_of(model: Model, view: View) -> Conditions:
    """Give what the arm heeds while a model is shown.

    It keeps off what stands fixed and off the posts. What can be pushed and carried has to be touched, and
    a ring that the motion leads through is around the hand: whoever keeps off it never gets through.
    """
    fixed = tuple(thing for thing in model.source.things if thing.mass == 0.0 and not _in_it(thing, model))
    posts = tuple(post(anchor) for anchor in model.anchors if anchor.kind == "obstacle")
    return Conditions((*fixed, *posts), view.tool)


def post(anchor: Anchor) -> Cylinder:
    """Give the post of an obstacle's landmark as it is drawn: from the table to a little above it."""
    x, y, z = anchor.now.tolist()
    top = z + POST_RADIUS
    low = min(0.0, top - 1e-3)
    return Cylinder(anchor.name, (x, y, 0.5 * (low + top)), POST_RADIUS, top - low)


def leads_through(path: FloatArray, ring: Ring) -> bool:
    """Whether a path (K, 3) [m] crosses the disc that a ring encloses, by its middle circle."""
    pose = pose_of(ring)
    local = (path - pose[:3, 3]) @ pose[:3, :3]
    height = local[:, 2]
    crossing = np.flatnonzero((height[:-1] < 0.0) != (height[1:] < 0.0))
    share = height[crossing] / (height[crossing] - height[crossing + 1])
    where = local[crossing] + share[:, None] * (local[crossing + 1] - local[crossing])
    return bool(np.any(np.hypot(where[:, 0], where[:, 1]) < ring.radius))


def _in_it(thing: Shape, model: Model) -> bool:
    tube = model.cylinder
    return isinstance(thing, Ring) and tube is not None and leads_through(tube.directrix, thing)
