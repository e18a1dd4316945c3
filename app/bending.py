"""What moved landmarks do to the tube, in a teacher's words with the expert's beside them."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from app.anchors import Anchor
from app.arm.protocol import Arm
from app.model import Model

MOST_LISTED: Final = 3
"""More landmarks than these are counted, not named."""


def called(name: str) -> str:
    """A landmark's name in a sentence: the goal, the cup, object 1."""
    return name if name[-1:].isdecimal() else f"the {name}"


def listed(names: Sequence[str]) -> str:
    """Join names: the start, the goal and the cup."""
    said = [called(name) for name in names]
    return said[0] if len(said) == 1 else ", ".join(said[:-1]) + " and " + said[-1]


def length(distance: float) -> str:
    """A length [m] in centimetres: one decimal below 10 cm."""
    value = 100.0 * distance
    return f"{value:.1f} cm" if abs(value) < 9.95 else f"{value:.0f} cm"


def distance(anchor: Anchor) -> float:
    """How far a landmark was moved [m]."""
    return float(np.linalg.norm(anchor.now - anchor.taught))


def angle(anchor: Anchor) -> float:
    """How far an object was turned in all [deg]."""
    if anchor.turn is None:
        return 0.0
    half = 0.5 * anchor.turn
    w = np.prod(np.cos(half)) + np.prod(np.sin(half))
    return float(np.degrees(2.0 * np.arccos(np.clip(abs(w), 0.0, 1.0))))


def moved(anchor: Anchor) -> str:
    """Say how far a landmark was moved and turned; nothing where it is as it was taught."""
    parts: list[str] = []
    if distance(anchor) > 5e-4:
        parts.append(f"moved by {length(distance(anchor))}")
    if angle(anchor) > 0.05:
        parts.append(f"turned by {angle(anchor):.0f}°")
    return " and ".join(parts)


def how(model: Model) -> str:
    """Say how the tube follows: a sentence, or nothing where nothing was moved."""
    anchors, registration = model.anchors, model.registration
    if registration is None:
        return ""
    few = len(anchors) <= MOST_LISTED
    between = listed([anchor.name for anchor in anchors]) if few else f"its {len(anchors)} landmarks"
    if not len(registration.weights) and np.allclose(registration.linear, np.eye(3)):
        return f"The tube is moved as a whole, with {between}."
    if len(anchors) == 1:
        turned = " and turned" if anchors[0].kind == "object" else ""
        return f"The tube is moved{turned} as a whole, with {between}."
    if len(anchors) == 2 and all(anchor.kind != "object" for anchor in anchors):
        turned = "turned, then " if "turn" in registration.case else ""
        return f"The tube is {turned}stretched between {between}."
    bent = "bent smoothly" if len(registration.weights) else "stretched and slanted"
    return f"The tube is {bent} by {between}."


def folds(model: Model) -> str | None:
    """Say where the tube is turned inside out; None where it is not."""
    cylinder = model.cylinder
    if cylinder is None or model.registration is None:
        return None
    folded = np.flatnonzero(cylinder.diagnostics.folded)
    if not folded.size:
        return None
    places = cylinder.directrix[folded]
    moving = [anchor for anchor in model.anchors if anchor.moved]
    near = min(moving, key=lambda anchor: np.linalg.norm(places - anchor.now, axis=1).min())
    softer = ", or raise the smoothing in Move, Under the hood" if len(model.registration.weights) else ""
    return f"The tube is turned inside out near {called(near.name)}. Move it less{softer}."


def following(model: Model, name: str, arm: Arm) -> tuple[str, bool] | None:
    """Say what happens while a landmark is moved or turned, and whether it is a warning."""
    anchor = next((anchor for anchor in model.anchors if anchor.name == name), None)
    if anchor is None or not anchor.moved:
        return None
    far = [why for run in model.runs if (why := arm.unreachable(run.reproduction.positions)) is not None]
    if far:
        return f"The arm cannot follow the run there: {far[0]}. Keep {called(name)} nearer to the arm.", True
    who = called(name)
    said = f"{who[0].upper()}{who[1:]} is {moved(anchor) or 'where it was taught'}. {how(model)}"
    return said.strip(), False
