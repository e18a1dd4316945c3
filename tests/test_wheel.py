"""What is published: a wheel that holds the app, the core and what is not code."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> zipfile.ZipFile:
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    built = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=120)
    assert built.returncode == 0, built.stderr
    return zipfile.ZipFile(next(folder.glob("gc_teach-*.whl")))


def files_in(folder: str) -> set[str]:
    return {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / folder).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def test_the_wheel_holds_the_app_and_the_core(wheel: zipfile.ZipFile) -> None:
    assert files_in("app") | files_in("gc_core") <= set(wheel.namelist())


def test_the_wheel_holds_static_where_the_app_looks_for_it(wheel: zipfile.ZipFile) -> None:
    expected = {f"app/{name}" for name in files_in("static")}

    assert expected
    assert expected <= set(wheel.namelist())


def test_the_wheel_holds_nothing_else(wheel: zipfile.ZipFile) -> None:
    tops = {name.partition("/")[0] for name in wheel.namelist()}

    assert {top for top in tops if not top.startswith("gc_teach-")} == {"app", "gc_core"}


def test_the_wheel_brings_the_command(wheel: zipfile.ZipFile) -> None:
    listed = next(name for name in wheel.namelist() if name.endswith("entry_points.txt"))

    assert "gc-teach = app.__main__:main" in wheel.read(listed).decode()


def test_the_wheel_carries_the_licence(wheel: zipfile.ZipFile) -> None:
    assert any(name.endswith("licenses/LICENSE") for name in wheel.namelist())
