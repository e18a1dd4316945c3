"""Without pybullet: what is missing is said, and nothing else breaks."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from app.arm import ArmError, Jaco
from app.arm.physics import World
from app.arm.physics_engine import PhysicsMissingError, missing

APP = Path(__file__).resolve().parents[2] / "app"


class NoPybullet:
    """An import hook: as if the package had never been installed."""

    def find_spec(self, name: str, *_: object) -> None:
        if name == "pybullet":
            raise ModuleNotFoundError("No module named 'pybullet'", name=name)


@pytest.fixture
def without_pybullet(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "pybullet", raising=False)
    monkeypatch.setattr(sys, "meta_path", [NoPybullet(), *sys.meta_path])


def test_a_world_says_what_to_install(without_pybullet: None) -> None:
    with pytest.raises(PhysicsMissingError, match=r"pip install 'gc-teach\[physics\]'"), World():
        pass


def test_what_is_missing_can_be_asked_beforehand(without_pybullet: None) -> None:
    assert "pybullet" in (missing() or "")


def test_it_is_an_error_of_the_arm() -> None:
    assert issubclass(PhysicsMissingError, ArmError)


def test_the_arm_itself_needs_no_physics(without_pybullet: None, jaco: Jaco) -> None:
    assert jaco.follow(jaco.tool_pose(jaco.home)[:3, 3][None]).errors.max() < 1e-3


def test_nothing_imports_pybullet_at_the_top() -> None:
    lines = [line for path in APP.rglob("*.py") for line in path.read_text("utf-8").splitlines()]

    assert not [line for line in lines if line.strip().startswith(("import pybullet", "from pybullet"))]


def test_the_whole_app_is_imported_without_pybullet() -> None:
    program = "import sys; sys.modules['pybullet'] = None; import app.__main__, app.server, app.session"
    done = subprocess.run([sys.executable, "-c", program], cwd=APP.parent, capture_output=True, check=False)

    assert done.returncode == 0, done.stderr.decode()
