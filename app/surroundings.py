"""What the arm must heed: the things around it, and how a person wants the tool to be held."""

from app.arm.conditions import Conditions
from app.document import View
from app.model import Model


def conditions_of(model: Model, view: View) -> Conditions:
    """Give what the arm heeds while a model is shown."""
    return Conditions(model.source.things, view.tool)
