"""Arrays as rows of a table and back.

The bytes of all numbers are sorted by their place in the number before they are
compressed: those at the front hardly change from one sample to the next. That makes the
positions of a recorded motion a fifth smaller, and its times a tenth of the size.
"""

from __future__ import annotations

import json
import weakref
import zlib
from collections.abc import Iterator, Mapping
from threading import Lock
from typing import Any, Final

import numpy as np
from sqlalchemy import Row

from app.library.codec import Array, content_hash
from app.library.errors import UnreadableSkillError

SHUFFLED: Final = "shuffled"
"""Sorted by place, then deflated. Tables of version 1 hold plain bytes: an empty packing."""
LARGEST: Final = 256 << 20
"""No array of a skill is larger [bytes]; one that says it is, is damaged."""


class ArrayNames:
    """Content hashes of read-only arrays, remembered as long as the arrays live."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[weakref.ref[Array], str]] = {}
        self._lock = Lock()

    def __call__(self, array: Array) -> str:
        """Name an array; one that can still be written to is hashed each time."""
        if array.flags.writeable:
            return content_hash(array)
        key = id(array)
        with self._lock:
            known = self._known.get(key)
            if known is not None and known[0]() is array:
                return known[1]
        name = content_hash(array)
        with self._lock:
            self._known[key] = (weakref.ref(array, lambda gone: self._forget(key, gone)), name)
        return name

    def _forget(self, key: int, gone: weakref.ref[Array]) -> None:
        # No lock: this runs wherever the last reference goes, also inside `__call__`.
        known = self._known.get(key)
        if known is not None and known[0] is gone:
            self._known.pop(key, None)


def row_of(name: str, array: Array) -> dict[str, Any]:
    """Make the row of an array that is called ``name``."""
    plain = np.ascontiguousarray(array)
    places = np.frombuffer(plain.tobytes(), np.uint8).reshape(-1, plain.itemsize).T
    return {
        "hash": name,
        "dtype": plain.dtype.str,
        "shape": json.dumps(plain.shape),
        "bytes": zlib.compress(places.tobytes(), 1),
        "packing": SHUFFLED,
    }


def array_of(row: Row[Any]) -> Array:
    """Make the array of a row.

    Raises
    ------
    UnreadableSkillError
        If its bytes do not fit to its type and shape.
    """
    values: Any = row
    try:
        kind, shape = np.dtype(values.dtype), tuple(int(n) for n in json.loads(values.shape))
        size = int(np.prod(shape, dtype=np.int64)) * kind.itemsize
        content = _unpacked(values.bytes, kind.itemsize, size) if values.packing == SHUFFLED else values.bytes
        return np.frombuffer(content, dtype=kind).reshape(shape)
    except (ValueError, TypeError, zlib.error) as error:
        raise UnreadableSkillError(f"the numbers {values.hash[:12]} are damaged") from error


class Packed(Mapping[str, Array]):
    """Arrays by name, unpacked when they are asked for: most versions of a skill never are."""

    def __init__(self, rows: Mapping[str, Row[Any]]) -> None:
        self._rows = rows
        self._arrays: dict[str, Array] = {}

    def __getitem__(self, name: str) -> Array:
        """Unpack one; raises as `array_of`."""
        if name not in self._arrays:
            self._arrays[name] = array_of(self._rows[name])
        return self._arrays[name]

    def __iter__(self) -> Iterator[str]:
        """List the names."""
        return iter(self._rows)

    def __len__(self) -> int:
        """Count them."""
        return len(self._rows)


def _unpacked(packed: bytes, itemsize: int, size: int) -> bytes:
    if not 0 <= size <= LARGEST:
        raise ValueError(f"{size} bytes")
    content = zlib.decompressobj().decompress(packed, size + 1)
    return np.frombuffer(content, np.uint8).reshape(itemsize, -1).T.tobytes()
