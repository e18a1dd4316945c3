"""Both arms, for the tests of what every arm promises."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from app.arm import Arm, Jaco, PlanarArm


@pytest.fixture(scope="session")
def jaco() -> Iterator[Jaco]:
    """One Jaco for all tests: each of its calls depends on its arguments alone."""
    arm = Jaco()
    yield arm
    arm.close()


@pytest.fixture(params=["jaco", "planar"])
def arm(request: pytest.FixtureRequest) -> Arm:
    """Each arm in turn."""
    return request.getfixturevalue("jaco") if request.param == "jaco" else PlanarArm()
