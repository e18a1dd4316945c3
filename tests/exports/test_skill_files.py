"""A skill as a file: back to the last bit, and never anything but a skill."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app import skills
from app.document import Document
from app.edits import skill_of
from app.exports import pack, unpack
from app.files import FORMATTERS, FileError, inspect_bytes, read
from app.resources import static_folder
from app.server import first_document
from gc_core import GcError, same_content
from tests.app.makers import furnished, taught
from tests.files.makers import DATA, needs_data, npy_of

SKILLS = static_folder() / "skills"
PUBLIC = ("tlgc/alpha.mat", "robotasks/pos_ori/*.npy", "canal_lab_demos/*.h5")


@pytest.mark.parametrize("name", skills.skill_names(SKILLS))
def test_a_built_in_skill_comes_back_exactly_as_the_persons_own(name: str) -> None:
    document = skills.load_skill(SKILLS, name)

    assert same_content(unpack(f"{name}.gcteach", pack(document)), replace(document, built_in=False))


def test_a_skill_with_one_of_everything_comes_back_exactly() -> None:
    assert same_content(unpack("a.gcteach", pack(furnished())), furnished())


def test_the_same_skill_makes_the_same_file() -> None:
    assert pack(furnished()) == pack(furnished())


def test_numpy_opens_the_arrays_of_a_skill_file() -> None:
    with np.load(io.BytesIO(pack(taught()))) as arrays:
        found = [arrays[name] for name in arrays.files if name != "skill.json"]

    assert any(np.array_equal(taught().demonstrations[0].demonstration.positions, array) for array in found)


def test_a_skill_file_is_also_read_as_its_demonstrations() -> None:
    document = taught()
    muted = replace(document.demonstrations[1], muted=True)
    document = replace(document, demonstrations=(document.demonstrations[0], muted))

    (found,) = inspect_bytes("a.gcteach", pack(document)).demonstrations

    assert same_content(found, document.demonstrations[0].demonstration)


def test_a_skill_whose_names_have_unusual_letters_comes_back() -> None:
    names = {"title": "Über 👩\u200d🔬\u3000机器人", "about": "One line.\nAnother."}
    places = tuple(replace(p, name=p.name.replace("cup", "👩\u200d🔬")) for p in furnished().landmarks)
    document = replace(furnished(), landmarks=places, **names)

    assert same_content(unpack("a.gcteach", pack(document)), document)


FIXTURE = Path(__file__).parent / "fixtures" / "everything.gcteach"
"""`pack(furnished())` of tests.app.makers, as gc-teach 0.1 wrote it; later versions must read it."""


def test_a_skill_file_of_version_0_1_is_still_read() -> None:
    document, wanted = unpack(FIXTURE.name, FIXTURE.read_bytes()), furnished()

    assert [place.name for place in document.landmarks] == ["start", "goal", "cup"]
    assert [rule.name for rule in document.rules] == ["Lid"]
    assert document.things == wanted.things
    assert document.settings == wanted.settings
    for shown, other in zip(document.demonstrations, wanted.demonstrations, strict=True):
        np.testing.assert_allclose(shown.demonstration.positions, other.demonstration.positions, atol=1e-12)


def test_a_skill_file_is_what_serve_opens(tmp_path: Path) -> None:
    path = tmp_path / "mine.gcteach"
    path.write_bytes(pack(furnished()))

    assert same_content(first_document([path])(), furnished())


@needs_data
@pytest.mark.parametrize("suffix", [*FORMATTERS, ".gcteach"])
@pytest.mark.parametrize("pattern", PUBLIC)
def test_public_recordings_survive_every_format(suffix: str, pattern: str) -> None:
    """Positions to the last bit, turns to 1e-15, times to the nanosecond (in HDF5; elsewhere exactly)."""
    path = sorted(DATA.glob(pattern))[0]
    shown = read(path)
    if suffix == ".gcteach":
        found = [s.demonstration for s in unpack("a.gcteach", pack(skill_of("A", shown))).demonstrations]
    else:
        found = inspect_bytes(f"a{suffix}", FORMATTERS[suffix](shown)).accepted("m", "as recorded")

    assert len(found) == len(shown)
    for one, other in zip(found, shown, strict=True):
        np.testing.assert_array_equal(one.positions, other.positions)
        np.testing.assert_allclose(one.times, other.times - other.times[0], rtol=0.0, atol=1e-9)
        assert (one.orientations is None) == (other.orientations is None)
        if other.orientations is not None:
            np.testing.assert_allclose(one.orientations, other.orientations, rtol=0.0, atol=1e-15)


# --- strangers ---------------------------------------------------------------------------------------


def rewritten(change: Callable[[dict[str, Any]], object], **members: bytes) -> bytes:
    """A skill file whose document was changed by hand, with more files in it."""
    with zipfile.ZipFile(io.BytesIO(pack(furnished()))) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    saved = json.loads(files["skill.json"])
    change(saved)
    files["skill.json"] = json.dumps(saved).encode()
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in {**files, **members}.items():
            archive.writestr(name, content)
    return out.getvalue()


def field(saved: dict[str, Any], *path: str | int) -> Any:
    """A part of a saved document, found by the fields and places on the way."""
    node = saved["document"]["Document"]
    for key in path:
        node = node[key]
    return node


def put(value: object, *path: str | int) -> Callable[[dict[str, Any]], object]:
    """Write a value in the place of one of the document."""

    def change(saved: dict[str, Any]) -> None:
        field(saved, *path[:-1])[path[-1]] = value

    return change


def repeat(saved: dict[str, Any], name: str, times: int) -> None:
    """Append copies of the first of some items."""
    field(saved, name).extend([field(saved, name, 0)] * times)


SHOWN = ("demonstrations", 0, "Shown", "demonstration", "Demonstration")
RULE = ("rules", 0, "Rule", "constraint", "Constraint")
NAN = {"array": "0" * 40}
WITH_NAN = {"0" * 40 + ".npy": npy_of(np.full((60, 3), np.nan))}
OBJECTS = {"0" * 40 + ".npy": npy_of(np.array([{}], dtype=object), allow_pickle=True)}

FOREIGN: dict[str, bytes] = {
    "a path out of the folder": rewritten(lambda _: 0, **{"../../outside.npy": b"x"}),
    "an absolute path": rewritten(lambda _: 0, **{"/etc/cron.d/job": b"x"}),
    "a program": rewritten(lambda _: 0, **{"run_me.py": b"print(1)"}),
    "Python objects": rewritten(put(NAN, *SHOWN, "positions"), **OBJECTS),
    "no text": b"PK\5\6" + bytes(18),
    "another format": rewritten(lambda saved: saved.update(format=99)),
    "no document": rewritten(lambda saved: saved.update(document={"Box": {}})),
    "an unknown kind": rewritten(lambda saved: saved.update(document={"os.system": {"command": "ls"}})),
    "a field too many": rewritten(put("x", "surprise")),
    "a title that is a list": rewritten(put([1, 2], "title")),
    "no title": rewritten(put("  ", "title")),
    "a title of ten thousand letters": rewritten(put("x" * 10_000, "title")),
    "an unknown section": rewritten(put("heptagon", "settings", "Settings", "section")),
    "stations that are words": rewritten(put("many", "settings", "Settings", "stations")),
    "half a letter": rewritten(put("a\ud800b", "title")),
    "a letter that ends a text": rewritten(put("a\0b", *SHOWN, "name")),
    "a million stations": rewritten(put(10**6, "settings", "Settings", "stations")),
    "smoothing that is not finite": rewritten(put(float("nan"), "smoothing")),
    "NaN in positions": rewritten(put(NAN, *SHOWN, "positions"), **WITH_NAN),
    "positions that are missing": rewritten(put({"array": "f" * 40}, *SHOWN, "positions")),
    "positions that are text": rewritten(put("here and there", *SHOWN, "positions")),
    "times of the wrong length": rewritten(put(None, *SHOWN, "times")),
    "a demonstration that is a box": rewritten(
        put({"Box": {"name": "b", "position": [0, 0, 0], "size": [1, 1, 1]}}, "demonstrations", 0)
    ),
    "a start far away": rewritten(put([[1e9, 0.0, 0.0]], "starts")),
    "a landmark's name with a path": rewritten(put("../hand", "landmarks", 1, "Place", "name")),
    "two landmarks of one name": rewritten(put("start", "landmarks", 2, "Place", "name")),
    "two goals": rewritten(put("goal", "landmarks", 2, "Place", "kind")),
    "a few numbers named too often": rewritten(
        lambda saved: (put(NAN, *SHOWN, "positions")(saved), repeat(saved, "demonstrations", 199)),
        **{"0" * 40 + ".npy": npy_of(np.zeros((60_000, 3)))},
    ),
    "a box of negative size": rewritten(put([-1.0, 1.0, 1.0], "things", 0, "Box", "size")),
    "a box as large as the world": rewritten(put([1e300, 1.0, 1.0], "things", 0, "Box", "size")),
    "a box that is turned by nothing": rewritten(put([1e-300, 0.0, 0.0, 0.0], "things", 0, "Box", "wxyz")),
    "a thing at infinity": rewritten(put([1e300, 0.0, 0.0], "things", 0, "Box", "position")),
    "a rule that does not fit together": rewritten(put({"array": "0" * 40}, *RULE, "points"), **WITH_NAN),
    "a thousand landmarks": rewritten(lambda saved: repeat(saved, "landmarks", 1000)),
    "a text of five megabytes": rewritten(lambda saved: saved.update(note="x" * 5 * 2**20)),
    "a deep nest": rewritten(lambda _: 0, **{"skill.json": b"[" * 100_000}),
    "a cut": pack(furnished())[:-300],
    "a changed byte": pack(furnished()).replace(b"skill.json", b"skull.json"),
}
"""Skill files that nobody here has written."""


@pytest.mark.parametrize("what", FOREIGN)
def test_a_foreign_file_is_refused_with_a_sentence(what: str) -> None:
    with pytest.raises(FileError, match=r"^a\.gcteach.*\.") as caught:
        unpack("a.gcteach", FOREIGN[what])

    assert len(str(caught.value)) < 400


def test_a_zip_bomb_is_refused_before_it_is_unpacked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.files.archives.LARGEST_UNPACKED", 2**20)  # the same law, quicker than at 256 MB
    bomb = rewritten(lambda _: 0, **{"0" * 40 + ".npy": bytes(2**20)})
    monkeypatch.setattr(zipfile.ZipFile, "read", None)

    with pytest.raises(FileError, match="unpacks to"):
        unpack("a.gcteach", bomb)


def test_any_changed_byte_gives_a_sentence_or_a_skill(library_of_damage: list[bytes]) -> None:
    opened = 0
    for content in library_of_damage:
        try:
            opened += isinstance(unpack("a.gcteach", content), Document)
        except GcError as error:
            assert str(error)  # noqa: PT017 - most are refused, some bytes say nothing

    assert opened < len(library_of_damage)


@pytest.fixture(scope="module")
def library_of_damage() -> list[bytes]:
    rng, good = np.random.default_rng(7), pack(taught())
    damaged: list[bytes] = []
    for _ in range(60):
        content = bytearray(good)
        for place in rng.integers(0, len(content), 2):
            content[place] = rng.integers(0, 256)
        damaged.append(bytes(content))
    return damaged
