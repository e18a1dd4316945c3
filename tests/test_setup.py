"""What docker/setup.sh says when it cannot go on: one sentence, and what to do."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

SETUP = Path(__file__).resolve().parents[1] / "docker" / "setup.sh"
TOOLS = ("bash", "dirname", "uname", "tr", "ls", "cat", "sha256sum")


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    """A checkout on a machine with next to nothing, where we are not root."""
    (tmp_path / "docker").mkdir()
    shutil.copy(SETUP, tmp_path / "docker" / "setup.sh")
    (tmp_path / "bin").mkdir()
    for tool in TOOLS:
        found = shutil.which(tool)
        assert found is not None
        (tmp_path / "bin" / tool).symlink_to(found)
    program(tmp_path, "id", "echo 1000")
    program(tmp_path, "apt-get", "exit 1")
    return tmp_path


def program(machine: Path, name: str, script: str) -> None:
    path = machine / "bin" / name
    path.write_text(f"#!{shutil.which('bash')}\n{script}\n")
    path.chmod(0o755)


def set_up(machine: Path, purpose: str) -> tuple[int, str]:
    done = subprocess.run(
        [shutil.which("bash") or "bash", str(machine / "docker" / "setup.sh"), purpose],
        env={"PATH": str(machine / "bin")},
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    return done.returncode, done.stderr.strip()


def test_without_python_and_root_it_names_the_packages(machine: Path) -> None:
    code, said = set_up(machine, "run")

    assert code == 1
    assert "sudo apt-get install python3 python3-venv" in said
    assert said.count("\n") == 0


def test_for_the_tests_it_names_the_browser_too(machine: Path) -> None:
    (machine / "bin" / "python3").symlink_to(sys.executable)

    code, said = set_up(machine, "test")

    assert code == 1
    assert "chromium" in said
    assert "python3-venv" not in said
    assert said.count("\n") == 0


def test_on_another_system_it_does_not_ask_for_apt(machine: Path) -> None:
    (machine / "bin" / "apt-get").unlink()

    code, said = set_up(machine, "run")

    assert code == 1
    assert "your system's own tools" in said


def test_a_python_that_is_too_old_is_not_taken(machine: Path) -> None:
    program(machine, "python3", "exit 1")

    code, said = set_up(machine, "run")

    assert code == 1
    assert "python3-venv" in said
