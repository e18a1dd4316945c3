"""A taught skill and what the real arm makes of it, once for all tests."""

from __future__ import annotations

import pytest

from app import skills
from app.arm.conditions import Conditions
from app.arm.jaco import Jaco
from app.exports import Subject
from app.model import learn
from app.planning import plan_run
from app.resources import static_folder


@pytest.fixture(scope="package")
def reaching() -> Subject:
    """*Reaching*, with the plan of its run."""
    document = skills.load_skill(static_folder() / "skills", "reaching")
    model, arm = learn(document), Jaco()
    plan = plan_run(arm, model, 0, Conditions(), arm.home)
    arm.close()
    return Subject(document, model, Jaco, 0, plan)
