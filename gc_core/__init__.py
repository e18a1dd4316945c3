"""Generalized cylinders for learning, reproducing, generalizing and refining motions."""

from gc_core import metrics
from gc_core.arrays import same_content
from gc_core.constraints import Constraint, constrain
from gc_core.contradictions import Contradiction, contradictions
from gc_core.cylinder import GeneralizedCylinder, coarser
from gc_core.demonstration import Demonstration
from gc_core.diagnostics import Diagnostics
from gc_core.encoding import encode
from gc_core.errors import (
    DegenerateCurveError,
    GcError,
    InvalidSettingError,
    LandmarkMismatchError,
    NoDemonstrationsError,
    NoMotionError,
    NotFiniteError,
    OpposedDemonstrationsError,
    ShapeError,
    TimesNotIncreasingError,
    TooFarError,
    TooFewSamplesError,
    TooLateError,
    UnknownOptionError,
    ZeroQuaternionError,
)
from gc_core.generalization import generalize
from gc_core.landmarks import Landmark
from gc_core.refinement import as_demonstration, refined, soft_correction
from gc_core.registration import ThinPlateSpline, register
from gc_core.reproduction import Reproduction, reproduce

__all__ = [
    "Constraint",
    "Contradiction",
    "DegenerateCurveError",
    "Demonstration",
    "Diagnostics",
    "GcError",
    "GeneralizedCylinder",
    "InvalidSettingError",
    "Landmark",
    "LandmarkMismatchError",
    "NoDemonstrationsError",
    "NoMotionError",
    "NotFiniteError",
    "OpposedDemonstrationsError",
    "Reproduction",
    "ShapeError",
    "ThinPlateSpline",
    "TimesNotIncreasingError",
    "TooFarError",
    "TooFewSamplesError",
    "TooLateError",
    "UnknownOptionError",
    "ZeroQuaternionError",
    "as_demonstration",
    "coarser",
    "constrain",
    "contradictions",
    "encode",
    "generalize",
    "metrics",
    "refined",
    "register",
    "reproduce",
    "same_content",
    "soft_correction",
]
