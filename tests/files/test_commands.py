"""``gc-teach encode`` and ``reproduce``: what they say, and what they write."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from app import commands
from app.files import FileError, UnknownFormatError, read, write
from gc_core import Demonstration, GcError, encode, reproduce
from tests.files.makers import DATA, needs_data


def demonstrations(scale: float = 1.0) -> list[Demonstration]:
    """Four that narrow towards (0.1, -0.5, 0.1)."""
    u = np.linspace(0.0, 1.0, 120)
    middle = np.stack([0.4 - 0.3 * u, -0.5 + 0.1 * np.sin(np.pi * u), 0.4 - 0.3 * u**2], axis=1)
    sides = np.array([[0, 0, 1], [0, 1, 0], [0, 0, -1], [0, -1, 0]])
    paths = middle + 0.06 * sides[:, None] * (1.05 - u)[None, :, None]
    return [Demonstration(4.0 * u, scale * path) for path in paths]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "skill.csv"
    write(path, demonstrations())
    return path


def said(capsys: pytest.CaptureFixture[str]) -> Any:
    return json.loads(capsys.readouterr().out)


def test_encode_says_how_long_and_wide_the_tube_is(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    commands.encode(file)

    words = capsys.readouterr().out
    for part in ("skill.csv: 4 demonstrations of 4 s", "cm long", "cm wide at the start", "closed_spline"):
        assert part in words


def test_encode_gives_one_json_value(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    commands.encode(file, section="circle", stations=60, align_by="time", json=True)

    facts = said(capsys)
    assert (facts["section"], facts["stations"], facts["align_by"]) == ("circle", 60, "time")
    assert facts["width_start_m"] > facts["width_middle_m"] > facts["width_end_m"]
    assert facts["out"] is None


def test_a_stated_unit_is_used(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "skill.csv"
    write(path, demonstrations(scale=10.0))
    lengths = []
    for units in ("cm", "mm"):
        commands.encode(path, units=units, json=True)  # type: ignore[arg-type]  # both are units
        lengths.append(said(capsys)["length_m"])

    assert lengths[0] == pytest.approx(10.0 * lengths[1])


def test_the_written_tube_is_the_learned_one(file: Path, tmp_path: Path) -> None:
    out = tmp_path / "tube.npz"
    commands.encode(file, out=out)

    tube = encode(read(file), align_by="arc_length")
    with np.load(out) as arrays:
        np.testing.assert_array_equal(arrays["surface"], tube.surface())
        np.testing.assert_array_equal(arrays["directrix"], tube.directrix)
        assert str(arrays["section"]) == "closed_spline"


def test_the_written_surface_is_closed_and_as_large_as_the_tube(file: Path, tmp_path: Path) -> None:
    out = tmp_path / "tube.glb"
    commands.encode(file, out=out)

    mesh = trimesh.load_mesh(out, process=False)
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(encode(read(file), align_by="arc_length").volume, rel=1e-3)


def test_reproduce_says_whether_the_start_is_inside(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    middle = encode(read(file), align_by="arc_length").directrix
    commands.reproduce(file, start=tuple(middle[2]))
    inside = capsys.readouterr().out
    commands.reproduce(file, start=(0.4, -0.5, 0.9))

    assert "inside the tube" in inside
    assert "outside of the tube" in capsys.readouterr().out


def test_reproduce_gives_the_run_as_one_json_value(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    start = (0.4, -0.48, 0.42)
    commands.reproduce(file, start=start, json=True)

    facts = said(capsys)
    run = reproduce(encode(read(file), align_by="arc_length"), start)
    np.testing.assert_allclose(facts["positions"], run.positions)
    np.testing.assert_allclose(facts["positions"][0], start)
    assert facts["eta_start"] == pytest.approx(float(run.ratios[0]))


def test_the_convergent_law_ends_nearer_to_the_middle(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ends = []
    for law in ("fixed", "convergent"):
        commands.reproduce(file, start=(0.4, -0.48, 0.42), law=law, json=True)  # type: ignore[arg-type]  # both are laws
        ends.append(said(capsys)["end_off_centre_m"])

    assert ends[1] < ends[0]


@pytest.mark.parametrize("suffix", [".csv", ".npz"])
def test_the_written_run_can_be_read_again(
    file: Path, tmp_path: Path, suffix: str, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / f"run{suffix}"
    commands.reproduce(file, start=(0.4, -0.48, 0.42), out=out, json=True)

    (run,) = read(out, units="m")
    np.testing.assert_array_equal(run.positions, said(capsys)["positions"])


def test_a_wrong_ending_is_refused_before_any_work(tmp_path: Path) -> None:
    with pytest.raises(UnknownFormatError, match=r"\.npz, \.glb"):
        commands.encode(tmp_path / "not-even-there.csv", out=tmp_path / "tube.stl")


def test_a_folder_that_is_not_there_is_named(file: Path, tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be written"):
        commands.encode(file, out=tmp_path / "gone" / "tube.npz")


@pytest.mark.parametrize("start", [(float("nan"), 0.0, 0.0), (float("inf"), 0.0, 0.0)])
def test_a_start_that_is_no_place_is_refused(file: Path, start: tuple[float, float, float]) -> None:
    with pytest.raises(GcError):
        commands.reproduce(file, start=start)


@needs_data
@pytest.mark.parametrize("pattern", ["tlgc/*.mat", "robotasks/pos_ori/*.npy", "canal_lab_demos/*.h5"])
def test_every_public_recording_can_be_learned_and_performed(
    pattern: str, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = sorted(DATA.glob(pattern))
    assert paths
    for path in paths:
        commands.reproduce(path, start=tuple(read(path)[0].positions[0]), stations=100, json=True)

        facts = said(capsys)
        assert np.isfinite(facts["positions"]).all(), path.name
        assert facts["end_off_centre_m"] < 0.1, path.name
