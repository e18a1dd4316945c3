"""How far a replay that lets itself be corrected is, and what it would change so far."""

from dataclasses import dataclass

from app.document import FloatArray
from gc_core import GeneralizedCylinder


@dataclass(frozen=True, eq=False)
class Progress:
    """A replay that lets itself be corrected, as far as it is."""

    name: str
    """Of what is replayed."""
    path: FloatArray
    """(K, 3) what is replayed [m]."""
    done: FloatArray
    """(T, 3) where the hand has been so far [m]; T may be 0."""
    time: float
    """Of what is replayed [s]."""
    duration: float
    """[s]."""
    held: bool
    """Whether the hand is held."""
    outline: GeneralizedCylinder | None = None
    """The tube that would be learned if the hand were let go now; None while it stays as it is."""
    effect: str = ""
    """How many of the shown runs would change, and by how much: a part of a sentence."""
