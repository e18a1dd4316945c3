"""Methods side by side in a session: the newest question wins; what is known is true, or says that it was."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt
import pytest

from app import edits
from app.actor import Actor
from app.arm import Jaco, PlanarArm
from app.arm.conditions import Conditions
from app.arm.findings import Clearance
from app.baselines import Run
from app.compared import LOOKS, Compared
from app.comparing import Comparing, asked_for, steps
from app.comparison_svg import comparison_svg, plane
from app.desk import Desk
from app.document import Box, Document, Place, View
from app.model import learn
from app.scene.style import DEMONSTRATION, DIRECTRIX, REPRODUCTION
from app.skills import empty_skill, load_skill
from app.touching import clearances
from gc_core import GcError
from tests.panels.desk import taught

SKILLS = Path(__file__).resolve().parents[2] / "static" / "skills"
RAMP = View(methods=("ramp",))
PLACE = np.array([0.25, -0.30, 0.55])


class Now(Executor):
    """Runs what it is given at once."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Any:
        fn(*args, **kwargs)


class Mailbox(Actor):
    """Does at once what is posted, and counts it."""

    def __init__(self) -> None:
        self.posted = 0
        self.between: Callable[[], None] = lambda: None

    def post(self, action: Callable[[], None]) -> None:
        self.posted += 1
        action()
        self.between()


@pytest.fixture
def mailbox() -> Mailbox:
    return Mailbox()


@pytest.fixture
def comparing(mailbox: Mailbox) -> Comparing:
    return Comparing(Now(), mailbox, PlanarArm)


@pytest.fixture
def desk() -> Desk:
    desk = Desk(taught(), PlanarArm())
    desk.look(methods=("ramp",))
    return desk


def known(comparing: Comparing, desk: Desk) -> Compared:
    shown = comparing.follow(desk.state())
    assert shown is not None
    return shown


def known_of(document: Document, view: View = RAMP) -> list[Compared]:
    return list(steps(asked_for(learn(document), view), view.compare_count, PlanarArm))


def test_what_is_known_grows_method_by_method() -> None:
    told = known_of(taught())

    assert [len(each.found.rows) for each in told if each.found] == [0, 1, 2]
    assert [each.doing for each in told] == ["Tube: 1 of 2", "Ramp: 2 of 2", ""]
    assert [each.share for each in told] == [0.0, 0.5, 1.0]


def test_the_newest_comparison_wins_and_the_former_one_ends_early(
    comparing: Comparing, mailbox: Mailbox, desk: Desk
) -> None:
    def ask_anew() -> None:
        if mailbox.posted == 2:
            desk.look(methods=("ramp", "dmp-5"))
            comparing.begin(desk, 1.0)

    mailbox.between = ask_anew
    comparing.begin(desk, 0.0)

    assert known(comparing, desk).names == ("gc", "dmp-5", "ramp")
    assert known(comparing, desk).doing == ""
    assert mailbox.posted < 3 + 2 + 4 + 2


def test_a_changed_skill_makes_what_is_known_outdated_until_it_is_undone(
    comparing: Comparing, desk: Desk
) -> None:
    comparing.begin(desk, 0.0)
    fresh = known(comparing, desk)
    desk.edit(lambda d: edits.mute_demonstration(d, 0, True), "mute Reach 1", now=5.0)
    changed = known(comparing, desk)
    desk.undo(10.0)

    assert [fresh.outdated, changed.outdated, known(comparing, desk).outdated] == [False, True, False]


def test_a_start_of_try_matters_only_to_a_comparison_from_there(comparing: Comparing, desk: Desk) -> None:
    outdated = []
    for count in (5, 0):
        desk.look(compare_count=count)
        comparing.begin(desk, 0.0)
        desk.edit(lambda d: edits.add_start(d, PLACE), "add a start", now=5.0)
        outdated.append(known(comparing, desk).outdated)

    assert outdated == [False, True]


def test_from_the_starts_of_try_all_begin_there() -> None:
    document = edits.add_start(edits.add_start(taught(), PLACE), PLACE + 0.02)
    found = known_of(document, replace(RAMP, compare_count=0))[-1].found

    assert found is not None
    assert [run.positions[0].round(9).tolist() for run in found.runs["ramp"]] == [
        start.round(9).tolist() for start in document.starts
    ]


def test_a_title_or_a_place_of_the_goal_changes_nothing(comparing: Comparing, desk: Desk) -> None:
    comparing.begin(desk, 0.0)
    before = known(comparing, desk)
    desk.edit(lambda d: edits.rename_skill(d, "Mine"), "rename", now=5.0)
    desk.edit(lambda d: edits.move_landmark(d, "goal", PLACE), "move goal", now=9.0)

    assert known(comparing, desk) is before


def test_a_moved_obstacle_changes_what_the_arm_is_clear_of(comparing: Comparing, desk: Desk) -> None:
    desk.edit(
        lambda d: edits.add_landmark(d, "obstacle", Place("", taught=PLACE)), "add an obstacle", now=0.0
    )
    name = desk.store.document.landmarks[-1].name
    comparing.begin(desk, 2.0)
    fresh = known(comparing, desk)
    desk.edit(lambda d: edits.move_landmark(d, name, PLACE + 0.1), "move it", now=5.0)

    assert (fresh.outdated, known(comparing, desk).outdated) == (False, True)


def test_another_skill_shows_nothing_of_this_one(comparing: Comparing, desk: Desk) -> None:
    comparing.begin(desk, 0.0)
    desk.open(empty_skill(), 5.0)

    assert comparing.follow(desk.state()) is None


