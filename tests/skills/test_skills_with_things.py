"""Skills that come with things: every run within the tube is clear of them, the hand and the whole arm."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from app.arm import Jaco
from app.arm.shapes import pose_of, surface_distance
from app.document import SECTION_KINDS, Box, FloatArray, Ring, Shape, View
from app.model import learn
from app.skills import DamagedSkillError, load_card, load_skill
from app.surroundings import conditions_of, leads_through
from gc_core import GeneralizedCylinder, encode, reproduce

FOLDER = Path(__file__).parents[2] / "static" / "skills"
AROUND, NEEDLE = "around_an_obstacle", "needle"
every_kind = pytest.mark.parametrize("section", [*SECTION_KINDS, "hull"])


def tube(skill: str, section: str) -> GeneralizedCylinder:
    shown = [item.demonstration for item in load_skill(FOLDER, skill).demonstrations]
    return encode(shown, section=section, align_by="arc_length")


def starts(cylinder: GeneralizedCylinder, ratios: FloatArray, every: int) -> FloatArray:
    """(S, 3) places in the first slice, all around and up to its edge [m]."""
    centre, rim = cylinder.directrix[0], cylinder.surface()[0, ::every]
    return (centre + ratios[:, None, None] * (rim - centre)).reshape(-1, 3)


def nearest(thing: Shape, points: FloatArray) -> float:
    """Smallest distance of points (..., 3) from the surface of a thing [m]; negative inside."""
    pose = pose_of(thing)
    return min(surface_distance(thing, pose, point) for point in points.reshape(-1, 3))


def thing_of(skill: str) -> Shape:
    (thing,) = load_skill(FOLDER, skill).things
    return thing


@pytest.fixture(scope="module")
def arm() -> Iterator[Jaco]:
    jaco = Jaco()
    yield jaco
    jaco.close()


@every_kind
@pytest.mark.parametrize("skill", [AROUND, NEEDLE])
def test_every_run_within_the_tube_keeps_the_hand_off_what_stands_there(skill: str, section: str) -> None:
    cylinder = tube(skill, section)
    runs = reproduce(cylinder, starts(cylinder, np.array([0.0, 0.5, 1.0]), every=8))
    surface = cylinder.surface()[::2, ::4]

    law = load_card(FOLDER, skill).law["hand_clear_m"]
    assert nearest(thing_of(skill), runs.positions[:, ::2]) >= law
    assert nearest(thing_of(skill), surface) >= law


def test_without_going_around_it_one_runs_into_the_box() -> None:
    directrix = tube(AROUND, "closed_spline").directrix
    straight = np.linspace(directrix[0], directrix[-1], 200)

    assert isinstance(thing_of(AROUND), Box)
    assert nearest(thing_of(AROUND), straight) < -0.02


@every_kind
def test_every_run_leads_through_the_eye_of_the_needle(section: str) -> None:
    ring, cylinder = thing_of(NEEDLE), tube(NEEDLE, section)
    runs = reproduce(cylinder, starts(cylinder, np.array([0.0, 0.5, 1.0]), every=8))

    assert isinstance(ring, Ring)
    assert all(leads_through(positions, ring) for positions in runs.positions)


@every_kind
def test_the_whole_arm_is_clear_of_the_box_on_every_run(section: str, arm: Jaco) -> None:
    document, cylinder = load_skill(FOLDER, AROUND), tube(AROUND, section)
    heeding = arm.under(conditions_of(learn(document), View()))
    assert heeding.conditions.obstacles == document.things

    for begin in starts(cylinder, np.array([0.0, 0.99]), every=len(cylinder.angles) // 4):
        path = heeding.follow(reproduce(cylinder, begin).positions[::2])
        assert path.errors.max() < 1e-3
        assert heeding.clearance(path.joints).obstacles.min() >= load_card(FOLDER, AROUND).law["arm_clear_m"]


def test_the_arm_follows_the_needle_since_the_ring_around_the_hand_is_not_kept_off() -> None:
    model = learn(load_skill(FOLDER, NEEDLE))

    assert conditions_of(model, View()).obstacles == ()


@pytest.mark.parametrize("wrong", ["measures = [0.1]", 'kind = "cloud"', "position = [0.1, 0.2]"])
def test_a_thing_that_makes_no_sense_is_said_to_be_damage(wrong: str, tmp_path: Path) -> None:
    lines = (FOLDER / f"{AROUND}.toml").read_text(encoding="utf-8").splitlines()
    key = wrong.partition(" ")[0]
    text = "\n".join(wrong if line.startswith(f"{key} ") else line for line in lines)
    (tmp_path / f"{AROUND}.toml").write_text(text, encoding="utf-8")
    (tmp_path / f"{AROUND}.csv").write_bytes((FOLDER / f"{AROUND}.csv").read_bytes())

    with pytest.raises(DamagedSkillError, match="damaged"):
        load_skill(tmp_path, AROUND)
