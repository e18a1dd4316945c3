"""The arm: a protocol, the Jaco that answers to it, and a tiny arm for tests."""

from app.arm.errors import ArmClosedError, ArmError, ArmInputError, ArmModelError
from app.arm.jaco import Jaco
from app.arm.planar import PlanarArm
from app.arm.protocol import HERE, Arm, FloatArray, JointPath, LinkMesh, Shortfall

__all__ = [
    "HERE",
    "Arm",
    "ArmClosedError",
    "ArmError",
    "ArmInputError",
    "ArmModelError",
    "FloatArray",
    "Jaco",
    "JointPath",
    "LinkMesh",
    "PlanarArm",
    "Shortfall",
]
