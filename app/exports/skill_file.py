"""A skill as one file, ``.gcteach``, and back."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from numpy.typing import NDArray

from app.document import Document
from app.exports.checking import checked
from app.files import LARGEST_FILE, SUFFIX, FileError, TooLargeError, format_skill, open_skill
from app.files.archives import LARGEST_UNPACKED
from app.library.codec import decode_document, encode_document
from app.model import learn
from gc_core import GcError

_NAMED: Final = re.compile(r'"array"\s*:\s*"([0-9a-f]{40})"')
FRESH: Final = "Export the skill again, or ask for the file again."


def is_skill(name: str) -> bool:
    """Whether a file's name says that it holds a whole skill."""
    return Path(name).suffix.lower() == SUFFIX


def pack(document: Document) -> bytes:
    """Write a skill: the same skill gives the same bytes. A built-in one becomes the person's own."""
    encoded = encode_document(replace(document, built_in=False))
    return format_skill(encoded.text, encoded.arrays)


def _check_copies(name: str, text: str, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Refuse a few numbers that are named so often that their copies would fill the memory."""
    named = Counter(_NAMED.findall(text))
    size = sum(count * arrays[key].nbytes for key, count in named.items() if key in arrays)
    if size > LARGEST_UNPACKED:
        raise TooLargeError(name, "unpacks to", size, LARGEST_UNPACKED, unit="bytes")


def unpack(name: str, content: bytes) -> Document:
    """Read a skill, exactly as it was.

    Parameters
    ----------
    name : str
        Of the file, for messages.
    content : bytes

    Returns
    -------
    Document
        Its types, numbers and names are checked, and it was learned once: it can be worked on.

    Raises
    ------
    GcError
        If the file is damaged, too large, of a newer gc-teach, or describes no skill. Nothing of a file is
        ever run or written.
    """
    name = Path(name).name
    if len(content) > LARGEST_FILE:
        raise TooLargeError(name, "has", len(content), LARGEST_FILE, unit="bytes")
    text, arrays = open_skill(name, content)
    _check_copies(name, text, arrays)
    try:
        document = checked(decode_document(text, arrays))
        learn(document, coarse=True)
    except FileError:
        raise
    except GcError as error:
        raise FileError(name, f"{name}: {error}") from error
    # Values that no edit would make get this far only by somebody's hand.
    except (ValueError, TypeError, KeyError, IndexError, AttributeError, ArithmeticError) as error:
        raise FileError(name, f"{name}: what it says makes no skill ({error}). {FRESH}") from error
    return replace(document, built_in=False)
