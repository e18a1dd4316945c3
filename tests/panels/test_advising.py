"""Advice: one thing at a time, with a fix that is one undo step."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from app import advising, drawn, edits
from app.desk import Desk
from app.document import Document
from app.model import learn
from app.quality import Postures
from app.scene.suggestion import RADIUS, disc, wanted
from gc_core import Demonstration
from tests.app.makers import Mouse, desk_of, taught
from tests.panels.desk import Bench, state_of
from tests.panels.desk import taught as reaching


def with_a_pause(document: Document) -> Document:
    """The second demonstration stands still for a second half-way."""
    one = document.demonstrations[1].demonstration
    half = len(one.times) // 2
    still = np.linspace(0.05, 1.0, 20)
    times = np.concatenate([one.times[: half + 1], one.times[half] + still, one.times[half + 1 :] + 1.0])
    places = np.insert(one.positions, half + 1, np.repeat(one.positions[half : half + 1], 20, axis=0), axis=0)
    return edits.replace_demonstration(document, 1, Demonstration(times, places, name="Slow one"))


def found(document: Document) -> advising.Advice:
    return advising.advice(learn(document))


def test_a_pause_is_noted_and_cut_out_in_one_undo_step() -> None:
    desk = desk_of(with_a_pause(taught()))
    paused = desk.store.document.demonstrations[1].demonstration
    note = advising.note_of(found(desk.store.document), paused)
    assert note is not None
    desk.edit(partial(advising.fixed, demonstration=paused, fix=note.note.fix), "trim", now=1.0)
    mended = desk.store.document

    assert note.note.fault == "pause"
    assert advising.note_of(found(mended), mended.demonstrations[1].demonstration) is None
    desk.undo(2.0)
    assert desk.store.document.demonstrations[1].demonstration is paused


def again(pulled: bool) -> tuple[Desk, Demonstration, Mouse]:
    """Somebody wants to show the first demonstration again, and does."""
    desk = desk_of()
    former = desk.store.document.demonstrations[0].demonstration
    desk.look(redo=former)
    mouse = Mouse(desk)
    mouse.press("/hand")
    for _ in range(20):
        mouse.move((0.01, 0.0, -0.01))
    if pulled:
        mouse.release()
        mouse.wait(0.4)
    return desk, former, mouse


def test_what_is_shown_again_takes_the_place_of_the_old_one_in_one_undo_step() -> None:
    desk, former, mouse = again(pulled=True)
    after, waits = desk.store.document, desk.view.redo
    names = [shown.demonstration.name for shown in after.demonstrations]
    desk.undo(mouse.now)

    assert names == ["Reach 1", "Reach 2", "Reach 3"]
    assert after.demonstrations[0].demonstration is not former
    assert waits is None
    assert desk.store.document.demonstrations[0].demonstration is former
    assert desk.store.undo_name is None


def test_what_was_deleted_before_it_was_shown_again_is_not_said_to_be_replaced() -> None:
    desk, _, mouse = again(pulled=False)
    desk.store.edit(lambda d: edits.delete_demonstration(d, 0), "delete", now=mouse.now)
    mouse.release()
    mouse.wait(0.4)

    assert "took the place" not in desk.state().message
    assert desk.store.undo_name == "demonstrate"


def test_while_it_is_shown_again_the_tube_is_learned_without_the_old_one() -> None:
    desk, former, _ = again(pulled=False)
    model = desk.state().model

    assert len(model.demonstrations) == 3
    assert former not in model.demonstrations


def test_a_recording_joins_the_others_when_what_was_to_be_shown_again_is_gone() -> None:
    document = taught()
    gone = Demonstration(document.demonstrations[0].demonstration.times, np.eye(60, 3))
    kept = drawn.added(document, drawn.TakenBack(gone), instead_of=gone)

    assert len(kept.demonstrations) == 4


def test_a_fix_of_what_is_gone_changes_nothing() -> None:
    document = taught()
    gone = document.demonstrations[0].demonstration
    without = edits.delete_demonstration(document, 0)

    assert advising.fixed(without, gone, "trim") is without


def test_nothing_taught_needs_no_advice() -> None:
    advice = found(Document("empty"))

    assert advice.notes == ()
    assert advice.suggestion is None


def test_the_disc_waits_while_something_is_pulled_or_asked() -> None:
    desk = desk_of()
    mouse = Mouse(desk)
    at_rest = wanted(desk.state())
    mouse.press("/reproductions/0")
    mouse.move((0.0, 0.0, -0.05))
    pulled = wanted(desk.state())
    mouse.release()
    mouse.wait(0.2)
    asked = wanted(desk.state())
    desk.amend(lambda amending: amending.answer(None, mouse.now))

    assert [at_rest, pulled, asked, wanted(desk.state())] == [True, False, False, True]


def test_the_disc_lies_across_the_motion() -> None:
    axis = np.array([0.6, 0.0, 0.8])
    vertices, faces = disc(axis)

    np.testing.assert_allclose(vertices @ axis, 0.0, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(vertices[:-1], axis=1), RADIUS, atol=1e-6)
    assert faces.max() == len(vertices) - 1


def test_one_thing_is_suggested_and_done_by_its_button(bench: Bench) -> None:
    paused = with_a_pause(reaching())
    slow = paused.demonstrations[1].demonstration
    bench.draw(state_of(paused))
    said = bench.client.text()
    buttons = [e for e in bench.client.gui if e.label == "Cut the pauses out"]
    for button in buttons:
        bench.client.send("GuiUpdateMessage", uuid=button.uuid, updates={"value": True})
    made = [bench.edited(paused).demonstrations[1].demonstration for _ in buttons]

    assert len(buttons) == 2  # as the one suggestion, and beside its demonstration
    assert "Slow one stands still for 1." in said
    assert max(one.times[-1] for one in made) < slow.times[-1] - 0.5


def press_first(bench: Bench, label: str) -> None:
    """Press the first of the buttons that say so."""
    button = next(e for e in bench.client.gui if e.label == label)
    bench.client.send("GuiUpdateMessage", uuid=button.uuid, updates={"value": True})


def test_the_button_of_what_must_be_shown_again_waits_for_it_and_can_be_taken_back(bench: Bench) -> None:
    document = reaching()
    one = document.demonstrations[0].demonstration
    tight = Postures(np.full(6, -0.01), np.full(6, 0.01), {one: np.zeros((len(one.times), 6))})
    state = bench.draw(replace(state_of(document), postures=tight))
    press_first(bench, "Show it again")
    asked = bench.notes.next()
    bench.draw(replace(state, view=replace(state.view, redo=one)))
    said = bench.client.text()
    press_first(bench, "Keep the old one")

    assert asked == ("look", (("redo", one),))
    assert f"takes the place of {one.name}" in said
    assert bench.notes.next() == ("look", (("redo", None),))


def test_suggestions_can_be_switched_off(bench: Bench) -> None:
    state = bench.draw(state_of(reaching(2)))
    bench.client.set_gui("Suggest what to do next", False)
    call = bench.notes.next()
    shown = "Show one through the red disc" in bench.client.text()
    bench.draw(replace(state, view=replace(state.view, suggest=False)))

    assert call == ("look", (("suggest", False),))
    assert shown
    assert "Show one through the red disc" not in bench.client.text()
