"""pybullet, found only when somebody asks for it: the one place that imports it.

It has wheels for Linux on x86-64 up to Python 3.11 and is compiled for minutes
elsewhere, so the app must run without it and say what is missing.
"""

from __future__ import annotations

import importlib
from typing import Any

from app.arm.errors import ArmError


class PhysicsMissingError(ArmError):
    """Physics was asked for, but pybullet is not installed or cannot be loaded."""

    def __init__(self, why: str) -> None:
        super().__init__(
            f"Physics needs the package pybullet, which cannot be used here ({why}). Everything else works "
            "without it. Install it with: pip install 'gc-teach[physics]' (seconds on Linux with Python "
            "3.11; elsewhere it is compiled for some minutes and needs a C++ compiler). Then start again."
        )


def engine() -> Any:
    """Give the module pybullet.

    Raises
    ------
    PhysicsMissingError
        If it is not installed or cannot be loaded.
    """
    try:
        return importlib.import_module("pybullet")
    except ImportError as error:
        raise PhysicsMissingError(str(error)) from error


def missing() -> str | None:
    """Say what is missing for physics and what to install; None when nothing is."""
    try:
        engine()
    except PhysicsMissingError as error:
        return str(error)
    return None
