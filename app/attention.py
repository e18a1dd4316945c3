"""What a person must know at once, before whatever was said last."""

from app import bending
from app.arm.protocol import Arm, Shortfall
from app.grasp import Grasp
from app.model import Model
from app.store import Hand


def urgent(hand: Hand, held: Grasp | None, model: Model, arm: Arm) -> tuple[str, bool] | None:
    """Find the most urgent sentence, and whether it says that something is wrong; None: there is none."""
    if hand.shortfall is not None:
        return _cannot_follow(hand.shortfall), True
    if hand.unturned:
        return f"The tool cannot be turned any farther: {hand.unturned}.", True
    if held is not None and held.problem:
        return held.problem, True
    if model.problem is not None:
        return model.problem, True
    inside_out = bending.folds(model)
    if inside_out is not None:
        return inside_out, True
    kind, _, which = ("" if held is None else held.node).strip("/").partition("/")
    return bending.following(model, which, arm) if kind in {"landmarks", "turns"} else None


def _cannot_follow(short: Shortfall) -> str:
    if not short.stuck:
        return f"The arm cannot follow: {short.reason}."
    stopped = f" ({short.cause})" if short.cause else ""
    return (
        f"The arm is stuck here{stopped}. Another posture brings the hand there: reposition the arm (key P)."
    )
