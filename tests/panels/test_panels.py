"""Every control posts the right action, and panels show the state without echoing it."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app import edits
from app.document import Document, Shown, View
from app.panels.menu import distinct
from app.shapes import shapes_of
from app.store import Hand, Offer, Playback
from gc_core import Constraint
from tests.panels.desk import Bench, reach, state_of, taught


def offered(summary: str) -> Offer:
    return Offer("paths.csv", summary, "cm", "It is large.", "as recorded", "It is near.")


def test_undo_and_redo_name_the_step(bench: Bench) -> None:
    bench.draw(state_of(taught(), undo_name="move goal", redo_name="mute Reach 1"))
    bench.client.press("Undo: move goal")
    bench.client.press("Redo: mute Reach 1")

    assert [bench.notes.next(), bench.notes.next()] == [("undo", ()), ("redo", ())]


def test_undo_cannot_be_pressed_when_there_is_nothing_to_undo(bench: Bench) -> None:
    bench.draw(state_of(taught(), undo_name=None))

    assert not bench.client.element("Undo", "Button").usable


def test_a_new_title_renames_the_skill(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    bench.client.set_gui("Skill", "My reach")

    assert bench.edited(state.document).title == "My reach"


def test_a_title_that_is_being_typed_is_not_overwritten_by_its_beginning(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    for text in ("Pou", "Pour ", "Pour w"):
        bench.client.set_gui("Skill", text)
        renamed = bench.edited(state.document)
    bench.draw(state_of(replace(state.document, title="Pou"), state.model))
    shown_while_typing = bench.client.value("Skill")
    bench.draw(state_of(renamed, state.model))

    assert (shown_while_typing, bench.client.value("Skill")) == ("Pour w", "Pour w")


def test_an_empty_title_is_not_posted(bench: Bench) -> None:
    bench.draw(state_of(taught()))
    bench.client.set_gui("Skill", "  ")

    assert bench.only_undo_is_posted()


@pytest.mark.parametrize(("shown", "name"), [("Needle", "needle"), ("Teach your own", "")])
def test_the_menu_opens_a_skill(bench: Bench, shown: str, name: str) -> None:
    bench.draw(state_of(taught()))
    bench.client.set_gui("Open", shown)

    assert bench.notes.next() == ("open_skill", (name,))


def test_the_menu_offers_itself_again_after_a_choice(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    offered = bench.client.value("Open")
    bench.client.set_gui("Open", "Needle")
    bench.notes.next()
    bench.draw(state)

    assert bench.client.value("Open") == offered


def test_an_option_that_is_not_offered_is_dropped(bench: Bench) -> None:
    bench.draw(state_of(taught()))
    bench.client.set_gui("Open", "../../etc")

    assert bench.only_undo_is_posted()


def test_the_list_follows_the_demonstrations(bench: Bench) -> None:
    five = bench.draw(state_of(taught()))
    rows = [e for e in bench.client.gui if e.kind == "Folder" and e.label.startswith("Reach ")]
    bench.draw(state_of(edits.delete_demonstration(five.document, 1), five.model))
    fewer = [
        e.label for e in bench.client.gui if e.kind == "Folder" and e.label.startswith("Reach ") and e.usable
    ]
    bench.draw(five)
    again = [e for e in bench.client.gui if e.kind == "Folder" and e.label.startswith("Reach ")]

    assert [len(rows), len(fewer)] == [5, 4]
    assert "Reach 2 · 3.0 s" not in fewer
    assert [e.uuid for e in again] == [e.uuid for e in rows]


def test_the_list_holds_what_is_kept_and_not_what_is_being_drawn(bench: Bench) -> None:
    bench.draw(state_of(taught(3)))
    drawn = state_of(taught(4))

    def listed() -> int:
        folders = (e for e in bench.client.gui if e.kind == "Folder" and e.usable)
        return sum(e.label.startswith("Reach ") for e in folders)

    bench.draw(replace(drawn, dragging="/hand"))
    before = listed()
    bench.draw(drawn)

    assert (before, listed()) == (3, 4)


@pytest.mark.parametrize(
    ("option", "names"),
    [("Duplicate", ["Reach 1", "Reach 1 (copy)"]), ("Delete", [])],
)
def test_a_row_duplicates_and_deletes(bench: Bench, option: str, names: list[str]) -> None:
    state = bench.draw(state_of(taught(1)))
    bench.client.press(option)

    assert [s.demonstration.name for s in bench.edited(state.document).demonstrations] == names


def test_deleting_twice_deletes_one(bench: Bench) -> None:
    one = edits.delete_demonstration(taught(2), 1)
    bench.draw(state_of(one))
    bench.client.press("Delete")
    bench.client.press("Delete")
    two = edits.add_demonstrations(one, [taught(3).demonstrations[2].demonstration])

    assert len(bench.edited(bench.edited(two)).demonstrations) == 1


def test_a_demonstration_is_muted_and_renamed(bench: Bench) -> None:
    state = bench.draw(state_of(taught(1)))
    bench.client.set_gui("Learn from it", False)
    muted = bench.edited(state.document)
    bench.client.set_gui("Name", "Slow")
    renamed = bench.edited(muted)

    assert (renamed.demonstrations[0].muted, renamed.demonstrations[0].demonstration.name) == (True, "Slow")


def test_what_is_typed_is_for_the_demonstration_of_its_row_and_not_for_one_in_its_place(bench: Bench) -> None:
    (shown,) = bench.draw(state_of(taught(1))).document.demonstrations
    bench.client.set_gui("Name", "Slo")
    bench.client.set_gui("Name", "Slow")
    bench.client.set_gui("Learn from it", False)
    document = Document("Reaching", demonstrations=(other := Shown(reach(1)), shown))
    for _ in range(3):
        document = bench.edited(document)
    first, last = document.demonstrations

    assert first is other
    assert (last.demonstration.name, last.muted) == ("Slow", True)


def test_trim_keeps_the_chosen_part(bench: Bench) -> None:
    state = bench.draw(state_of(taught(1)))
    bench.client.set_gui("Keep [s]", (0.5, 2.5))
    bench.client.press("Trim")
    trimmed = bench.edited(state.document).demonstrations[0].demonstration

    assert trimmed.times[-1] == pytest.approx(2.0, abs=0.08)  # two samples


@pytest.mark.parametrize("part", [(-1.0, 2.0), (2.0, 1.0), (0.0, 99.0), (float("nan"), 1.0)])
def test_a_part_outside_of_the_demonstration_is_dropped(bench: Bench, part: tuple[float, float]) -> None:
    state = bench.draw(state_of(taught(1)))
    bench.client.set_gui("Keep [s]", part)
    bench.client.press("Trim")

    assert bench.edited(state.document) is state.document


def test_an_uploaded_file_is_offered(bench: Bench) -> None:
    bench.draw(state_of(taught()))
    bench.client.upload("Add a recording…", "paths.csv", b"0,0,0")

    assert bench.notes.next() == ("offer_file", ("paths.csv", b"0,0,0"))


def test_an_offer_is_accepted_as_the_person_says(bench: Bench) -> None:
    offer = offered("2 demonstrations <of> 3 s")
    bench.draw(state_of(taught(), offer=offer))
    bench.client.set_gui("Unit", "mm")
    bench.client.set_gui("Place", "moved in front of the arm")
    bench.client.press("Add")

    assert "&lt;of&gt;" in bench.client.text()
    assert bench.notes.next() == ("accept_file", ("mm", "moved in front of the arm"))


def test_an_offer_can_be_declined(bench: Bench) -> None:
    bench.draw(state_of(taught(), offer=offered("1 demonstration")))
    bench.client.press("Cancel")

    assert bench.notes.next() == ("decline_file", ())


def test_the_hand_moves_to_typed_centimetres(bench: Bench) -> None:
    exact = np.array([0.2012345, -0.3, 0.4])
    bench.draw(state_of(taught(), hand=Hand(np.zeros(6), exact)))
    bench.client.set_gui("Hand [cm]", (20.1, -25.0, 40.0))
    name, (position,) = bench.notes.next()

    assert name == "move_hand"
    np.testing.assert_array_equal(position, [0.2012345, -0.25, 0.4])


@pytest.mark.parametrize("value", [(1e9, 0.0, 0.0), (float("nan"), 0.0, 0.0), (float("inf"), 0.0, 0.0)])
def test_a_place_that_is_none_is_dropped_and_the_field_shows_the_truth(
    bench: Bench, value: tuple[float, float, float]
) -> None:
    state = bench.draw(state_of(taught()))
    bench.client.set_gui("Hand [cm]", value)
    posted_nothing = bench.only_undo_is_posted()
    bench.draw(state)

    assert posted_nothing
    assert tuple(bench.client.value("Hand [cm]")) == (20.0, -30.0, 40.0)


def test_the_tick_opens_and_closes_the_hand(bench: Bench) -> None:
    bench.draw(state_of(taught()))
    bench.client.set_gui("Hand closed", True)

    assert bench.notes.next() == ("toggle_gripper", ())


@pytest.mark.parametrize(("option", "step"), [("+ x", (0.01, 0, 0)), ("− z", (0, 0, -0.01))])
def test_a_jog_moves_the_hand_one_centimetre(bench: Bench, option: str, step: tuple[float, ...]) -> None:
    bench.draw(state_of(taught()))
    bench.client.press(option)
    name, (by,) = bench.notes.next()

    assert name == "nudge_hand"
    np.testing.assert_allclose(by, step)


def test_the_chosen_section_kind_is_the_one_that_stands_out(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    before = bench.client.element("Circle").props["color"]
    bench.client.press("Circle")
    chosen = bench.edited(state.document)
    bench.draw(state_of(chosen, state.model))

    assert chosen.settings.section == "circle"
    assert bench.client.element("Circle").props["color"] != before
    assert bench.client.element("Ellipse").props["color"] == before


def test_the_skill_is_shown_in_every_kind_and_each_picture_is_the_label_of_its_button(bench: Bench) -> None:
    state = state_of(taught())
    bench.draw(replace(state, shapes=shapes_of(state.model)))
    text = bench.client.text()

    for label in ("Circle", "Ellipse", "Free shape"):
        assert f'<label for="{bench.client.element(label, "Button").uuid}"' in text
    assert text.count("&times; tightest") == 3


def pictures(text: str) -> list[str]:
    """What stands on the cards, one a kind."""
    return re.findall(r"<b>[^<]*</b><br>[^<]*tightest", text)


def test_pictures_stay_as_they_are_while_something_is_pulled(bench: Bench) -> None:
    state = state_of(taught())
    bench.draw(replace(state, shapes=shapes_of(state.model)))
    before = bench.client.text()
    other = state_of(taught(3))
    bench.draw(replace(other, shapes=shapes_of(other.model), dragging="/demonstrations/0"))

    assert pictures(before) == pictures(bench.client.text()) != []


def test_an_empty_skill_has_no_pictures_and_can_choose_a_kind_all_the_same(bench: Bench) -> None:
    full = state_of(taught())
    state = bench.draw(replace(state_of(taught(0)), shapes=shapes_of(full.model)))
    bench.client.press("Circle")

    assert "tightest" not in bench.client.text()
    assert bench.edited(state.document).settings.section == "circle"


def test_alignment_and_number_of_slices_are_settings(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    bench.client.set_gui("Match by", "time")
    document = bench.edited(state.document)
    bench.client.set_gui("Slices", 60)
    settings = bench.edited(document).settings

    assert (settings.align_by, settings.stations) == ("time", 60)


@pytest.mark.parametrize("value", [0, 10_000, -5])
def test_a_number_of_slices_out_of_range_is_dropped_and_the_slider_returns(bench: Bench, value: int) -> None:
    state = bench.draw(state_of(taught()))
    bench.client.set_gui("Slices", value)
    posted_nothing = bench.only_undo_is_posted()
    bench.draw(state)

    assert posted_nothing
    assert bench.client.value("Slices") == state.document.settings.stations


def test_a_typed_start_becomes_the_persons_own(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    bench.client.set_gui("Start 1 [cm]", (30.0, -30.0, 55.0))

    np.testing.assert_allclose(bench.edited(state.document).starts, [(0.30, -0.30, 0.55)])


def test_another_start_keeps_the_first_and_lies_in_the_tube(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    bench.client.press("Add another start")
    grown = state_of(bench.edited(state.document), state.model)

    np.testing.assert_array_equal(grown.model.runs[0].start, state.model.runs[0].start)
    assert len(grown.model.runs) == 2
    assert grown.model.runs[1].reproduction.start_inside


def test_a_start_is_played_and_removed(bench: Bench) -> None:
    document = edits.add_start(taught(), np.array([0.3, -0.3, 0.55]))
    bench.draw(state_of(document))
    bench.client.press("Play this one")
    played = [bench.notes.next(), bench.notes.next()]
    bench.client.press("Remove")

    assert played == [("choose_run", (0,)), ("play", (True,))]
    assert bench.edited(document).starts == ()


def test_how_far_off_centre_the_run_is_is_said_in_words(bench: Bench) -> None:
    bench.draw(state_of(taught()))

    assert "50 % of the way from the middle line to the edge" in bench.client.text()


def test_a_landmark_is_moved_and_put_back(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    goal = 100.0 * state.model.anchors[1].now
    bench.client.set_gui(
        "Goal [cm]", (float(goal[0]) + 12.0, round(float(goal[1]), 1), round(float(goal[2]), 1))
    )
    moved = bench.edited(state.document)
    bench.draw(state_of(moved, state.model))
    assert any(element.label == "Goal · moved by 12 cm" for element in bench.client.gui)
    bench.client.press("Put goal back")

    assert bench.edited(moved).landmarks[1].now is None


def test_the_width_of_a_pull_is_only_looked_at(bench: Bench) -> None:
    bench.draw(state_of(taught()))
    bench.client.set_gui("Pull width [cm]", 35.0)

    assert bench.notes.next() == ("look", (("pull_width", 0.35),))


def test_a_name_reaches_the_rule_that_it_was_typed_for_whatever_was_deleted_meanwhile(bench: Bench) -> None:
    state = state_of(taught())
    run = np.array(state.model.runs[0].reproduction.positions)
    rule = Constraint.from_correction(run, run - [0.0, 0.0, 0.05])
    other = Constraint.from_correction(run, run - [0.0, 0.0, -0.05])
    bench.draw(state_of(edits.add_rule(state.document, rule, "Low"), state.model))
    bench.client.set_gui("Rule's name", "Lower")
    both = edits.add_rule(edits.add_rule(state.document, other, "Lid"), rule, "Low")

    assert [rule.name for rule in bench.edited(both).rules] == ["Lid", "Lower"]


def test_a_rule_is_switched_off_and_on_and_says_what_it_does(bench: Bench) -> None:
    state = state_of(taught())
    run = np.array(state.model.runs[0].reproduction.positions)
    lower = run - [0.0, 0.0, 0.05] * np.sin(np.linspace(0, np.pi, len(run)))[:, None]
    document = edits.add_rule(
        state.document, Constraint.from_correction(run, lower), "Low" + 20 * " and lower"
    )
    bench.draw(state_of(document, state.model))
    held = bench.client.text()
    bench.client.set_gui("On", False)
    off = bench.edited(document)
    bench.draw(state_of(off, state.model))
    labels = [e.label for e in bench.client.gui]
    bench.client.set_gui("On", True)
    on = bench.edited(off)

    assert ([r.enabled for r in off.rules], [r.enabled for r in on.rules]) == ([False], [True])
    assert f"{document.rules[0].name[:29]}… · off" in labels
    assert "% of the way. It holds" in held
    assert "It holds the run back, by up to 5.0 cm." in held
    assert "It is off" in bench.client.text()


@pytest.mark.parametrize(("playing", "option"), [(False, "Play"), (True, "Pause")])
def test_the_play_button_says_what_it_will_do(bench: Bench, playing: bool, option: str) -> None:
    bench.draw(state_of(taught(), playback=Playback(1.0, 3.0, playing)))
    bench.client.press(option)

    assert bench.notes.next() == ("play", (not playing,))


def test_scrubbing_seeks(bench: Bench) -> None:
    bench.draw(state_of(taught()))
    bench.client.set_gui("Time [s]", 1.5)

    assert bench.notes.next() == ("seek", (1.5,))


@pytest.mark.parametrize("time", [-1.0, 1e6, float("nan")])
def test_a_time_outside_of_the_run_is_dropped_and_the_slider_returns(bench: Bench, time: float) -> None:
    state = bench.draw(state_of(taught()))
    bench.client.set_gui("Time [s]", time)
    posted_nothing = bench.only_undo_is_posted()
    bench.draw(state)

    assert posted_nothing
    assert bench.client.value("Time [s]") == pytest.approx(state.playback.time, abs=0.01)


def test_speed_and_loop_are_chosen_in_one_row(bench: Bench) -> None:
    bench.draw(state_of(taught(), view=View(speed=1.0, loop=True)))
    bench.client.press("¼×")
    bench.client.press("✓ Loop")

    assert [bench.notes.next(), bench.notes.next()] == [
        ("look", (("speed", 0.25),)),
        ("look", (("loop", False),)),
    ]


def test_runs_are_chosen_only_when_there_are_several(bench: Bench) -> None:
    one = state_of(taught())
    bench.draw(one)
    alone = bench.client.element("Run").usable
    two = edits.add_start(edits.add_start(taught(), np.array([0.3, -0.3, 0.5])), np.array([0.2, -0.3, 0.5]))
    bench.draw(state_of(two))
    bench.client.press("2")

    assert not alone
    assert bench.notes.next() == ("choose_run", (1,))


@pytest.mark.parametrize(
    ("label", "call"),
    [
        ("Undo", ("undo", ())),
        ("Redo", ("redo", ())),
        ("Play or pause", ("play", (True,))),
        ("Open or close the hand", ("toggle_gripper", ())),
    ],
)
def test_keys_do_what_they_say(bench: Bench, label: str, call: object) -> None:
    bench.draw(state_of(taught()))
    bench.client.trigger(label)

    assert bench.notes.next() == call


def test_drawing_posts_nothing(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    document = edits.set_stations(
        edits.rename_skill(edits.delete_demonstration(state.document, 0), "Other"), 100
    )
    view = View(pull_width=0.1, gripper_closed=True, speed=2.0, loop=False, show_tube=False)
    bench.draw(state_of(document, view=view, hand=Hand(np.zeros(6), np.array([0.1, 0.1, 0.1]))))

    assert bench.client.value("Skill") == "Other"
    assert bench.only_undo_is_posted()


def test_an_unchanged_state_sends_nothing(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    before = bench.client.messages_received
    bench.draw(state)
    bench.draw(replace(state, hand=replace(state.hand)))

    assert bench.client.messages_received == before + 2  # the marks of the two drawings


def test_a_moved_playhead_sends_little(bench: Bench) -> None:
    state = bench.draw(state_of(taught()))
    before = bench.client.bytes_received
    bench.draw(replace(state, playback=replace(state.playback, time=0.5 * state.playback.duration)))

    assert 0 < bench.client.bytes_received - before < 12_000


def test_what_a_person_wrote_is_shown_as_text(bench: Bench) -> None:
    state = state_of(replace(taught(), about="<img src=x onerror=alert(1)>"), message="<b>bold</b>")
    bench.draw(state)
    text = bench.client.text()

    assert "<img" not in text
    assert "<b>" not in text


def test_nothing_to_learn_from_is_no_empty_screen(bench: Bench) -> None:
    bench.draw(state_of(taught(0)))
    text = bench.client.text()

    assert "Hold the hand" in text
    assert "its slices appear here" in text


@pytest.mark.benchmark
def test_an_unchanged_draw_is_cheap(bench: Bench, benchmark) -> None:
    state = bench.draw(state_of(taught()))

    benchmark(bench.panels.draw, state)


@given(st.lists(st.sampled_from(["move goal", "move goal (2)", "move goal (2) (2)", "add start"])))
def test_what_a_menu_offers_is_told_apart_and_keeps_its_name_when_something_newer_comes(
    names: list[str],
) -> None:
    labels = distinct(names)

    assert len(set(labels)) == len(names)
    assert distinct(["move goal", *names])[1:] == labels
