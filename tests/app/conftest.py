"""What the tests of the app's core share."""

from __future__ import annotations

import pytest

from app.desk import Desk
from tests.app.makers import Mouse, desk_of


@pytest.fixture
def desk() -> Desk:
    """A skill of three demonstrations, with the tiny arm, at rest."""
    made = desk_of()
    made.stage.pause()
    made.state()
    return made


@pytest.fixture
def mouse(desk: Desk) -> Mouse:
    """A person at that desk."""
    return Mouse(desk)
