"""The prepared model: made once, whole or not at all, by whoever comes first."""

from __future__ import annotations

import shutil
import threading
from pathlib import Path

import pytest

from app.arm import ArmModelError, Jaco, cache, meshes, urdf
from app.arm.cache import prepared_folder


def quick_meshes(folder: Path) -> None:
    """Stand in for three seconds of decimation."""
    folder.joinpath("meshes.npz").write_bytes(b"prepared")


def test_the_folder_s_name_says_how_it_was_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(meshes, "write", quick_meshes)
    before = prepared_folder(tmp_path)
    monkeypatch.setattr(urdf, "PACKAGE", "numpy")
    monkeypatch.setattr(urdf, "write", quick_meshes)

    assert prepared_folder(tmp_path) != before


def test_a_prepared_model_is_not_prepared_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(meshes, "write", quick_meshes)
    folder = prepared_folder(tmp_path)
    folder.joinpath("meshes.npz").write_bytes(b"kept")
    prepared_folder(tmp_path)

    assert folder.joinpath("meshes.npz").read_bytes() == b"kept"


def test_many_at_once_make_one_whole_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    gate = threading.Barrier(4)

    def all_at_once(folder: Path) -> None:
        quick_meshes(folder)
        gate.wait(10)

    monkeypatch.setattr(meshes, "write", all_at_once)
    racers = [threading.Thread(target=prepared_folder, args=(tmp_path,)) for _ in range(4)]
    for racer in racers:
        racer.start()
    for racer in racers:
        racer.join()

    (only,) = tmp_path.iterdir()
    assert {file.name for file in only.iterdir()} >= {urdf.ROBOT_FILE, urdf.PAIRS_FILE, "meshes.npz"}


def test_a_preparation_that_fails_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(folder: Path) -> None:
        raise ArmModelError("a mesh is missing", "Install it again.")

    monkeypatch.setattr(meshes, "write", fail)
    with pytest.raises(ArmModelError, match="a mesh is missing"):
        prepared_folder(tmp_path)

    assert list(tmp_path.iterdir()) == []


def test_the_environment_names_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GC_TEACH_CACHE", str(tmp_path / "elsewhere"))

    assert cache.cache_folder() == tmp_path / "elsewhere"


def test_a_cache_that_cannot_be_written_says_what_to_do(tmp_path: Path) -> None:
    occupied = tmp_path / "file"
    occupied.write_text("not a folder")

    with pytest.raises(ArmModelError, match="GC_TEACH_CACHE"):
        prepared_folder(occupied)


def test_a_damaged_model_says_what_to_delete(tmp_path: Path) -> None:
    damaged = Path(shutil.copytree(prepared_folder(), tmp_path / "jaco"))
    damaged.joinpath("meshes.npz").write_bytes(b"half of it")

    with pytest.raises(ArmModelError, match="Delete the folder"):
        Jaco(damaged)


def test_preparing_says_so_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(meshes, "write", quick_meshes)
    with caplog.at_level("INFO"):
        prepared_folder(tmp_path)
        prepared_folder(tmp_path)

    assert sum("Preparing the Jaco" in message for message in caplog.messages) == 1
