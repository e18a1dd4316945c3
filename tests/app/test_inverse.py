"""The map backwards: what is moved there comes back here."""

from __future__ import annotations

import numpy as np
import pytest

from app import edits
from app.document import Document
from app.inverse import EXACT
from app.model import Model, learn
from tests.app.makers import furnished, taught

MOVES = {
    "one landmark": lambda d: edits.move_landmark(edits.remove_landmark(d, "start"), "goal", np.zeros(3)),
    "two landmarks": lambda d: edits.move_landmark(d, "goal", np.array([0.60, -0.25, 0.20])),
    "a frame beside them": lambda _: furnished(),
}


def bent(move: str) -> Model:
    return learn(MOVES[move](taught()))


@pytest.mark.parametrize("move", MOVES)
def test_places_come_back_to_where_they_were(move: str) -> None:
    model = bent(move)
    rng = np.random.default_rng(4)
    places = model.taught.directrix[::3] + 0.05 * rng.normal(size=(20, 3))

    back, misses = model.taken_back(model.registration(places))

    assert misses.max() <= EXACT
    np.testing.assert_allclose(model.registration(back), model.registration(places), atol=EXACT)
    np.testing.assert_allclose(back, places, atol=1e-5)


@pytest.mark.parametrize("move", MOVES)
def test_a_start_is_where_it_was_taken_back_from(move: str) -> None:
    model = bent(move)
    place = model.cylinder.directrix[0] + 0.02

    np.testing.assert_allclose(model.carried(model.start_taken_back(place)), place, atol=1e-6)


def test_where_the_map_folds_it_says_how_far_it_missed_and_stays_finite() -> None:
    document = edits.move_landmark(taught(), "goal", learn(taught()).cylinder.directrix[0] + 1e-4)
    model = learn(document)

    points = np.random.default_rng(1).normal(size=(50, 3))

    back, misses = model.taken_back(points)

    assert np.isfinite(back).all()
    np.testing.assert_allclose(np.linalg.norm(model.registration(back) - points, axis=1), misses, atol=1e-12)


def test_nothing_moved_leaves_every_place() -> None:
    model, places = learn(taught()), np.eye(3)

    assert model.taken_back(places)[0] is places


def test_an_empty_skill_leaves_every_start() -> None:
    np.testing.assert_array_equal(learn(Document("empty")).start_taken_back(np.ones(3)), np.ones(3))
