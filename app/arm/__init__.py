"""The arm: a protocol, the Jaco that answers to it, and a tiny arm for tests."""

from app.arm.conditions import FREE, Conditions
from app.arm.errors import ArmClosedError, ArmError, ArmInputError, ArmModelError
from app.arm.jaco import Jaco
from app.arm.planar import PlanarArm
from app.arm.protocol import HERE, STUCK, Arm, Clearance, FloatArray, JointPath, LinkMesh, Shortfall

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
