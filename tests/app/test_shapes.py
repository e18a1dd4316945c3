"""The skill in every kind of cross-section: right numbers, one scale, made again only when it must."""

from __future__ import annotations

from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from app import edits
from app.document import SECTION_KINDS, Document, SectionKind
from app.model import Model, learn
from app.shapes import same_but_for_section, shapes_of
from app.tube_svg import HEIGHT, WIDTH, cut_of, projection_of, slice_svg, tube_svg
from gc_core import GeneralizedCylinder, encode
from tests.panels.desk import taught

GOAL = np.array([0.0, -0.4, 0.2])
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def model() -> Model:
    return learn(taught())


def tubes(document: Document) -> list[GeneralizedCylinder]:
    shown = [item.demonstration for item in document.demonstrations]
    return [encode(shown, section=kind, align_by="arc_length") for kind in SECTION_KINDS]


def corners(svg: str) -> np.ndarray:
    """(n, 2) every corner of every path."""
    found: list[np.ndarray] = []
    for path in ElementTree.fromstring(svg).iter(f"{SVG}path"):
        for part in path.get("d", "").replace("z", "").split("M")[1:]:
            start, _, steps = part.partition("l")
            whole = np.array([*start.split(), *steps.split()], dtype=float).reshape(-1, 2)
            found.append(np.cumsum(whole, axis=0))
    return np.concatenate(found)


def test_the_tightest_tube_has_the_least_room(model: Model) -> None:
    shapes = shapes_of(model)

    assert all(picture.volume > shapes.least for picture in shapes.pictures.values())


@pytest.mark.parametrize("kind", SECTION_KINDS)
def test_a_picture_has_the_volume_of_the_tube_that_choosing_it_gives(kind: SectionKind) -> None:
    moved = edits.move_landmark(taught(), "goal", GOAL)
    chosen = learn(edits.set_section(moved, kind))

    assert chosen.cylinder is not None
    assert shapes_of(learn(moved)).pictures[kind].volume == pytest.approx(chosen.cylinder.volume)


def test_another_kind_start_or_name_needs_no_new_pictures(model: Model) -> None:
    document = edits.set_section(model.source, "circle")
    document = edits.rename_skill(edits.add_start(document, GOAL), "Mine")

    assert same_but_for_section(model, learn(document, model))


def test_another_demonstration_setting_or_place_of_the_goal_needs_new_pictures(model: Model) -> None:
    document = model.source
    for changed in (
        edits.mute_demonstration(document, 0, True),
        edits.set_stations(document, 100),
        edits.move_landmark(document, "goal", GOAL),
    ):
        assert not same_but_for_section(model, learn(changed, model))


def test_all_kinds_lie_within_the_drawing_in_one_scale() -> None:
    made = tubes(taught())
    view = projection_of(made)
    drawn = [corners(tube_svg(tube, view)) for tube in made]

    for points in drawn:
        assert np.all((points >= 0.0) & (points <= [WIDTH, HEIGHT]))
    widths = [np.ptp(points[:, 1]) for points in drawn]
    assert widths[0] > widths[2]  # the circle needs more room than the free shape


def test_a_tube_straight_up_can_be_drawn() -> None:
    upright = taught()
    share = np.linspace(0.0, 1.0, 80)[:, None]
    shown = tuple(
        replace(
            item,
            demonstration=replace(
                item.demonstration,
                positions=np.array([0.3, -0.3, 0.1])
                + [0.01 * i, 0.02 * i * i, 0.0]
                + share * [0.0, 0.0, 0.5],
            ),
        )
        for i, item in enumerate(upright.demonstrations)
    )
    made = tubes(replace(upright, demonstrations=shown))

    points = corners(tube_svg(made[0], projection_of(made)))

    assert np.ptp(points[:, 1]) > 0.8 * HEIGHT


def test_up_is_up_and_the_view_is_a_rotation() -> None:
    axes = projection_of(tubes(taught())).axes

    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert axes[1, 2] > 0.9


def test_the_widest_slice_shows_every_demonstration_and_the_middle() -> None:
    made = tubes(taught())
    cut = cut_of(made)
    drawn = ElementTree.fromstring(slice_svg(made[1], cut))

    assert len(drawn.findall(f"{SVG}circle")) == 5 + 1
    assert all(tube.radii[cut.station].mean() >= 0.9 * tube.radii.mean(axis=1).max() for tube in made)


def test_a_picture_is_short_enough_to_be_sent_after_every_edit(model: Model) -> None:
    sizes = [len(picture.tube) + len(picture.widest) for picture in shapes_of(model).pictures.values()]

    assert max(sizes) < 20_000
