"""For every test: the browser's fixtures, and the browser stories after everything faster."""

from __future__ import annotations

import hypothesis
import pytest

from tests.support.chromium import chromium, open_page

# Laws are not timed, since the machine may be busy, and try the same examples each time, since whether a
# change may land must not be luck; `--hypothesis-profile=search` looks for new ones.
hypothesis.settings.register_profile("same", deadline=None, derandomize=True)
hypothesis.settings.register_profile("search", deadline=None)
hypothesis.settings.load_profile("same")

__all__ = ["chromium", "open_page"]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Fastest first; playwright's loop also stays in the main thread once it runs."""
    items.sort(key=lambda item: item.get_closest_marker("browser") is not None)
