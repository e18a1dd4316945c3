"""The built-in skills show what they are there to show, and are made again the same."""

import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arm import Jaco
from app.document import SECTION_KINDS, Document, SectionKind
from app.files import read
from app.skills import (
    Card,
    DamagedSkillError,
    NoSuchSkillError,
    SkillError,
    empty_skill,
    load_card,
    load_skill,
    skill_names,
)
from app.skills.making import make, write
from app.skills.motion import Plan, demonstrate, middle_path, progress, slow_where_narrow
from app.skills.recipes import REACHING, RECIPES
from app.skills.shelf import format_card
from gc_core import Demonstration, GeneralizedCylinder, encode, reproduce, same_content

FOLDER = Path(__file__).parents[2] / "static" / "skills"
ALL_KINDS = (*SECTION_KINDS, "hull")
"""Those that a document can have, and the tightest."""
PLAN = Plan(
    waypoints=((0.3, -0.4, 0.4), (0.1, -0.5, 0.5), (-0.1, -0.5, 0.1)),
    spread=((0.0, 0.05), (1.0, 0.01)),
    seed=1,
)


@pytest.fixture
def arm() -> Iterator[Jaco]:
    jaco = Jaco()
    yield jaco
    jaco.close()


@pytest.fixture(params=[recipe.name for recipe in RECIPES])
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def shown(document: Document) -> list[Demonstration]:
    return [item.demonstration for item in document.demonstrations]


def cylinder_of(document: Document, section: str) -> GeneralizedCylinder:
    return encode(shown(document), section=section, align_by=document.settings.align_by)


def test_every_recipe_is_on_the_shelf() -> None:
    assert skill_names(FOLDER) == tuple(sorted(recipe.name for recipe in RECIPES))


def test_a_skill_is_made_again_the_same(name: str, arm: Jaco, tmp_path: Path) -> None:
    recipe = next(recipe for recipe in RECIPES if recipe.name == name)
    write(make(recipe, arm), tmp_path, name)

    again, stored = read(tmp_path / f"{name}.csv"), read(FOLDER / f"{name}.csv")
    assert [d.name for d in again] == [d.name for d in stored]
    for a, b in zip(again, stored, strict=True):
        np.testing.assert_allclose(a.positions, b.positions, atol=5e-4)
        np.testing.assert_allclose(a.times, b.times, atol=1e-9)
    fresh, kept = load_card(tmp_path, name), load_card(FOLDER, name)
    np.testing.assert_allclose(fresh.starts, kept.starts, atol=2e-3)
    assert replace(fresh, starts=()) == replace(kept, starts=())


def test_a_skills_files_are_small(name: str) -> None:
    assert (FOLDER / f"{name}.csv").stat().st_size < 200_000


def test_a_skill_is_built_in_and_says_what_it_is(name: str) -> None:
    document = load_skill(FOLDER, name)

    assert document.built_in
    assert document.title
    assert document.about.endswith(".")
    assert document.starts


def test_demonstrations_take_a_persons_time(name: str) -> None:
    for d in shown(load_skill(FOLDER, name)):
        assert 3.5 < d.times[-1] < 6.5, d.name
        speed = np.linalg.norm(np.diff(d.positions, axis=0), axis=1) / np.diff(d.times)
        assert speed.max() < 0.6, d.name


def test_demonstrations_stay_above_the_table_and_in_reach(name: str) -> None:
    for d in shown(load_skill(FOLDER, name)):
        from_shoulder = np.linalg.norm(d.positions - [0.0, 0.0, 0.2755], axis=1)
        assert d.positions[:, 2].min() > 0.03, d.name
        assert 0.25 < from_shoulder.min() <= from_shoulder.max() < 0.96, d.name


def test_reaching_is_shown_five_times_and_each_time_ends_at_the_ball() -> None:
    document, card = load_skill(FOLDER, "reaching"), load_card(FOLDER, "reaching")

    ends = np.array([d.positions[-1] for d in shown(document)])
    assert len(ends) == 5
    assert np.linalg.norm(ends - card.goal, axis=1).max() <= card.law["demonstration_end_m"]


def test_reaching_comes_from_above() -> None:
    for d in shown(load_skill(FOLDER, "reaching")):
        last = d.positions[-1] - d.positions[int(0.85 * len(d.positions))]
        assert last[2] < -2.0 * np.linalg.norm(last[:2]), d.name


