"""What a study's file may say, and what is said of one that is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.files import write
from app.resources import static_folder
from app.study.errors import BadSpecError
from app.study.parts import parts_of
from app.study.sources import open_data
from app.study.spec import read_spec, spec_path
from tests.baselines.makers import demonstrations
from tests.helpers_data import ALL_SETS, DATA
from tests.study.makers import PARTS, small


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ('section = "hull"', "there is no key 'section'. Possible are: title, seed"),
        ("seed = -1", "seed cannot be -1. Give a whole number from 0"),
        ("starts = 2.5", "starts cannot be 2.5. Give a whole number"),
        ("starts = true", "starts cannot be True"),
        ("moves = 100000", "moves cannot be 100000"),
        ("farthest_m = 0", "farthest_m cannot be 0. Give a number of metres above 0"),
        ('leave_one_out = "yes"', "leave_one_out cannot be 'yes'. Give true or false"),
        ('sections = ["square"]', "sections cannot be 'square'. Give some of: circle, ellipse"),
        ('alignments = ["place"]', "alignments cannot be 'place'. Give some of: time, arc_length, dtw"),
        ('methods = ["lstm-5"]', "methods: There is no method 'lstm-5'. Choose gc"),
        ("methods = []", "methods cannot be []. Give a list of names"),
        ('methods = ["gc", "gc"]', "methods names 'gc' twice"),
        ("seed = 1\nsection = 1\nstart = 2", "there are no keys 'section', 'start'. Possible are: title"),
        ('starts = 0\nmoves = 0\nleave_one_out = false\nmethods = ["lstm-5"]', "There is no method 'lstm-5'"),
        ("data_sets = [5]", "data_sets cannot be 5. Give built-in skills, patterns"),
        ('data_sets = [{ name = "one" }]', "Give both a name and files"),
        (
            'data_sets = [{ files = "*.csv", nam = "one" }]',
            "there is no key 'nam'. Possible are: name, files",
        ),
        ("starts = 0\nmoves = 0\nleave_one_out = false", "there is nothing to do"),
        ("starts = = 3", "this is no TOML file"),
    ],
)
def test_what_is_wrong_is_named_with_what_is_possible(wrong: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(BadSpecError) as found:
        small(tmp_path, wrong)

    assert str(found.value).startswith("small.toml: ")
    assert said in str(found.value)


@pytest.mark.parametrize(
    ("data_sets", "said"),
    [
        ('["reeching"]', "'reeching' is no built-in skill (around_an_obstacle, "),
        ('["*.mat"]', "Check the pattern, or say with --data"),
        ('["bent.csv", "./*.csv"]', "two data sets are called 'bent'"),
        ('["**.csv"]', "'**.csv' is no pattern of files"),
        ('["."]', "'.' is no pattern of files"),
    ],
)
def test_data_that_there_are_not_are_named(data_sets: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(BadSpecError) as found:
        open_data(small(tmp_path, f"data_sets = {data_sets}"))

    assert said in str(found.value)


def test_data_that_are_not_named_at_all_are_missed(tmp_path: Path) -> None:
    with pytest.raises(
        BadSpecError, match=r"the key data_sets is missing. Give it a list of built-in skills"
    ):
        small(tmp_path, without='data_sets = ["bent.csv"]')


def test_a_file_that_is_nowhere_is_told_which_studies_there_are() -> None:
    with pytest.raises(BadSpecError, match=r"nothing.toml: there is no such file.*paper, public-data"):
        spec_path(Path("nothing.toml"))


def test_files_are_data_sets_each_or_one_together(tmp_path: Path) -> None:
    for number, each in enumerate(demonstrations(3)):
        write(tmp_path / f"part{number}.csv", [each])
    apart, together = (
        open_data(small(tmp_path, f"data_sets = {given}"))
        for given in ('["part*.csv"]', '[{ name = "all", files = "part*.csv" }]')
    )

    assert [(each.name, len(each.demonstrations)) for each in apart] == [(f"part{n}", 1) for n in range(3)]
    assert [(each.name, len(each.demonstrations)) for each in together] == [("all", 3)]


def test_a_study_is_the_cross_product_and_one_demonstration_is_never_left_out(tmp_path: Path) -> None:
    spec = small(tmp_path)
    write(tmp_path / "bent.csv", demonstrations(3))
    write(tmp_path / "one.csv", demonstrations(1))
    parts, more = (
        parts_of(each, open_data(each)) for each in (spec, small(tmp_path, 'data_sets = ["*.csv"]'))
    )

    assert len(parts) == len({part.name for part in parts}) == PARTS
    assert len(more) == PARTS + PARTS * 2 // 3
    assert list(more) == sorted(more)


def test_the_paper_s_study_names_every_built_in_skill() -> None:
    data = open_data(read_spec(spec_path(Path("paper"))))

    assert {each.name for each in data} == {path.stem for path in (static_folder() / "skills").glob("*.toml")}


def test_the_study_of_the_public_data_names_every_set() -> None:
    if not DATA.is_dir():
        pytest.skip("the public recordings are not there; set GC_TEACH_DATA to their folder")
    data = open_data(read_spec(spec_path(Path("public-data.toml")), DATA))

    assert {each.name for each in data} == set(ALL_SETS)
