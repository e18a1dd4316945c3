"""``gc-teach check``: what it says of files the arm can do, and of those it cannot."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.__main__ import main
from app.check import check
from app.files import FileError, write
from gc_core import Demonstration
from tests.helpers_data import DATA

KEYS = {
    "reached",
    "max_error_mm",
    "max_joint_step_rad",
    "max_joint_speed_ratio",
    "min_self_distance_mm",
    "clearance_mm",
    "duration_s",
    "problems",
}
SHARE = np.linspace(0.0, 1.0, 120)


def file_of(
    folder: Path, begin: tuple[float, float, float], end: tuple[float, float, float], seconds: float = 8.0
) -> Path:
    """A straight motion of some seconds, as a file."""
    path = folder / "motion.csv"
    positions = (1.0 - SHARE)[:, None] * np.array(begin) + SHARE[:, None] * np.array(end)
    write(path, [Demonstration(seconds * SHARE, positions, name="Over there")])
    return path


def facts_of(file: Path, capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    check(file, json=True, units="m")
    return json.loads(capsys.readouterr().out)


@pytest.fixture
def easy(tmp_path: Path) -> Path:
    return file_of(tmp_path, (0.2, -0.5, 0.2), (-0.2, -0.5, 0.35))


def test_it_gives_one_json_value_with_the_agreed_names(
    easy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    facts = facts_of(easy, capsys)

    assert set(facts) == KEYS
    assert all(isinstance(facts[key], float) for key in KEYS - {"problems", "clearance_mm"})


def test_what_the_arm_can_do_has_no_problems(easy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    facts = facts_of(easy, capsys)

    assert facts["reached"] == 1.0
    assert facts["max_error_mm"] < 1.0
    assert facts["max_joint_speed_ratio"] < 1.0
    assert facts["min_self_distance_mm"] > 0.0
    assert facts["clearance_mm"] is None
    assert facts["problems"] == []


def test_a_motion_shown_too_fast_is_said_with_the_time_it_needs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    facts = facts_of(file_of(tmp_path, (0.2, -0.5, 0.2), (-0.2, -0.5, 0.35), seconds=0.5), capsys)

    assert facts["max_joint_speed_ratio"] > 1.0
    assert facts["duration_s"] > 0.5
    (problem,) = facts["problems"]
    assert "times as fast as it can" in problem
    assert f"{facts['duration_s']:.1f} s" in problem


def test_a_motion_out_of_reach_is_said_with_place_reason_and_remedy(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    facts = facts_of(file_of(tmp_path, (0.0, -0.6, 0.3), (0.0, -1.4, 0.3), seconds=20.0), capsys)
    beyond = (1.4 - 0.98) / 0.8

    assert facts["reached"] == pytest.approx(1.0 - beyond, abs=0.03)
    assert facts["max_error_mm"] == pytest.approx(420.0, abs=5.0)
    (problem,) = [each for each in facts["problems"] if "beyond reach" in each]
    assert problem.startswith("Over there, 9.")
    assert "to 20.0 s" in problem
    assert "Move this part of the motion nearer to the arm" in problem


def test_words_say_what_json_says(easy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    check(easy, units="m")

    words = capsys.readouterr().out
    for part in (
        "motion.csv: 1 demonstration",
        "reaches 100 %",
        "speed limit",
        "clear of itself",
        "Nothing needs",
    ):
        assert part in words


@pytest.mark.parametrize(
    ("content", "words"),
    [("t,x,y,z\n0,a,b,c\n", "broken.csv"), ("", "empty"), ("0,0,0\nnan,0,0\n", "broken.csv")],
)
def test_a_file_that_cannot_be_read_is_said_in_one_sentence(
    tmp_path: Path, content: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "broken.csv"
    path.write_text(content)
    with pytest.raises(SystemExit) as stopped:
        main(["check", str(path)])

    told = capsys.readouterr()
    assert stopped.value.code == 1
    assert words in told.err
    assert told.out == ""
    assert "Traceback" not in told.err


def test_a_built_in_skill_is_checked_among_its_things(capsys: pytest.CaptureFixture[str]) -> None:
    check(Path("around_an_obstacle"), json=True)
    facts = json.loads(capsys.readouterr().out)

    assert facts["reached"] == 1.0
    assert facts["clearance_mm"] > 10.0
    assert not any("deep" in problem for problem in facts["problems"])


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"nowhere\.csv"):
        check(tmp_path / "nowhere.csv")


@pytest.mark.skipif(
    not DATA.is_dir(), reason="the public recordings are not in ../shared/data; set GC_TEACH_DATA"
)
@pytest.mark.parametrize(
    "pattern", ["tlgc/[as]*.mat", "robotasks/pos_ori/open*.npy", "canal_lab_demos/*1.h5"]
)
def test_every_kind_of_public_recording_is_judged(pattern: str, capsys: pytest.CaptureFixture[str]) -> None:
    for path in sorted(DATA.glob(pattern)):
        check(path, json=True)

        facts = json.loads(capsys.readouterr().out)
        assert set(facts) == KEYS, path.name
        assert 0.0 <= facts["reached"] <= 1.0, path.name
        assert facts["reached"] == 1.0 or facts["problems"], path.name