@pytest.mark.parametrize("section", SECTION_KINDS)
def test_reaching_narrows_towards_the_ball_in_every_section_kind(section: SectionKind) -> None:
    document, card = load_skill(FOLDER, "reaching"), load_card(FOLDER, "reaching")
    cylinder = cylinder_of(document, section)

    across = 2.0 * np.linalg.norm(cylinder.surface() - cylinder.directrix[:, None], axis=2).mean(axis=1)
    assert across[:20].max() >= card.law["widest_m"]
    assert across[-1] <= card.law["narrowest_m"]
    assert not cylinder.diagnostics.crossing.any()


@pytest.mark.parametrize("section", SECTION_KINDS)
def test_a_reproduction_of_reaching_ends_at_the_ball(section: SectionKind) -> None:
    document, card = load_skill(FOLDER, "reaching"), load_card(FOLDER, "reaching")
    cylinder = cylinder_of(document, section)

    for start in document.starts:
        run = reproduce(cylinder, start)
        assert run.start_inside
        assert 0.5 < run.ratios[0] < 0.8
        assert np.linalg.norm(run.positions[-1] - card.goal) <= card.law["reproduction_end_m"]


def widths(cylinder: GeneralizedCylinder) -> np.ndarray:
    """(N,) twice the mean radius of each slice [m]; see `Recipe.law`."""
    return 2.0 * cylinder.radii.mean(axis=1)


@pytest.mark.parametrize("section", ALL_KINDS)
def test_the_needle_is_wide_then_narrow_in_the_middle_then_wide(section: str) -> None:
    document, card = load_skill(FOLDER, "needle"), load_card(FOLDER, "needle")
    cylinder = cylinder_of(document, section)

    width = widths(cylinder)
    first, middle, last = width[0], np.interp(0.5, np.linspace(0.0, 1.0, len(width)), width), width[-1]
    assert middle <= card.law["middle_to_ends"] * min(first, last)
    assert middle <= card.law["middle_m"]
    assert 0.4 < np.argmin(width) / len(width) < 0.6
    assert not cylinder.diagnostics.crossing.any()


