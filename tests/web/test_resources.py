"""Where the files that are not code are found."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.resources import MissingResourcesError, static_folder
from tests.web.site import ROOT


def test_in_a_checkout_it_is_the_folder_beside_app() -> None:
    assert static_folder() == ROOT / "static"


def test_in_a_wheel_it_is_the_folder_inside_app(tmp_path: Path) -> None:
    (tmp_path / "app" / "static").mkdir(parents=True)
    (tmp_path / "static").mkdir()
    assert static_folder(tmp_path / "app") == tmp_path / "app" / "static"


def test_a_broken_installation_says_so(tmp_path: Path) -> None:
    with pytest.raises(MissingResourcesError, match="Install gc-teach again"):
        static_folder(tmp_path / "app")
