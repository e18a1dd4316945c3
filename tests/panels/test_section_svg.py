"""The drawing of one slice: right places, one scale, valid XML."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np
import pytest

from app.panels.section_svg import HEIGHT, WIDTH, ratio_at, section_svg, size, upright
from app.player import station_at
from gc_core import encode, reproduce
from tests.panels.desk import state_of, taught

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def model():
    return state_of(taught()).model


def circles(svg: str) -> list[ElementTree.Element]:
    return ElementTree.fromstring(svg).findall(f"{SVG}circle")


def places(elements: list[ElementTree.Element]) -> np.ndarray:
    return np.array([(float(e.get("cx", "nan")), float(e.get("cy", "nan"))) for e in elements])


@pytest.mark.parametrize("station", [0, 100, 199])
def test_everything_lies_within_the_drawing(model, station: int) -> None:
    svg = section_svg(model.cylinder, station, model.runs[0].reproduction)
    corners = ElementTree.fromstring(svg).find(f"{SVG}polygon").get("points").split()
    points = np.concatenate(
        [places(circles(svg)), [list(map(float, corner.split(","))) for corner in corners]]
    )

    assert np.all((points >= 0.0) & (points <= [WIDTH, HEIGHT]))


def test_every_demonstration_is_a_point(model) -> None:
    bare = circles(section_svg(model.cylinder, 50, None))
    with_run = circles(section_svg(model.cylinder, 50, model.runs[0].reproduction))

    assert (len(bare), len(with_run)) == (5 + 1, 5 + 2)


def test_a_run_half_way_to_the_edge_is_drawn_half_way(model) -> None:
    root = ElementTree.fromstring(section_svg(model.cylinder, 100, model.runs[0].reproduction))
    dashed, solid = root.findall(f"{SVG}line")
    length = [
        np.hypot(float(e.get("x2")) - float(e.get("x1")), float(e.get("y2")) - float(e.get("y1")))
        for e in (dashed, solid)
    ]

    assert length[1] / length[0] == pytest.approx(0.5, abs=0.02)


def test_a_station_beyond_the_end_is_the_last_one(model) -> None:
    assert section_svg(model.cylinder, 10_000, None) == section_svg(model.cylinder, 199, None)


def test_neighbouring_slices_have_one_scale(model) -> None:
    def bar(station: int) -> str:
        return ElementTree.fromstring(section_svg(model.cylinder, station, None)).find(f"{SVG}path").get("d")

    assert len({bar(station) for station in range(0, 40, 5)}) == 1


def test_only_a_slice_too_small_to_read_is_enlarged_and_says_so(model) -> None:
    def words(station: int) -> str:
        return ElementTree.fromstring(section_svg(model.cylinder, station, None)).find(f"{SVG}text").text

    widest = int(model.cylinder.radii.max(axis=1).argmax())
    narrowest = int(model.cylinder.radii.max(axis=1).argmin())

    assert "enlarged" not in words(widest)
    assert "enlarged" in words(narrowest)


def test_the_widths_of_a_circle_are_its_diameter() -> None:
    cylinder = encode([s.demonstration for s in taught().demonstrations], section="circle")

    np.testing.assert_allclose(size(cylinder, 80), 2.0 * cylinder.radii[80, 0], rtol=0.01)


def test_the_playhead_walks_through_all_stations(model) -> None:
    run = model.runs[0].reproduction
    seen = [station_at(run, t) for t in np.linspace(0.0, run.times[-1], 50)]

    assert seen == sorted(seen)
    assert (seen[0], seen[-1]) == (0, 199)


def test_a_station_before_a_late_start_has_no_ratio(model) -> None:
    late = reproduce(model.cylinder, model.cylinder.directrix[120])

    assert ratio_at(late, 20) is None
    assert ratio_at(late, 150) == pytest.approx(0.0, abs=0.05)


def test_up_in_the_room_is_up_in_the_slice(model) -> None:
    cylinder = model.cylinder
    for frame in cylinder.frames[::20]:
        turn, leans = upright(frame)
        up = turn @ frame[:, 1:].T @ [0.0, 0.0, 1.0]

        assert not leans or (up[1] > 0.0 and abs(up[0]) < 1e-12)
        np.testing.assert_allclose(turn @ turn.T, np.eye(2), atol=1e-12)
