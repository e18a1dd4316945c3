"""My skills: what the buttons are about is the skill that is open, unless a person chose another."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime

from app.library import Summary
from app.panels.skills import CHOOSE
from app.store import Card, Shelf, State
from tests.panels.desk import Bench, state_of, taught

HERE, OTHER = "here-0123456789", "other-0123456789"


def listed(state: State, *skills: tuple[str, str, int]) -> State:
    """The state with a list of skills: code, title, and in which year they were saved."""
    cards = [
        Card(Summary(code, title, datetime(year, 5, 17, 12, tzinfo=UTC)), "") for code, title, year in skills
    ]
    return replace(state, shelf=Shelf(HERE, tuple(cards), ()))


def choose(bench: Bench, name: str, code: str) -> None:
    """Choose a skill and see that the buttons are about it."""
    bench.client.set_gui("Choose", name)
    bench.client.press("Make a copy")
    assert bench.notes.next() == ("copy_skill", (code,))


def test_the_choice_is_the_open_skill_until_a_person_chooses_another(bench: Bench) -> None:
    state, chosen = state_of(taught()), lambda: bench.client.value("Choose")
    bench.draw(listed(state, (OTHER, "Pouring", 2011), (HERE, "Wiping", 2010)))
    at_first = chosen()
    choose(bench, "Pouring · 17 May 2011", OTHER)
    bench.draw(listed(state, (OTHER, "Pouring", 2012), (HERE, "Wiping", 2010)))
    saved_again = chosen()
    bench.draw(listed(state, (HERE, "Wiping", 2010)))
    deleted = chosen()

    assert [at_first, saved_again, deleted] == [
        "Wiping · 17 May 2010",
        "Pouring · 17 May 2012",
        "Wiping · 17 May 2010",
    ]


def test_the_choice_goes_to_the_skill_that_is_opened_instead(bench: Bench) -> None:
    state = state_of(taught())
    bench.draw(listed(state, (OTHER, "Pouring", 2011), (HERE, "Wiping", 2010)))
    choose(bench, "Pouring · 17 May 2011", OTHER)
    bench.draw(listed(state, (HERE, "Needle", 2013), (OTHER, "Pouring", 2011)))

    assert bench.client.value("Choose") == "Needle · 17 May 2013"


def test_the_delete_question_names_the_skill_that_is_chosen_with_its_time(bench: Bench) -> None:
    bench.draw(listed(state_of(taught()), (OTHER, "Wiping", 2011), (HERE, "Wiping", 2010)))
    bench.client.press("Delete…")
    bench.client.wait(lambda c: "Delete Wiping · 17 May 2010?" in c.text())
    bench.client.press("Delete it")

    assert bench.notes.next() == ("delete_skill", (HERE,))


def test_nothing_is_chosen_while_the_open_skill_is_not_in_the_list(bench: Bench) -> None:
    bench.draw(listed(state_of(taught()), (OTHER, "Pouring", 2011)))

    def offered() -> bool:
        return any("Delete…" in e.props.get("options", ()) and e.usable for e in bench.client.gui)

    assert (bench.client.value("Choose"), offered()) == (CHOOSE, False)
    bench.client.set_gui("Choose", "Pouring · 17 May 2011")
    bench.client.wait(lambda _: offered())


def test_earlier_versions_say_of_which_skill_they_are(bench: Bench) -> None:
    bench.draw(state_of(replace(taught(), title="Wiping")))

    assert "Of Wiping, which is open" in bench.client.text()
