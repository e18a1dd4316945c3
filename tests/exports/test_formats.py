"""What a skill is written as: each file holds what it says, and can be used without us."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
import yaml
from scipy.interpolate import CubicHermiteSpline

from app.arm import PlanarArm
from app.arm.jaco import Jaco
from app.arm.verdict import Problem
from app.document import Box, Document
from app.exports import (
    FORMATS,
    NothingToExportError,
    Subject,
    UnsafeRunError,
    file_name,
    joint_trajectory,
    parcel,
)
from app.files import inspect_bytes
from app.model import learn
from gc_core import GcError

ROOT = Path(__file__).resolve().parents[2]


def message_of(subject: Subject) -> dict[str, Any]:
    return yaml.safe_load(parcel(".yaml", subject).content)


def column(message: dict[str, Any], name: str) -> np.ndarray:
    return np.array([point[name] for point in message["points"]])


def times_of(message: dict[str, Any]) -> np.ndarray:
    clocks = [point["time_from_start"] for point in message["points"]]
    return np.array([clock["sec"] + 1e-9 * clock["nanosec"] for clock in clocks])


def test_yaml_and_json_are_the_same_message_with_the_fields_of_a_joint_trajectory(reaching: Subject) -> None:
    message = message_of(reaching)

    assert message == json.loads(parcel(".json", reaching).content)
    assert set(message) == {"header", "joint_names", "points"}
    assert message["joint_names"] == [f"j2s6s200_joint_{number}" for number in range(1, 7)]
    lengths = {(name, len(value)) for point in message["points"] for name, value in point.items()}
    assert lengths == {
        ("positions", 6), ("velocities", 6), ("accelerations", 6), ("effort", 0), ("time_from_start", 2),
    }  # fmt: skip


def test_a_controller_that_joins_the_points_by_cubics_keeps_the_limits_and_the_way(reaching: Subject) -> None:
    message, arm = message_of(reaching), Jaco()
    times = times_of(message)
    cubic = CubicHermiteSpline(times, column(message, "positions"), column(message, "velocities"))
    fine = np.linspace(0.0, times[-1], 4000)
    tips = np.array([arm.tool_pose(joints)[:3, 3] for joints in cubic(fine[::20])])
    wanted = reaching.model.runs[0].reproduction.positions

    assert (np.abs(cubic(fine, 1)).max(axis=0) <= 1.001 * arm.velocity_limits).all()
    assert (np.abs(cubic(fine, 2)).max(axis=0) <= 1.05 * arm.acceleration_limits).all()
    off = np.linalg.norm(tips[:, None] - wanted[None], axis=2).min(axis=1)
    assert off.max() < 0.005  # half the distance of two stations, and the smoothing
    arm.close()


def test_a_run_begins_and_ends_at_rest_and_lasts_as_long_as_it_was_taught(reaching: Subject) -> None:
    message = message_of(reaching)
    speeds, times = column(message, "velocities"), times_of(message)

    assert not speeds[[0, -1]].any()
    assert times[0] == 0.0
    assert (np.diff(times) > 0.0).all()
    plan = reaching.plan
    assert plan is not None
    assert times[-1] == pytest.approx(max(plan.taught, plan.verdict.timed.duration), abs=1e-6)


@pytest.mark.parametrize("kind", ["leap", "itself", "thing"])
def test_a_run_that_would_harm_is_not_given_to_an_arm(reaching: Subject, kind: Any) -> None:
    plan = reaching.plan
    assert plan is not None
    wrong = Problem(kind, 3, 5, 4, "the hand would be 2 cm deep in the box", "Move the box.")
    harmful = replace(plan, verdict=replace(plan.verdict, problems=(wrong,)))

    with pytest.raises(UnsafeRunError, match=r"not for a real arm: .* 2 cm deep in the box\. Move the box\."):
        joint_trajectory(PlanarArm(), harmful)


def test_what_stands_in_the_way_is_heeded_when_a_run_is_planned_for_export(reaching: Subject) -> None:
    wall = Box("wall", tuple(reaching.model.runs[0].reproduction.positions[100]), (0.3, 0.3, 0.3))
    document = replace(reaching.document, things=(wall,))

    with pytest.raises(UnsafeRunError, match="wall"):
        parcel(".yaml", Subject(document, learn(document), Jaco))


def test_the_program_opens_the_skill_again(reaching: Subject, tmp_path: Path) -> None:
    made = parcel(".py", replace(reaching, document=replace(reaching.document, title='Say "hi" \\ $x')))
    (tmp_path / made.name).write_bytes(made.content)

    done = subprocess.run(
        [sys.executable, str(tmp_path / made.name)],
        env={"PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )

    length = reaching.model.cylinder.arc_length[-1]  # type: ignore[union-attr] - it was learned
    assert f"The tube is {length:.3f} m long" in done.stdout
    assert done.stdout.count("A run of") == len(reaching.model.runs)


def test_the_shape_is_closed_and_as_large_as_the_tube(reaching: Subject, tmp_path: Path) -> None:
    path = tmp_path / "tube.glb"
    path.write_bytes(parcel(".glb", reaching).content)

    mesh = trimesh.load_mesh(path, process=False)

    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(reaching.model.cylinder.volume, rel=1e-3)  # type: ignore[union-attr] - learned


@pytest.mark.parametrize("suffix", [".csv", ".mat", ".npz", ".h5", ".gcteach"])
def test_demonstrations_can_be_read_again(reaching: Subject, suffix: str) -> None:
    made = parcel(suffix, reaching)

    assert inspect_bytes(made.name, made.content).samples == tuple(
        len(shown.demonstration.times) for shown in reaching.document.demonstrations
    )


@pytest.mark.parametrize(("suffix", "begins"), [(".svg", b"<?xml"), (".png", b"\x89PNG")])
def test_figures_are_pictures(reaching: Subject, suffix: str, begins: bytes) -> None:
    assert parcel(suffix, reaching).content.startswith(begins)


@pytest.mark.parametrize(
    "suffix", [suffix for suffix in FORMATS if suffix not in (".gcteach", ".py", ".html")]
)
def test_of_a_skill_without_anything_the_reason_is_said(suffix: str) -> None:
    empty = Document("My skill")

    with pytest.raises(NothingToExportError, match=r"to export.*\."):
        parcel(suffix, Subject(empty, learn(empty), PlanarArm))


def test_an_unknown_ending_lists_those_that_are_known(reaching: Subject) -> None:
    with pytest.raises(GcError, match=r"\.gcteach, \.html, \.csv"):
        parcel(".docx", reaching)


@pytest.mark.parametrize(
    ("title", "name"),
    [
        ("My reaching", "my-reaching.csv"),
        ("../../etc/passwd", "etc-passwd.csv"),
        ("Über den Rand!", "uber-den-rand.csv"),
        ("机器人", "skill.csv"),
        ("a" * 500, "a" * 60 + ".csv"),
    ],
)
def test_a_skills_name_becomes_a_files_name_that_leads_nowhere(title: str, name: str) -> None:
    assert file_name(title, ".csv") == name


def test_a_preview_says_what_is_in_it_and_shows_the_first_lines(reaching: Subject) -> None:
    made = parcel(".csv", reaching)

    assert made.about.startswith("Reaching: 5 demonstrations, 2 landmarks")
    assert made.excerpt.splitlines()[0] == made.content.decode().splitlines()[0]
    assert len(made.excerpt.splitlines()) < 20
