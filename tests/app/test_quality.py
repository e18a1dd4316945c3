"""What is said about demonstrations is said about the right one, and nothing is said about good ones."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.files import read
from app.quality import Note, Postures, mended, notes
from gc_core import Demonstration, encode
from tests.helpers_data import POSE_SETS, load

SKILLS = Path(__file__).parents[2] / "static" / "skills"
GOOD = read(SKILLS / "reaching.csv", units="m")


def said_of(demonstrations: list[Demonstration]) -> tuple[Note, ...]:
    return notes(demonstrations, encode(demonstrations, align_by="arc_length"))


def with_one(changed: Demonstration) -> list[Demonstration]:
    return [*GOOD[:2], changed, *GOOD[3:]]


def shaken(shown: Demonstration) -> Demonstration:
    noise = np.random.default_rng(0).normal(scale=0.002, size=shown.positions.shape)
    return replace(shown, positions=shown.positions + noise)


def elsewhere(shown: Demonstration) -> Demonstration:
    bump = np.sin(np.pi * np.linspace(0.0, 1.0, len(shown.times)))
    return replace(shown, positions=shown.positions + np.outer(bump, [0.2, 0.3, 0.2]))


def paused(shown: Demonstration) -> Demonstration:
    half, count = len(shown.times) // 2, 75
    path = np.concatenate(
        (shown.positions[:half], np.repeat(shown.positions[half : half + 1], count, axis=0))
    )
    path = np.concatenate((path, shown.positions[half:]))
    return Demonstration(0.02 * np.arange(len(path)), path, name=shown.name)


@pytest.mark.parametrize("name", sorted(path.stem for path in SKILLS.glob("*.csv")))
def test_nothing_is_said_about_the_built_in_skills(name: str) -> None:
    assert said_of(read(SKILLS / f"{name}.csv", units="m")) == ()


@pytest.mark.parametrize(
    ("spoil", "fault", "fix", "words"),
    [
        (paused, "pause", "trim", "stands still for 1.5 s after"),
        (shaken, "shaky", "smooth", "times as much as the others"),
        (elsewhere, "outlier", "redo", "goes another way than the others"),
    ],
)
def test_what_is_wrong_with_one_is_said_of_that_one_alone(spoil, fault: str, fix: str, words: str) -> None:
    (note,) = said_of(with_one(spoil(GOOD[2])))

    assert (note.index, note.fault, note.fix) == (2, fault, fix)
    assert note.sentence.startswith(f"{GOOD[2].name} ")
    assert words in note.sentence


@pytest.mark.parametrize("spoil", [paused, shaken])
def test_the_fix_that_is_offered_mends_it(spoil) -> None:
    spoilt = with_one(spoil(GOOD[2]))
    (note,) = said_of(spoilt)

    assert said_of(with_one(mended(spoilt[2], note.fix))) == ()


def test_what_must_be_shown_again_is_not_changed() -> None:
    assert mended(GOOD[0], "redo") is GOOD[0]


def test_a_joint_near_its_limit_is_named_with_the_moment() -> None:
    joints = np.zeros((len(GOOD[1].times), 2))
    joints[40, 1] = 0.97
    postures = Postures(np.array([-3.0, -1.0]), np.array([3.0, 1.0]), {GOOD[1]: joints})
    found = notes(GOOD, postures=postures)

    (note,) = found
    assert (note.index, note.fault, note.fix) == (1, "joint_limit", "redo")
    assert note.at == pytest.approx(GOOD[1].times[40])
    assert "brings joint 2 within 2° of its limit after 0.8 s" in note.sentence


@pytest.mark.parametrize("name", POSE_SETS)
def test_public_recordings_stand_still_at_their_ends_and_trimming_mends_that(name: str) -> None:
    demonstrations = load(name)
    found = [note for note in notes(demonstrations) if note.fault == "pause"]

    at_an_end = [note for note in found if "at its end" in note.sentence or "at its start" in note.sentence]
    assert 2 * len(at_an_end) > len(found)
    better = [mended(shown, "trim") for shown in demonstrations]
    assert [note for note in notes(better) if note.fault == "pause"] == []


def test_one_demonstration_alone_is_neither_shaky_nor_apart() -> None:
    assert said_of([shaken(GOOD[0])]) == ()
