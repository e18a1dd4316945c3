"""Fig. 9 in the browser: around an obstacle, from five starts, beside DMP and GMM/GMR."""

from __future__ import annotations

import pytest

from app.compared import LOOKS
from tests.baselines.makers import needs_gmr, needs_primitives
from tests.browser.conftest import Visit
from tests.browser.test_kinds import open_skill

pytestmark = pytest.mark.browser

FIG_9 = ("gc", "dmp-5", "dmp-10", "gmr-5", "gmr-10")
TABLE = ".gc-compare"


@needs_gmr
@needs_primitives
def test_around_an_obstacle_is_compared_in_words_in_a_table_and_in_the_scene(visit: Visit) -> None:
    tab = (person := visit()).tab
    before = person.work()
    open_skill(person, "Around an obstacle")
    person.wait_for_change(before, "/tube")
    person.open_tab("Compare")
    person.press_exactly("Compare")

    table = tab.page.locator(TABLE)
    tab.wait_until(lambda: table.count() == 1 and "Touch" in table.inner_text())
    tab.wait_until(lambda: "\u2026" not in table.inner_text())
    assert tab.shows("The tube keeps the 5 paths apart")
    assert tab.shows("DMP 5, DMP 10, GMR 5 and GMR 10 bring them together")
    assert table.locator("th").all_inner_texts()[1:] == [f"\n{LOOKS[name].label}" for name in FIG_9]
    touched = table.locator("tr", has_text="Touch").inner_text().split("\t")[1:]
    assert touched == ["0"] * len(FIG_9)
    for name in FIG_9:
        assert tab.visible(f"/compared/{name}/4")
    starts = [person.line(f"/compared/{name}/4")[0] for name in ("gc", "dmp-5", "dmp-10")]
    assert max(abs(start - starts[0]).max() for start in starts) < 1e-4

    tab.page.get_by_label("In the scene").click()
    tab.wait_until(lambda: not any(tab.visible(f"/compared/{name}/0") for name in FIG_9))
