"""The tab Compare: its choices are posted, and what is known is said in words, pictures and a table."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache

import pytest

from app.arm import PlanarArm
from app.compared import Compared
from app.comparing import asked_for, steps
from app.comparison import Comparison, Row
from app.document import View
from app.model import learn
from app.panels.compare_words import best_of, claims_in_words, table
from tests.panels.desk import Bench, state_of, taught

VIEW = View(methods=("ramp",))


@cache
def told() -> tuple[Compared, ...]:
    """What is known after each step."""
    return tuple(steps(asked_for(learn(taught()), VIEW), 5, PlanarArm))


def with_rows(*rows: Row) -> Compared:
    """What is known of these methods."""
    last = told()[-1]
    assert last.found is not None
    return replace(last, names=tuple(row.method for row in rows), found=replace(last.found, rows=rows))


def found_of(*rows: Row) -> Comparison:
    found = with_rows(*rows).found
    assert found is not None
    return found


def cells(html: str) -> list[list[str]]:
    """The text of every cell, line by line."""
    lines = re.findall(r"<tr>(.*?)</tr>", html)
    return [re.findall(r"<td[^>]*>(.*?)</td>", line) for line in lines[1:]]


def test_methods_starts_and_the_button_are_posted(bench: Bench) -> None:
    bench.draw(state_of(taught(), view=VIEW))
    bench.client.set_gui("GMR 5", True)
    bench.client.set_gui("Starts", "the starts of Try")
    bench.client.set_gui("In the scene", False)
    bench.client.press("Compare")

    assert [bench.notes.next() for _ in range(4)] == [
        ("look", (("methods", ("gmr-5", "ramp")),)),
        ("look", (("compare_count", 0),)),
        ("look", (("show_compared", False),)),
        ("compare", ()),
    ]


def test_nothing_can_be_compared_before_something_was_shown(bench: Bench) -> None:
    bench.draw(state_of(taught(0)))

    assert not bench.client.element("Compare", "Button").usable
    assert "Show the motion first" in bench.client.text()


def test_how_far_it_is_is_shown_with_what_is_known_already(bench: Bench) -> None:
    bench.draw(state_of(taught(), view=VIEW, compared=told()[1]))
    text = bench.client.text()

    assert "Ramp: 2 of 2" in text
    assert "The tube keeps the 5 paths apart" in text
    assert [line[-1] for line in cells(table(told()[1]))] == ["…"] * 7


def test_what_was_found_is_marked_as_of_a_skill_that_has_changed(bench: Bench) -> None:
    bench.draw(state_of(taught(), view=VIEW, compared=replace(told()[-1], outdated=True)))
    before = bench.client.text()
    bench.draw(state_of(taught(), view=VIEW, compared=told()[-1]))

    assert "of the skill as it was" in before
    assert "of the skill as it was" not in bench.client.text()
    assert bench.client.element("Compare again", "Button").usable


def test_a_method_that_failed_says_why_in_its_cell() -> None:
    lines = cells(table(with_rows(Row("gc", end_error_m=0.01), Row("gmr-5", failed="It <cannot>."))))

    assert "It &lt;cannot&gt;." in lines[0][2]
    assert {len(line) for line in lines[1:]} == {2}


def test_only_what_is_clearly_the_least_stands_out() -> None:
    assert best_of({"gc": 1.0, "ramp": 2.0}) == "gc"
    assert best_of({"gc": 0.0, "ramp": 0.0}) is None
    assert best_of({"gc": 1.9, "ramp": 2.0}) is None
    assert best_of({"gc": 1.0}) is None


@pytest.mark.parametrize(
    ("half_way", "said"), [(0.05, "keeps the 5 paths apart"), (0.001, "does not keep the 5")]
)
def test_what_becomes_of_the_paths_is_said_as_it_is(half_way: float, said: str) -> None:
    tube, dmp = (Row(name, spread_mid_m=half_way, spread_start_m=0.05) for name in ("gc", "dmp-5"))

    sentences = claims_in_words(found_of(tube, dmp))

    assert said in sentences[0]
    merged = half_way < 0.01
    assert sentences[1].startswith("DMP 5 brings them together:") == merged
    assert sentences[1].startswith("DMP 5 does not bring them together here:") != merged
