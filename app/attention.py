"""What a person must know at once, before whatever was said last."""

from app import bending
from app.arm.protocol import Arm
from app.grasp import Grasp
from app.model import Model
from app.store import Hand


def urgent(hand: Hand, held: Grasp | None, model: Model, arm: Arm) -> tuple[str, bool] | None:
    """Find the most urgent sentence, and whether it says that something is wrong; None: there is none."""
    if hand.shortfall is not None:
        return f"The arm cannot follow: {hand.shortfall.reason}.", True
    if held is not None and held.problem:
        return held.problem, True
    if model.problem is not None:
        return model.problem, True
    inside_out = bending.folds(model)
    if inside_out is not None:
        return inside_out, True
    kind, _, which = ("" if held is None else held.node).strip("/").partition("/")
    return bending.following(model, which, arm) if kind in {"landmarks", "turns"} else None
