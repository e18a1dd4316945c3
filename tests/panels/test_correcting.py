"""Fix and Try: a replay that is corrected, what becomes of it, and what physics made of a run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app import edits
from app.document import View
from app.model import learn
from app.panels.line import place
from app.panels.proposal import asked, effect
from app.panels.replay import how_far
from app.progress import Progress
from app.proposal import Choice, Proposal
from app.store import State
from app.subject import subjects
from app.trial import Trial
from tests.panels.desk import Bench, state_of, taught

LABELS = ("Add a rule", "Teach it")


def proposed(state: State, *labels: str) -> State:
    """As if a correction of the first run waited."""
    path = state.model.runs[0].reproduction.positions
    choices = tuple(
        Choice(label, f"with {label}", f"What <{label}> means.", label.lower(), lambda document: document)
        for label in labels
    )
    return replace(
        state, proposal=Proposal("Correction of run 1", "You pulled.", choices, state.model, path, path)
    )


def progress(state: State, count: int, *, held: bool = False) -> Progress:
    path = state.model.runs[0].reproduction.positions
    return Progress("Reach 1", path, path[:count], 1.0, 4.0, held)


def test_everything_that_moves_can_be_replayed() -> None:
    nodes = subjects(state_of(taught()).model).values()

    assert list(nodes) == [*(f"/demonstrations/{i}" for i in range(5)), "/reproductions/0"]


def test_what_is_replayed_how_fast_and_how_soft_is_only_looked_at(bench: Bench) -> None:
    bench.draw(state_of(taught()))
    bench.client.set_gui("Motion", "Run 1")
    bench.client.set_gui("Speed", "¼×")
    bench.client.set_gui("The hand is", "soft")

    calls = [bench.notes.next() for _ in range(3)]
    assert calls == [
        ("look", (("replay", "/reproductions/0"),)),
        ("look", (("replay_speed", 0.25),)),
        ("look", (("replay_feel", "soft"),)),
    ]


def test_a_replay_is_started_and_stopped(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    bench.client.press("Replay and let me correct")
    bench.draw(replace(state, replay=progress(state, 50)))
    bench.client.press("Stop")

    assert [bench.notes.next(), bench.notes.next()] == [("start_replay", ()), ("stop_replay", ())]
    assert not bench.client.element("Replay and let me correct", "Button").usable


def test_a_replay_says_where_it_is() -> None:
    state = state_of(taught())

    assert how_far(progress(state, 0)) == "The arm goes to where Reach 1 begins …"
    assert how_far(progress(state, 9, held=True)) == "Reach 1: 1.0 s of 4.0 s. You hold the hand."


@pytest.mark.parametrize(("label", "choice"), [("Add a rule", 0), ("Teach it", 1), ("Discard", None)])
def test_the_chip_asks_and_posts_the_answer(bench: Bench, label: str, choice: int | None) -> None:
    bench.draw(proposed(state_of(taught()), *LABELS))
    bench.client.press(label)

    assert bench.notes.next() == ("answer", (choice,))


def test_the_chip_is_seen_only_while_a_correction_waits(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    hidden = not bench.client.element("Correction").usable
    bench.draw(proposed(state, *LABELS))

    assert hidden
    assert bench.client.element("Correction of run 1").usable


def test_either_choice_is_looked_at_before_it_is_made(bench: Bench) -> None:
    state = bench.draw(proposed(state_of(taught()), *LABELS))
    assert state.proposal is not None
    bench.client.press("with Teach it")
    call = bench.notes.next()
    bench.draw(replace(state, proposal=replace(state.proposal, previewed=1)))

    assert call == ("preview", (1,))
    assert any("✓ with Teach it" in e.props.get("options", ()) for e in bench.client.gui)


def test_every_choice_has_its_sentence_and_a_person_s_words_are_text() -> None:
    state = proposed(state_of(taught()), *LABELS)
    assert state.proposal is not None
    said = asked(state.proposal, state)

    assert said.count("<li>") == 3
    assert "What &lt;Teach it&gt; means." in said


def test_how_many_runs_change_is_counted() -> None:
    before = state_of(taught())
    unchanged = proposed(before, "Accept")
    assert unchanged.proposal is not None
    document = edits.delete_demonstration(before.document, 0)
    changed = replace(unchanged, model=learn(document, before.model))

    assert effect(unchanged.proposal, unchanged) == "As shown now, no run changes."
    assert effect(unchanged.proposal, changed).startswith("As shown now, 1 of 1 run changes, by up to ")


def test_physics_is_asked_for_and_what_it_says_is_shown(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    bench.client.press("Try it with physics")
    asked_for = bench.notes.next()
    bench.draw(replace(state, trial=Trial(state.model, 0, 0.4)))
    running = bench.client.text()
    bench.draw(replace(state, trial=Trial(state.model, 0, 1.0, ("The arm follows.", "It <touches> it."))))

    assert asked_for == ("try_physics", ())
    assert "Run 1 is tried with physics" in running
    assert "It &lt;touches&gt; it." in bench.client.text()


def test_a_trial_of_a_former_skill_says_so(bench: Bench) -> None:
    state = state_of(taught())
    bench.draw(replace(state, trial=Trial(state.model, 0, 1.0, ("Fine.",), stale=True)))

    assert "The skill has changed since." in bench.client.text()
    assert not np.any([e.label == "Show what happened" and e.usable for e in bench.client.gui])


def test_a_line_is_moved_by_buttons_and_by_numbers(bench: Bench) -> None:
    node = "/demonstrations/1"
    state = state_of(taught(), view=View(line=node, line_share=0.25))
    bench.draw(state)
    shown = place(state)
    assert shown is not None
    bench.client.press("z − 1")
    _, (chosen, share, step) = bench.notes.next()
    bench.client.set_gui("Place [cm]", (float(100.0 * shown[0] + 3.0), *bench.client.value("Place [cm]")[1:]))
    _, (_, _, typed) = bench.notes.next()

    assert (chosen, share) == (node, 0.25)
    np.testing.assert_allclose(step, (0.0, 0.0, -0.01))
    np.testing.assert_allclose(typed, (0.03, 0.0, 0.0), atol=1e-9)


def test_where_a_line_is_moved_is_chosen_by_its_name_and_a_part_of_it(bench: Bench) -> None:
    bench.draw(state_of(taught()))
    closed = not bench.client.element("Place [cm]").usable
    bench.client.set_gui("Line", "Run 1")
    bench.client.set_gui("After [% of it]", 30.0)

    calls = [bench.notes.next() for _ in range(2)]
    assert closed
    assert calls == [("look", (("line", "/reproductions/0"),)), ("look", (("line_share", 0.3),))]
