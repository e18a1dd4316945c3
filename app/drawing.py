"""A skill as the small picture by which a list shows it."""

from app.document import Document
from app.model import Model, learn
from app.tube_svg import projection_of, tube_svg
from gc_core import GcError


def drawing_of(skill: Document | Model) -> str:
    """Draw a skill's tube as an ``<svg>`` element; empty where there is none."""
    try:
        model = learn(skill) if isinstance(skill, Document) else skill
    except GcError:  # whoever opens it is told why
        return ""
    cylinder = model.cylinder
    return "" if cylinder is None else tube_svg(cylinder, projection_of((cylinder,)))
