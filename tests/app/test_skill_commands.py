"""``gc-teach skills``: what each command says and does, by name, code and built-in name."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from app.__main__ import main
from app.exports import pack, unpack
from app.library import Library
from gc_core import same_content
from tests.app.makers import furnished, taught
from tests.app.site import library_in
from tests.files.makers import GOOD

CODE = "a-code-of-mine-1"


@pytest.fixture
def library(tmp_path: Path) -> str:
    """One saved skill, called Reaching as a built-in one is, too."""
    url = library_in(tmp_path)
    shelf = Library(url)
    shelf.save(CODE, furnished())
    shelf.save("pouring-code-0001", taught(2))
    shelf.close()
    return url


@pytest.fixture
def skills(library: str, capsys: pytest.CaptureFixture[str]) -> Any:
    """Run a command; give its JSON, or what it says on the error stream when it ends with 1."""

    def run(*words: str) -> Any:
        capsys.readouterr()
        try:
            main(["skills", *words, "--library", library, "--json"])
        except SystemExit as end:
            return capsys.readouterr().err.strip() if end.code == 1 else end
        return json.loads(capsys.readouterr().out)

    return run


def test_list_names_saved_skills_first_and_then_those_that_are_built_in(skills: Any) -> None:
    found = skills("list")

    assert {one["code"] for one in found[:2]} == {CODE, "pouring-code-0001"}
    assert all(one["built_in"] and one["updated"] is None for one in found[2:])
    assert "needle" in {one["code"] for one in found[2:]}


def test_what_is_exported_and_imported_under_another_name_is_the_same_skill(
    skills: Any, library: str, tmp_path: Path
) -> None:
    out = tmp_path / "mine.gcteach"
    assert skills("export", CODE, "--to", str(out))["bytes"] == out.stat().st_size

    made = skills("import", str(out), "--name", "Pouring")

    saved = Library(library).load(made["code"])
    assert saved is not None
    assert (saved.title, made["address"]) == ("Pouring", f"/s/{made['code']}")
    assert same_content(saved.demonstrations, furnished().demonstrations)
    assert same_content(unpack("a.gcteach", out.read_bytes()), furnished())


def test_recordings_are_imported_as_a_skill_called_like_the_file(skills: Any, tmp_path: Path) -> None:
    path = tmp_path / "stirring.csv"
    path.write_bytes(GOOD["a.csv"])

    assert skills("import", str(path))["title"] == "stirring"
    assert [one["samples"] for one in skills("show", "Stirring")["demonstrations"]] == [20]


def test_show_says_what_a_skill_is_made_of(skills: Any) -> None:
    facts = skills("show", CODE)

    assert (facts["title"], len(facts["demonstrations"]), facts["rules"]) == ("Reaching", 3, ["Lid"])
    assert facts["things"] == ["crate", "can"]


def test_a_name_that_several_skills_have_is_not_guessed_at(skills: Any) -> None:
    said = skills("show", "reaching ")

    assert "3 skills are called reaching" in said
    assert CODE in said
    assert skills("show", "reaching")["built_in"]  # the exact name of a built-in one is its code


def test_an_unknown_name_is_said_to_be_unknown(skills: Any) -> None:
    assert "There is no skill called juggling" in skills("delete", "juggling")


def test_a_deleted_skill_is_gone_from_the_list(skills: Any) -> None:
    skills("delete", CODE)

    assert CODE not in {one["code"] for one in skills("list")}


def test_a_built_in_skill_stays(skills: Any) -> None:
    assert "built in and stays" in skills("delete", "needle")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("export", "needle", "--to", "needle.docx"), ".gcteach, .html"),
        (("export", "needle", "--to", "/nowhere/at/all.csv"), "cannot be written"),
        (("import", "gone.gcteach"), "no file gone.gcteach"),
        (("import", "gone.csv"), "no file gone.csv"),
    ],
)
def test_what_cannot_be_done_is_said_in_a_sentence(skills: Any, words: tuple[str, ...], said: str) -> None:
    assert said in skills(*words)


def test_a_file_that_is_there_is_replaced_only_when_that_is_wanted(skills: Any, tmp_path: Path) -> None:
    path = tmp_path / "mine.csv"
    path.write_text("precious")

    assert "is there already" in skills("export", CODE, "--to", str(path))
    assert path.read_text() == "precious"
    assert skills("export", CODE, "--to", str(path), "--force")["bytes"] == path.stat().st_size


def test_a_skill_under_the_ending_of_numbers_is_said_to_be_a_skill(skills: Any, tmp_path: Path) -> None:
    path = tmp_path / "mine.npz"
    path.write_bytes(pack(taught()))

    assert "it is a whole skill. Give it the ending .gcteach" in skills("import", str(path))


def test_a_damaged_file_is_not_imported(skills: Any, tmp_path: Path) -> None:
    path = tmp_path / "damaged.gcteach"
    path.write_bytes(pack(taught())[:-100])
    before = skills("list")

    assert "damaged.gcteach: it is damaged" in skills("import", str(path))
    assert skills("list") == before
