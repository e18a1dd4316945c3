"""Built-in skills: what the first screen shows. `python -m app.skills` makes them."""

from app.skills.errors import DamagedSkillError, NoSuchSkillError, SkillError
from app.skills.shelf import Card, empty_skill, load_card, load_skill, skill_names

__all__ = [
    "Card",
    "DamagedSkillError",
    "NoSuchSkillError",
    "SkillError",
    "empty_skill",
    "load_card",
    "load_skill",
    "skill_names",
]
