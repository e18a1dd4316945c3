"""What is corrected: the line of a demonstration or of a run, as it is shown."""

from dataclasses import dataclass

from app.model import Model
from gc_core import Demonstration, Reproduction


@dataclass(frozen=True, eq=False)
class Subject:
    """What is corrected."""

    node: str
    """Scene name, for instance ``/demonstrations/1``."""
    name: str
    """What people call it."""
    path: Demonstration | Reproduction
    """As it is shown."""
    among: Model
    """What it belongs to."""


def subjects(model: Model) -> dict[str, str]:
    """Give a label for everything that can be corrected, with its scene name."""
    shown = model.source.demonstrations
    demonstrations = {
        f"{i + 1}: {one.demonstration.name}": f"/demonstrations/{i}" for i, one in enumerate(shown)
    }
    return demonstrations | {f"Run {i + 1}": f"/reproductions/{i}" for i in range(len(model.runs))}


def subject_of(node: str, model: Model) -> Subject | None:
    """Find what a scene name stands for; None where it is no such line."""
    kind, _, which = node.strip("/").partition("/")
    index = int(which) if which.isdecimal() else -1
    shown = model.source.demonstrations
    if kind == "demonstrations" and 0 <= index < len(shown):
        demonstration = shown[index].demonstration
        return Subject(node, demonstration.name or f"demonstration {index + 1}", demonstration, model)
    if kind == "reproductions" and 0 <= index < len(model.runs):
        return Subject(node, f"run {index + 1}", model.runs[index].reproduction, model)
    return None
