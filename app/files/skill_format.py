"""The project's own files, ``.gcteach``: a whole skill in one archive.

``skill.json`` names the arrays by their content, and each lies beside it as ``<name>.npy``, so that
NumPy, too, can open the archive. What the JSON means is `app.library.codec`'s to know; here the
archive is opened safely, and demonstrations are found for those who want nothing else.
"""

from __future__ import annotations

import io
import json
import re
import zipfile
from collections.abc import Mapping
from typing import Any, Final, cast

import numpy as np
from numpy.typing import NDArray

from app.document import FloatArray
from app.files.archives import TEXT, members
from app.files.errors import TooLargeError, UnreadableError
from app.files.npy_format import parse_array
from app.files.recording import Contents, Recording, check_count, check_length

SUFFIX: Final = ".gcteach"
LONGEST_TEXT: Final = 4 * 2**20
"""[bytes]"""
_ARRAY: Final = re.compile(r"[0-9a-f]{40}\.npy")
_REMEDY: Final = "Export the skill again, or ask for the file again."
_BORN: Final = (2017, 7, 12, 0, 0, 0)
"""The same skill gives the same bytes, whenever it is written."""


def format_skill(text: str, arrays: Mapping[str, NDArray[Any]]) -> bytes:
    """Write the archive of an encoded document."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(_member(TEXT), text)
        for name, array in sorted(arrays.items()):
            packed = io.BytesIO()
            np.save(packed, array, allow_pickle=False)
            archive.writestr(_member(f"{name}.npy"), packed.getvalue())
    return out.getvalue()


def open_skill(name: str, content: bytes) -> tuple[str, dict[str, NDArray[Any]]]:
    """Open the archive of a skill.

    Returns
    -------
    text : str
        What `app.library.codec.decode_document` reads.
    arrays : dict of str to array
        By content hash.

    Raises
    ------
    FileError
        If it is damaged or too large, or holds anything that belongs in no skill.
    """

    def wanted(member: str) -> bool:
        if member != TEXT and not _ARRAY.fullmatch(member):
            raise UnreadableError(name, f"it holds {member[:60]!r}, which belongs in no skill", _REMEDY)
        return True

    found = members(name, content, wanted, _REMEDY)
    text = found.pop(TEXT, None)
    if text is None:
        raise UnreadableError(name, f"it holds no {TEXT}, so it is no skill", _REMEDY)
    if len(text) > LONGEST_TEXT:
        raise TooLargeError(name, "has a text of", len(text), LONGEST_TEXT, unit="bytes")
    try:
        return text.decode(), {key[:40]: parse_array(name, packed) for key, packed in found.items()}
    except UnicodeDecodeError as error:
        raise UnreadableError(name, f"its {TEXT} is not text", _REMEDY) from error


def parse_skill(name: str, content: bytes) -> Contents:
    """Read only the demonstrations of a skill that are learned from.

    Raises
    ------
    FileError
        As `open_skill`, and if it has another layout.
    """
    text, arrays = open_skill(name, content)
    try:
        shown: list[Any] = json.loads(text)["document"]["Document"]["demonstrations"]
        kept = [
            one["Shown"]["demonstration"]["Demonstration"] for one in shown if not one["Shown"].get("muted")
        ]
        check_count(name, len(kept))
        return Contents(tuple(_recording(name, fields, arrays) for fields in kept), unit="m")
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise UnreadableError(name, "its text makes no sense, or is of a newer gc-teach", _REMEDY) from error


def _recording(name: str, fields: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> Recording:
    positions = _array(fields["positions"], arrays)
    if positions is None or positions.ndim != 2 or positions.shape[1] != 3:
        raise UnreadableError(name, "the positions of a demonstration are not rows of x, y, z", _REMEDY)
    n = len(positions)
    check_length(name, n)
    label: Any = fields.get("name", "")
    beside = {key: _array(fields.get(key), arrays) for key in ("times", "orientations", "gripper")}
    for key, array in beside.items():
        if array is not None and array.shape != ((n, 4) if key == "orientations" else (n,)):
            raise UnreadableError(name, f"a demonstration has {n} positions and not as many {key}", _REMEDY)
    return Recording(positions, **beside, name=label if isinstance(label, str) else "")


def _array(node: Any, arrays: Mapping[str, NDArray[Any]]) -> FloatArray | None:
    if node is None:
        return None
    array = arrays[cast("dict[str, str]", node)["array"]]
    if array.dtype.kind not in "fiu":
        raise TypeError(f"an array of {array.dtype}")
    return np.array(array, dtype=np.float64)


def _member(name: str) -> zipfile.ZipInfo:
    info = zipfile.ZipInfo(name, _BORN)
    info.compress_type = zipfile.ZIP_DEFLATED
    return info
