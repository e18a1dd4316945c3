"""The arm: a protocol, the Jaco that answers to it, and a tiny arm for tests."""

from typing import TYPE_CHECKING, Any

from app.arm.conditions import FREE, Conditions
from app.arm.errors import ArmClosedError, ArmError, ArmInputError, ArmModelError
from app.arm.planar import PlanarArm
from app.arm.protocol import HERE, STUCK, Arm, Clearance, FloatArray, JointPath, LinkMesh, Shortfall

if TYPE_CHECKING:
    from app.arm.jaco import Jaco

__all__ = [
    "FREE",
    "HERE",
    "STUCK",
    "Arm",
    "ArmClosedError",
    "ArmError",
    "ArmInputError",
    "ArmModelError",
    "Clearance",
    "Conditions",
    "FloatArray",
    "Jaco",
    "JointPath",
    "LinkMesh",
    "PlanarArm",
    "Shortfall",
]


def __getattr__(name: str) -> Any:
    """Import the Jaco when somebody wants it: its libraries take a third of a second."""
    if name != "Jaco":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from app.arm.jaco import Jaco  # noqa: PLC0415 - see above

    return Jaco
