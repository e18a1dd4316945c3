"""Two different facts are two different sentences, each with its numbers."""

from __future__ import annotations

import numpy as np

from app.arm import FloatArray, urdf
from app.arm.physics_report import Carried, Contact, Distances, Encounter, Playback
from app.arm.physics_words import clear_of_things, inside_tube, met, part_in_words, played

FOREARM = f"{urdf.PREFIX}link_3"
TIMES = np.array([0.0, 1.0, 2.0])


def clearance(*along: float) -> Distances:
    return Distances((FOREARM,), ("box",), np.array(along)[:, None, None])


def playback(errors: FloatArray, contacts: tuple[Contact, ...], carried: tuple[Carried, ...]) -> Playback:
    empty = np.zeros((3, 6))
    return Playback(TIMES, empty, empty[:, :3], errors, empty[0], empty[0], contacts, carried, {})


def test_a_hand_inside_the_tube_says_nothing_of_the_arm() -> None:
    assert inside_tube([0.2, 1.0, 0.9], TIMES) == "The hand stays inside the tube."


def test_a_hand_outside_the_tube_says_when_and_how_far() -> None:
    assert inside_tube([0.2, 1.1, 1.5], TIMES) == (
        "The hand leaves the tube at 1.0 s; at 2.0 s it is 50 % of the radius outside."
    )


def test_a_clear_arm_says_by_how_much_and_where_it_is_nearest() -> None:
    assert clear_of_things(clearance(0.2, 0.031, 0.1), TIMES) == (
        "The whole arm clears the box by 3.1 cm; its forearm comes nearest, at 1.0 s."
    )


def test_an_arm_in_a_thing_says_how_deep_and_what_to_do() -> None:
    assert clear_of_things(clearance(0.2, 0.1, -0.012), TIMES) == (
        "The forearm would be 1.2 cm deep in the box at 2.0 s. Move the box or lead the path around it."
    )


def test_an_arm_alone_has_nothing_to_keep_clear_of() -> None:
    assert "nothing" in clear_of_things(Distances((FOREARM,), (), np.empty((3, 1, 0))), TIMES)


def test_an_encounter_has_link_thing_time_and_depth() -> None:
    assert met(Encounter(FOREARM, "box", 1.0, 1.5, 2.0, 0.004)) == (
        "The forearm would go through the box from 1.0 s to 2.0 s, 4.0 mm deep at 1.5 s."
    )


def test_a_playback_that_followed_says_how_well() -> None:
    assert played(playback(np.array([0.0, 0.0007, 0.0]), (), ())) == ("The arm follows the path to 0.7 mm.",)


def test_a_playback_says_where_it_fell_behind_what_it_touched_and_what_it_carried() -> None:
    contact = Contact(FOREARM, "box", 1.0, 2.0, 40.2, 1e-4)
    said = played(playback(np.array([0.0, 0.0, 0.12]), (contact,), (Carried("ball", 0.5, None),)))

    assert said == (
        "The arm cannot follow: at 2.0 s its hand is 12.0 cm from where it should be.",
        "The forearm touches the box at 1.0 s with up to 40 N.",
        "The hand carries the ball from 0.5 s to the end.",
    )


def test_every_link_has_a_name_that_people_know() -> None:
    assert {part_in_words(link) for link in urdf.MOVING_LINKS} == {
        "shoulder", "upper arm", "forearm", "wrist", "hand",
    }  # fmt: skip
    assert part_in_words(f"{urdf.PREFIX}link_finger_tip_2") == "finger"
