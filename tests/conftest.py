"""For every test: the browser's fixtures, and the browser stories after everything faster."""

from __future__ import annotations

import hypothesis
import pytest

from tests.support.chromium import chromium, open_page

# Laws are not timed: the machine may be busy.
hypothesis.settings.register_profile("untimed", deadline=None)
hypothesis.settings.load_profile("untimed")

__all__ = ["chromium", "open_page"]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Fastest first; playwright's loop also stays in the main thread once it runs."""
    items.sort(key=lambda item: item.get_closest_marker("browser") is not None)
