"""One to four landmarks in every awkward layout, pulled live: no error, a finite tube, the case in words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app import bending
from app.desk import Desk
from app.document import Document, Place
from app.panels.smoothing import facts
from tests.app.makers import Mouse, desk_of, taught

ON_A_LINE = np.array([[0.40, 0.20, 0.30], [0.50, 0.00, 0.25], [0.55, -0.10, 0.225], [0.60, -0.20, 0.20]])
IN_A_PLANE = np.array([[0.40, 0.20, 0.30], [0.50, 0.00, 0.30], [0.55, -0.20, 0.30], [0.35, -0.10, 0.30]])
IN_SPACE = IN_A_PLANE + np.array([[0.0, 0.0, 0.1], [0, 0, 0], [0, 0, 0], [0, 0, 0.05]])
TWICE = np.array([[0.40, 0.20, 0.30], [0.50, 0.00, 0.40], [0.60, -0.20, 0.20], [0.60, -0.20, 0.20]])
NAMES = ("post", "ring", "tray", "cup")

LAYOUTS = [
    (IN_SPACE[:1], "one landmark: a translation"),
    (IN_SPACE[:2], "two landmarks"),
    (TWICE[2:], "one landmark: a translation (1 in the same place merged)"),
    (IN_SPACE[:3], "landmarks in a plane"),
    (ON_A_LINE[:3], "landmarks on a line"),
    (TWICE[1:], "(1 in the same place merged)"),
    (IN_SPACE, "a thin-plate spline"),
    (IN_A_PLANE, "landmarks in a plane"),
    (ON_A_LINE, "landmarks on a line"),
    (TWICE, "(1 in the same place merged)"),
]
every_layout = pytest.mark.parametrize(("places", "case"), LAYOUTS)
every_kind = pytest.mark.parametrize("kind", ["via", "obstacle", "object"])


def furnished(places: np.ndarray, kind: str) -> Document:
    """A skill whose landmarks are way points, and a last one of some kind that is pulled."""
    kinds = ["via"] * (len(places) - 1) + [kind]
    standing = zip(NAMES, places, kinds, strict=False)
    marks = tuple(Place(name, taught=place, kind=kind) for name, place, kind in standing)
    return replace(taught(), landmarks=marks)


def ways(places: np.ndarray) -> np.ndarray:
    """Where the last landmark is pulled, one after the other (K, 3) [m].

    Onto the first, through the middle of all, to the mirror's side of the first, onto the line of the first
    two and through it, into their plane with the third and through it, and back.
    """
    first, last = places[0], places[-1]
    second, third = places[min(1, len(places) - 1)], places[min(2, len(places) - 1)]
    chord, plane = second - first, np.cross(second - first, third - first)
    on_the_line = first + chord * ((last - first) @ chord) / max(chord @ chord, 1e-9)
    in_the_plane = last - plane * ((last - first) @ plane) / max(plane @ plane, 1e-12)
    stops = (first, places.mean(axis=0), 2.0 * first - last, on_the_line, 2.0 * on_the_line - last)
    return np.array([*stops, in_the_plane, 2.0 * in_the_plane - last, last + 1e-7, last])


def pulled_about(desk: Desk, name: str, stops: np.ndarray) -> list[str]:
    """Pull a landmark from stop to stop; the case in the panel's words wherever it was moved."""
    mouse, said = Mouse(desk), []
    mouse.press(f"/landmarks/{name}")
    here = mouse.place(f"/landmarks/{name}")
    for stop in stops:
        for _ in range(3):
            mouse.move((stop - here) / 3.0)
            model = desk.state().model
            assert model.problem is None
            assert np.isfinite(model.cylinder.surface()).all()
            assert all(np.isfinite(run.reproduction.positions).all() for run in model.runs)
            if model.registration is not None:
                assert bending.how(model).startswith("The tube is ")
                said.append(facts(model))
        here = stop
    mouse.release()
    mouse.wait(0.2)
    return said


@every_layout
@every_kind
def test_a_landmark_is_pulled_through_every_awkward_place(places: np.ndarray, case: str, kind: str) -> None:
    desk = desk_of(furnished(places, kind))
    said = pulled_about(desk, NAMES[len(places) - 1], ways(places))

    expected = "frame" if kind == "object" else case
    assert said
    assert all(expected in facts_said for facts_said in said)


@every_layout
def test_a_landmark_that_is_pulled_stands_under_the_pointer(places: np.ndarray, case: str) -> None:
    desk, name = desk_of(furnished(places, "via")), NAMES[len(places) - 1]
    goes = np.array([0.04, -0.03, 0.05])
    Mouse(desk).pull(f"/landmarks/{name}", goes, events=3)
    model = desk.state().model

    np.testing.assert_allclose(model.anchors[-1].now, places[-1] + goes, atol=1e-9)
    away = np.linalg.norm(model.registration(places[-1:])[0] - model.anchors[-1].now)
    contradicted = "merged" in case
    assert (away > 1e-3) == contradicted
