"""A figure of any skill: what is on it, and that it is the same file each time."""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ET

import pytest

from app.document import FloatArray
from app.figures import NoMatplotlibError, skill_figure
from app.model import Model, learn
from app.resources import static_folder
from app.skills import load_skill


@pytest.fixture(scope="module")
def model() -> Model:
    return learn(load_skill(static_folder() / "skills", "around_an_obstacle"))


def drawn(model: Model, form: str, title: str = "Here") -> bytes:
    shown: list[FloatArray] = [each.positions for each in model.demonstrations]
    runs = [run.reproduction.positions for run in model.runs]
    return skill_figure(model.cylinder, shown, runs, things=model.source.things, title=title, form=form)


def test_a_skill_is_drawn_as_the_same_file_each_time(model: Model) -> None:
    first = drawn(model, "svg")

    assert ET.fromstring(first).tag.endswith("svg")
    assert drawn(model, "svg") == first


def test_the_legend_has_the_tube_and_the_words_of_the_app(model: Model) -> None:
    svg = drawn(model, "svg")

    assert all(word in svg for word in (b"tube (generalized cylinder)", b"middle line", b"new run"))
    assert b"directrix" not in svg


def test_a_title_is_not_read_as_a_formula(model: Model) -> None:
    assert rb"Both $\q$ cost 5$" in drawn(model, "svg", r"Both $\q$ cost 5$")


def test_a_skill_is_drawn_as_a_picture(model: Model) -> None:
    assert drawn(model, "png").startswith(b"\x89PNG")


def test_without_matplotlib_a_sentence_says_what_to_install(
    model: Model, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "app.figures.sheet", None)

    with pytest.raises(NoMatplotlibError, match=r"gc-teach\[study\]"):
        drawn(model, "svg")
