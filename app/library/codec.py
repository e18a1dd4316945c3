"""A document as small JSON that names its arrays by their content.

Every dataclass becomes ``{"<its name>": {"<field>": ...}}`` with all of its fields, so
a field added to a dataclass is saved without a word here; when an older skill lacks
it, its default is used. Arrays become ``{"array": "<hash>"}`` and are kept apart.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from hashlib import blake2b
from typing import Any, Final, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from app.document import Box, Cylinder, Document, Place, Ring, Rule, Settings, Shown, Sphere
from app.library.errors import UnreadableSkillError
from gc_core import Constraint, Demonstration

Array: TypeAlias = NDArray[Any]

FORMAT: Final = 1
"""Raised when the JSON changes in a way that older programs would misread."""

KINDS: Final[Mapping[str, type]] = {
    kind.__name__: kind
    for kind in (
        Document,
        Shown,
        Demonstration,
        Place,
        Rule,
        Constraint,
        Settings,
        Box,
        Sphere,
        Cylinder,
        Ring,
    )
}
"""The dataclasses that a document is made of; nothing else is ever built from saved data."""

SHARED: Final = (Demonstration, Constraint)
"""Those that copy their arrays: decoded once, they do so once for all versions of a skill."""

Known: TypeAlias = dict[str, object]
"""By their JSON."""


@dataclass(frozen=True, eq=False)
class Encoded:
    """A document taken apart."""

    text: str
    """JSON."""
    arrays: Mapping[str, Array]
    """By content hash."""


def content_hash(array: Array) -> str:
    """Name an array by its type, shape and bytes."""
    plain = np.ascontiguousarray(array)
    digest = blake2b(f"{plain.dtype.str}{plain.shape}".encode(), digest_size=20)
    digest.update(plain.data)
    return digest.hexdigest()


def encode_document(document: Document, name_of: Callable[[Array], str] = content_hash) -> Encoded:
    """Take a document apart into JSON and arrays.

    Parameters
    ----------
    document : Document
    name_of : callable
        `content_hash`, or one that remembers what it hashed.
    """
    arrays: dict[str, Array] = {}
    tree = _encode(document, name_of, arrays)
    text = json.dumps({"format": FORMAT, "document": tree}, ensure_ascii=False, separators=(",", ":"))
    return Encoded(text, arrays)


def decode_document(text: str, arrays: Mapping[str, Array], known: Known | None = None) -> Document:
    """Put a document together again.

    Parameters
    ----------
    text : str
        As `encode_document` made it.
    arrays : mapping of str to array
        At least those that `array_names` lists.
    known : dict, optional
        Demonstrations and constraints that were decoded before, which grows: versions of a skill
        share what they have in common.

    Raises
    ------
    UnreadableSkillError
        If the text is of another format version, names arrays that are not
        there, or does not describe a document.
    """
    try:
        document = _decode(_tree(text), arrays, {} if known is None else known)
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        if isinstance(error, UnreadableSkillError):
            raise
        raise UnreadableSkillError(f"a part of it makes no sense ({error})") from error
    if not isinstance(document, Document):
        raise UnreadableSkillError("it is no skill")
    return document


def array_names(text: str) -> frozenset[str]:
    """List the hashes of all arrays that an encoded document needs.

    Raises
    ------
    UnreadableSkillError
        As `decode_document`.
    """
    names: set[str] = set()
    rest: list[Any] = [_tree(text)]
    while rest:
        node = rest.pop()
        if isinstance(node, list):
            rest.extend(cast("list[Any]", node))
        elif isinstance(node, dict):
            items = cast("dict[str, Any]", node)
            if isinstance(items.get("array"), str):
                names.add(items["array"])
            rest.extend(items.values())
    return frozenset(names)


def _tree(text: str) -> Any:
    try:
        saved = json.loads(text)
        version, tree = saved["format"], saved["document"]
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise UnreadableSkillError("its text is damaged") from error
    if version != FORMAT:
        raise UnreadableSkillError(f"it has format {version}, and this version knows format {FORMAT}")
    return tree


def _encode(value: object, name_of: Callable[[Array], str], arrays: dict[str, Array]) -> Any:
    if value is None or isinstance(value, (str, bool, int, float)):
        return value
    if isinstance(value, np.ndarray):
        array = cast("Array", value)
        name = name_of(array)
        arrays[name] = array
        return {"array": name}
    if isinstance(value, tuple):
        return [_encode(item, name_of, arrays) for item in cast("tuple[object, ...]", value)]
    kind = type(value).__name__
    if is_dataclass(value) and KINDS.get(kind) is type(value):
        names = [f.name for f in fields(value) if f.init]
        return {kind: {name: _encode(getattr(value, name), name_of, arrays) for name in names}}
    raise TypeError(f"A document cannot be saved with a {kind} in it: add it to app.library.codec.KINDS.")


def _decode(node: Any, arrays: Mapping[str, Array], known: Known) -> Any:
    if isinstance(node, list):
        return tuple(_decode(item, arrays, known) for item in cast("list[Any]", node))
    if not isinstance(node, dict):
        return node
    ((tag, body),) = cast("dict[str, Any]", node).items()
    if tag == "array":
        if body not in arrays:
            raise UnreadableSkillError(f"the numbers {str(body)[:12]} are missing")
        return arrays[body]
    kind = KINDS.get(tag)
    if kind is None:
        raise UnreadableSkillError(f"it holds a {tag[:40]}, which this version does not know")
    if kind not in SHARED:
        return _build(kind, {name: _decode(item, arrays, known) for name, item in body.items()})
    text = json.dumps(node)
    if text not in known:
        known[text] = _build(kind, {name: _decode(item, arrays, known) for name, item in body.items()})
    return known[text]


def _build(kind: type, values: dict[str, Any]) -> Any:
    known = {f.name: f for f in fields(kind) if f.init}
    unknown = values.keys() - known.keys()
    if unknown:
        raise UnreadableSkillError(f"its {kind.__name__} has {', '.join(sorted(unknown))[:80]}, unknown here")
    missing = [
        name
        for name, f in known.items()
        if name not in values and f.default is MISSING and f.default_factory is MISSING
    ]
    if missing:
        raise UnreadableSkillError(f"its {kind.__name__} lacks {', '.join(missing)}")
    return kind(**values)
