"""A document comes back from its JSON and arrays exactly as it was, whatever it holds."""

import json
from collections.abc import Iterator
from dataclasses import MISSING, dataclass, fields, is_dataclass, replace
from typing import Any, get_args, get_type_hints

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of

from app.document import Document, Place
from app.library import (
    FORMAT,
    UnreadableSkillError,
    array_names,
    content_hash,
    decode_document,
    encode_document,
)
from app.library.codec import KINDS
from gc_core import same_content
from tests.library.makers import document


def parts(value: object) -> Iterator[object]:
    """Every dataclass in a value, itself included."""
    if is_dataclass(value):
        yield value
        for field in fields(value):
            yield from parts(getattr(value, field.name))
    elif isinstance(value, tuple):
        for item in value:
            yield from parts(item)


def classes(hint: Any) -> Iterator[type]:
    """Every dataclass that a type hint leads to."""
    if isinstance(hint, type) and is_dataclass(hint):
        yield hint
        for inner in get_type_hints(hint).values():
            yield from classes(inner)
    for argument in get_args(hint):
        yield from classes(argument)


def test_every_dataclass_a_document_can_hold_is_known_to_the_codec() -> None:
    assert set(classes(Document)) == set(KINDS.values())


def test_the_sample_document_has_no_default_value_anywhere() -> None:
    seen: set[type] = set()
    for part in parts(document()):
        seen.add(type(part))
        for field in fields(part):  # type: ignore[arg-type]  # parts are dataclasses
            if field.default is not MISSING:
                value = getattr(part, field.name)
                assert not same_content(value, field.default), f"{type(part).__name__}.{field.name}"

    assert seen == set(KINDS.values())


def test_every_field_of_a_document_survives() -> None:
    encoded = encode_document(document())

    assert same_content(decode_document(encoded.text, encoded.arrays), document())


def test_an_empty_document_survives() -> None:
    encoded = encode_document(Document("Nothing yet"))

    assert same_content(decode_document(encoded.text, {}), Document("Nothing yet"))


def test_the_text_names_all_arrays_and_holds_none() -> None:
    encoded = encode_document(document(n=2000))

    assert array_names(encoded.text) == encoded.arrays.keys()
    assert len(encoded.text) < 4000


def test_equal_arrays_are_named_once() -> None:
    twice = replace(document(), starts=(np.array([1.0, 2.0, 3.0]), np.array([1.0, 2.0, 3.0])))

    once = replace(twice, starts=twice.starts[:1])

    assert encode_document(twice).arrays.keys() == encode_document(once).arrays.keys()


@given(
    array=arrays_of.arrays(
        dtype=st.sampled_from(["<f8", "<i8"]),
        shape=arrays_of.array_shapes(max_dims=2, max_side=4),
        elements={},
    )
)
def test_a_hash_depends_on_content_shape_and_type_alone(array: np.ndarray) -> None:
    assert content_hash(array) == content_hash(np.asfortranarray(array))
    assert content_hash(array) != content_hash(array[None])
    assert content_hash(array) != content_hash(array.view("<u8"))


def test_a_field_that_an_older_skill_lacks_takes_its_default() -> None:
    saved = json.loads(encode_document(Document("Old")).text)
    del saved["document"]["Document"]["rules"]

    assert decode_document(json.dumps(saved), {}).rules == ()


def test_in_a_skill_from_before_there_were_kinds_the_start_and_the_goal_are_what_they_are_called() -> None:
    saved = json.loads(encode_document(Document("Old")).text)
    document = saved["document"]["Document"]
    del document["smoothing"]
    for place in document["landmarks"]:
        del place["Place"]["kind"], place["Place"]["turn"]

    old = decode_document(json.dumps(saved), {})

    assert [(place.name, place.kind) for place in old.landmarks] == [("start", "start"), ("goal", "goal")]
    assert old.smoothing == 0.0


@pytest.mark.parametrize("version", [FORMAT + 1, 0, "1", None])
def test_another_format_version_is_refused_with_a_sentence(version: object) -> None:
    saved = json.loads(encode_document(Document("New")).text) | {"format": version}

    with pytest.raises(UnreadableSkillError, match="update gc-teach"):
        decode_document(json.dumps(saved), {})


@pytest.mark.parametrize(
    ("tree", "words"),
    [
        ({"Document": {"title": "A", "colour": "red"}}, "colour, unknown here"),
        ({"Document": {"about": "A"}}, "lacks title"),
        ({"Robot": {}}, "a Robot, which this version does not know"),
        ({"Place": {"name": "cup"}}, "no skill"),
        ({"Document": {"title": "A", "starts": [{"array": "f00"}]}}, "the numbers f00 are missing"),
        ({"Document": {"title": "A", "starts": [{"array": ["f00"]}]}}, "makes no sense"),
        ({"Document": ["title"]}, "makes no sense"),
        ({"Document": {}, "Place": {}}, "makes no sense"),
        ({}, "makes no sense"),
        ("text", "no skill"),
    ],
)
def test_what_is_no_document_is_refused_with_a_sentence(tree: object, words: str) -> None:
    with pytest.raises(UnreadableSkillError, match=words):
        decode_document(json.dumps({"format": FORMAT, "document": tree}), {})


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", '{"format": 1}', "[" * 100_000])
def test_damaged_text_is_refused_with_a_sentence(text: str) -> None:
    with pytest.raises(UnreadableSkillError, match="damaged"):
        decode_document(text, {})


def test_a_class_the_codec_does_not_know_is_named() -> None:
    @dataclass(frozen=True)
    class Colour(Place):
        pass

    with pytest.raises(TypeError, match="Colour"):
        encode_document(Document("A", landmarks=(Colour("cup"),)))