def test_pulling_on_something_stops_the_work(comparing: Comparing, mailbox: Mailbox, desk: Desk) -> None:
    def pull() -> None:
        if mailbox.posted == 1:
            comparing.follow(replace(desk.state(), dragging="/demonstrations/0"))

    mailbox.between = pull
    comparing.begin(desk, 0.0)
    shown = known(comparing, desk)

    assert (shown.doing, len(shown.found.rows) if shown.found else -1) == ("", 0)
    assert "stopped" in shown.problem


def test_work_that_breaks_down_is_not_shown_as_going_on(
    comparing: Comparing, desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.comparing.comparison_svg", {}.__getitem__)
    with pytest.raises(TypeError):
        comparing.begin(desk, 0.0)

    assert known(comparing, desk).doing == ""


def test_a_missing_package_is_said_in_its_row_and_the_others_go_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gmr", None)
    found = known_of(taught(), View(methods=("gmr-5", "ramp")))[-1].found

    assert found is not None
    assert ["pip install gmr" in (row.failed or "") for row in found.rows] == [False, True, False]


def test_what_no_method_can_learn_is_a_sentence(comparing: Comparing) -> None:
    (only,) = known_of(empty_skill())

    assert only.found is None
    assert only.problem.endswith(".")


@pytest.fixture
def jaco() -> Iterator[Jaco]:
    arm = Jaco()
    yield arm
    arm.close()


def test_what_touches_only_the_upper_arm_counts_as_a_contact(jaco: Jaco) -> None:
    run = Run(np.arange(2.0), np.array([[0.0, -0.5, 0.3], [0.05, -0.5, 0.3]]))
    shoulder = Box("box", (0.0, 0.0, 0.3), (0.1, 0.1, 0.1))
    arm = jaco.under(Conditions((shoulder,)))

    assert clearances((run,), (shoulder,))[0] > 0.3
    assert clearances((run,), (shoulder,), arm)[0] < 0.0


def test_the_arm_is_asked_after_all_methods_have_answered(jaco: Jaco) -> None:
    document = load_skill(SKILLS, "around_an_obstacle")
    view = replace(RAMP, compare_count=2)
    told = list(steps(asked_for(learn(document), view), 2, lambda: jaco))
    clear = [[row.clearance_m is not None for row in each.found.rows] for each in told if each.found]

    assert clear == [[], [False], [False, False], [True, False], [True, True]]
    assert told[3].doing == "Ramp: the arm is led along it, 2 of 2"


class Lame(PlanarArm):
    """The tiny arm, which cannot say how clear it is."""

    def clearance(self, joints: npt.ArrayLike) -> Clearance:  # noqa: ARG002 - as the protocol has it
        raise GcError("The arm does not answer.")


def test_what_is_known_already_stays_when_the_work_ends_early() -> None:
    heeded = Conditions((Box("box", (0.0, 0.0, 0.3), (0.1, 0.1, 0.1)),))
    asked = replace(asked_for(learn(taught()), RAMP), heeded=heeded)
    last = list(steps(asked, 5, Lame))[-1]

    assert (last.problem, last.doing) == ("The arm does not answer.", "")
    assert last.found is not None
    assert [row.method for row in last.found.rows] == ["gc", "ramp"]


# What different kinds of cones make of light, in linear RGB: Vienot, Brettel and Mollon 1999.
SEEN_BY = {
    "everybody else": np.eye(3),
    "no red cones": np.array([[0.11238, 0.88762, 0.0], [0.11238, 0.88762, 0.0], [0.00401, -0.00401, 1.0]]),
    "no green cones": np.array([[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]]),
}


def lab(color: tuple[int, int, int], seen: np.ndarray) -> np.ndarray:
    """CIE L*a*b* of what is seen of a colour."""
    share = np.asarray(color) / 255.0
    linear = np.clip(
        seen @ np.where(share > 0.04045, ((share + 0.055) / 1.055) ** 2.4, share / 12.92), 0.0, 1.0
    )
    to_xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    x, y, z = np.cbrt(to_xyz @ np.clip(seen @ linear, 0.0, 1.0) / [0.9505, 1.0, 1.089])
    return np.array([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])


@pytest.mark.parametrize("eyes", SEEN_BY)
def test_colours_of_methods_are_told_apart(eyes: str) -> None:
    colors = [DEMONSTRATION, DIRECTRIX, *(look.color for look in LOOKS.values())]
    seen = [lab(color, SEEN_BY[eyes]) for color in colors]

    assert min(np.linalg.norm(one - other) for one, other in combinations(seen, 2)) > 15.0


def test_the_tube_looks_like_every_run() -> None:
    assert LOOKS["gc"].color == REPRODUCTION


def test_every_method_has_a_drawing_with_its_name_and_as_many_runs_as_starts() -> None:
    last = known_of(taught())[-1]
    assert last.found is not None
    drawing = ElementTree.fromstring(comparison_svg(last.found, last.source.demonstrations, last.names))
    space = "{http://www.w3.org/2000/svg}"
    runs = [p.get("d", "").count("M") for p in drawing.iter(f"{space}path") if p.get("stroke-width") == "8"]

    assert [text.text for text in drawing.iter(f"{space}text")] == ["Tube", "Ramp"]
    assert runs == [5, 5]


def test_a_motion_is_seen_across_its_thinnest_direction_with_up_upwards() -> None:
    turn = np.linspace(0.0, 6.0, 50)
    upright = np.stack([np.cos(turn), 0.01 * np.sin(3.0 * turn), 0.5 * np.sin(turn)], axis=1)
    right, up = plane(upright)

    np.testing.assert_allclose(up, [0.0, 0.0, 1.0], atol=0.02)
    np.testing.assert_allclose(right, [1.0, 0.0, 0.0], atol=0.02)  # as from the front