@pytest.mark.parametrize("section", ALL_KINDS)
def test_every_reproduction_threads_the_needle_and_goes_on_to_the_end(section: str) -> None:
    document, card = load_skill(FOLDER, "needle"), load_card(FOLDER, "needle")
    cylinder = cylinder_of(document, section)
    eye = cylinder.directrix[len(cylinder.directrix) // 2]

    for start in document.starts:
        run = reproduce(cylinder, start)
        assert run.start_inside
        assert np.linalg.norm(run.positions - eye, axis=1).min() <= 0.5 * card.law["middle_m"]
        assert np.linalg.norm(run.positions[0] - eye) > 0.3
        assert np.linalg.norm(run.positions[-1] - eye) > 0.3


def test_people_slow_down_at_the_eye_of_the_needle() -> None:
    for d in shown(load_skill(FOLDER, "needle")):
        speed = np.linalg.norm(np.diff(d.positions, axis=0), axis=1) / np.diff(d.times)
        eye = int(np.argmin(np.abs(d.positions[:, 0] - 0.04)))  # where the eye is along the way
        assert speed[eye - 5 : eye + 5].mean() < 0.75 * speed.max(), d.name


def test_the_needle_is_recorded_at_sixty_samples_a_second() -> None:
    for d in shown(load_skill(FOLDER, "needle")):
        assert 1.0 / np.diff(d.times).max() >= 59.0, d.name


def test_the_arm_reaches_every_sample_of_a_skill(name: str, arm: Jaco) -> None:
    for d in shown(load_skill(FOLDER, name)):
        assert arm.follow(d.positions).errors.max() < 1e-3, d.name


def test_an_empty_skill_has_a_ball_in_reach_and_nothing_taught() -> None:
    document = empty_skill()

    (goal,) = [place for place in document.landmarks if place.name == "goal"]
    assert goal.taught is not None
    assert 0.25 < np.linalg.norm(goal.taught - [0.0, 0.0, 0.2755]) < 0.96
    assert not document.demonstrations
    assert not document.built_in


def test_an_unknown_skill_lists_the_known_ones() -> None:
    with pytest.raises(NoSuchSkillError, match="reaching"):
        load_skill(FOLDER, "../reaching")


@pytest.mark.parametrize(
    ("card", "table"),
    [
        (b"title = 'A'", b"x,y,z\n0,0,0\n1,1,1\n"),
        (b"no toml", b"x,y,z\n0,0,0\n1,1,1\n"),
        (None, b"x,y,z\n0,0,zero\n"),
    ],
)
def test_damaged_files_are_said_to_be_damaged(card: bytes | None, table: bytes, tmp_path: Path) -> None:
    (tmp_path / "reaching.toml").write_bytes(card or (FOLDER / "reaching.toml").read_bytes())
    (tmp_path / "reaching.csv").write_bytes(table)

    with pytest.raises(DamagedSkillError, match="reaching is damaged"):
        load_skill(tmp_path, "reaching")


def test_a_recipe_out_of_reach_is_refused(arm: Jaco) -> None:
    far = replace(PLAN, waypoints=((0.3, -0.4, 0.4), (1.5, -1.0, 0.4)))

    with pytest.raises(SkillError, match="cm away from Demonstration 1"):
        make(replace(REACHING, plan=far), arm)


def test_any_words_survive_on_a_card(tmp_path: Path) -> None:
    card = Card(
        'Say "ball"',
        "back\\slash, ümlaut.",
        "circle",
        (0.1, -0.5, 0.0),
        ((1.0, 2.0, 3.0),),
        {"far_m": 0.25},
        new_goals=((0.2, -0.5, 0.1), (0.3, -0.5, 0.1)),
        new_starts=((0.4, -0.5, 0.1),),
    )
    (tmp_path / "a.toml").write_text(format_card(card), encoding="utf-8")
    (tmp_path / "a.csv").touch()

    assert load_card(tmp_path, "a") == card
    assert tomllib.loads(format_card(card))["law"] == {"far_m": 0.25}


def test_the_same_seed_shows_the_same_and_another_seed_something_else() -> None:
    assert same_content(demonstrate(PLAN), demonstrate(PLAN))
    assert not same_content(demonstrate(PLAN), demonstrate(replace(PLAN, seed=2)))


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    count=st.integers(1, 8),
    widths=st.lists(st.floats(0.005, 0.1), min_size=3, max_size=3),
)
def test_demonstrations_stay_within_the_planned_spread(seed: int, count: int, widths: list[float]) -> None:
    spread = tuple(zip((0.0, 0.5, 1.0), widths, strict=True))
    plan = replace(PLAN, seed=seed, demonstrations=count, spread=spread)
    path = middle_path(plan.waypoints)[::4]

    found = demonstrate(plan)

    assert len(found) == count
    for d in found:
        nearest = np.linalg.norm(d.positions[:, None] - path[None], axis=2).min(axis=1)
        assert nearest.max() <= (1.0 + plan.wander) * max(widths) + 1e-3


def test_the_middle_path_passes_through_its_waypoints() -> None:
    path = middle_path(PLAN.waypoints)

    for waypoint in PLAN.waypoints:
        assert np.linalg.norm(path - waypoint, axis=1).min() < 2e-3


@given(seconds=st.floats(1.0, 10.0), lead=st.floats(-0.15, 0.15), second_thought=st.floats(-0.3, 0.3))
def test_progress_runs_from_start_to_end_and_never_back(
    seconds: float, lead: float, second_thought: float
) -> None:
    way = progress(seconds, lead, second_thought)

    assert way[0] == 0.0
    assert way[-1] == pytest.approx(1.0)
    assert (np.diff(way) > 0.0).all()


@given(
    seconds=st.floats(1.0, 10.0),
    widths=st.lists(st.floats(0.005, 0.1), min_size=3, max_size=12),
    care=st.floats(0.0, 1.0),
)
def test_slowing_down_keeps_the_ends_the_duration_and_the_direction(
    seconds: float, widths: list[float], care: float
) -> None:
    way = progress(seconds, 0.0, 0.0)
    slowed = slow_where_narrow(way, np.array(widths), care)

    assert slowed.shape == way.shape
    assert slowed[0] == 0.0
    assert slowed[-1] == pytest.approx(1.0)
    assert (np.diff(slowed) > 0.0).all()


def test_full_care_makes_speed_proportional_to_width() -> None:
    width = np.linspace(0.01, 0.05, 400)
    slowed = slow_where_narrow(np.linspace(0.0, 1.0, 2000), width, care=1.0)

    here = np.interp(slowed, np.linspace(0.0, 1.0, 400), width)
    ratio = np.gradient(slowed) / here
    np.testing.assert_allclose(ratio[1:-1] / ratio[1000], 1.0, atol=0.02)
