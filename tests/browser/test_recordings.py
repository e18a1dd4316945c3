"""A recording from a file, through the file chooser."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.browser.person import Person

pytestmark = pytest.mark.browser


def recording(path: Path) -> tuple[Path, np.ndarray]:
    """Two demonstrations in front of the arm; the file, and the points of the first one (n, 3) [m]."""
    u = np.linspace(0.0, 1.0, 60)
    rows = ["t,x,y,z,demo"]
    shown = []
    for number in range(2):
        aside = 0.04 * number * (1.0 - u)
        points = np.stack([0.3 - 0.4 * u, -0.35 - 0.25 * u + aside, 0.4 - 0.3 * u * u], axis=1)
        rows += [
            f"{3 * t:.4f},{x:.5f},{y:.5f},{z:.5f},{number}" for t, (x, y, z) in zip(u, points, strict=True)
        ]
        shown.append(points)
    path.write_text("\n".join(rows))
    return path, shown[0]


def choose(person: Person, file: Path) -> None:
    with person.tab.page.expect_file_chooser() as chooser:
        person.tab.press("Add a recording")
    chooser.value.set_files(str(file))


def test_a_recording_is_shown_with_its_units_before_it_is_accepted(guest: Person, tmp_path: Path) -> None:
    tab = (person := guest).tab
    person.pause()
    before = person.work()
    file, points = recording(tmp_path / "wave.csv")

    choose(person, file)
    tab.wait_until(lambda: tab.shows("wave.csv: 2 demonstrations"))
    assert tab.shows("Unit")
    assert tab.shows("Place")
    assert not person.changed(before, person.work())
    person.press_exactly("Add")

    tab.wait_until(lambda: {name for name in person.work() if "demonstrations" in name} == NEW)
    tab.wait_drawn()
    np.testing.assert_allclose(person.line("/demonstrations/0/line")[[0, -1]], points[[0, -1]], atol=1e-4)
    assert {"/tube", "/reproductions/0/line"} <= set(person.work())
    person.undo()
    person.wait_for_work(before)


NEW = {"/demonstrations/0/line", "/demonstrations/1/line"}


def test_a_file_that_is_no_recording_gets_a_sentence(guest: Person, tmp_path: Path) -> None:
    tab = (person := guest).tab
    person.pause()
    before = person.work()
    file = tmp_path / "notes.txt"
    file.write_text("dear diary")

    choose(person, file)

    tab.wait_until(lambda: tab.shows("notes.txt"))
    tab.wait_until(lambda: ".csv" in tab.page.locator('[role="status"]').inner_text())
    assert not person.changed(before, person.work())
