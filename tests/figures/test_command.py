"""``gc-teach figure``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.__main__ import main
from app.figures import FIGURES
from app.files import read, write
from app.resources import static_folder


def test_without_a_name_each_figure_is_explained(capsys: pytest.CaptureFixture[str]) -> None:
    main(["figure"])

    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(FIGURES)


def test_a_figure_of_a_file_is_written_where_it_is_wanted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "mine.csv"
    write(file, read(static_folder() / "skills" / "the_dip.csv", units="m"))

    main(["figure", "8", str(file), "--out", str(tmp_path / "new"), "--json"])

    said = json.loads(capsys.readouterr().out)
    assert said["about"] == "A skill with new runs. Drawn of 'mine'."
    assert said["files"] == [str(tmp_path / "new" / f"figure-8.{form}") for form in ("svg", "png")]
    assert (tmp_path / "new" / "figure-8.svg").read_bytes().startswith(b"<?xml")
    assert (tmp_path / "new" / "figure-8.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["3"], "There is no figure called '3'"),
        (["4", "no_such_skill"], "no built-in skill called"),
        (
            ["4", "--out", "figure.pdf"],
            "files that end in .pdf cannot be written here. Possible are: .svg, .png",
        ),
    ],
)
def test_what_cannot_be_made_is_said_in_a_sentence(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["figure", *arguments])

    assert stopped.value.code == 1
    assert words in capsys.readouterr().err
