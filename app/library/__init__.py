"""Saved skills: a SQLite file by default, PostgreSQL by address."""

from app.library.codec import FORMAT, Encoded, array_names, content_hash, decode_document, encode_document
from app.library.connect import VARIABLE, default_url, told
from app.library.errors import BadCodeError, ForeignDatabaseError, LibraryError, UnreadableSkillError
from app.library.library import KEPT_DELETED, Kept, Library, Summary
from app.library.packing import ArrayNames

__all__ = [
    "FORMAT",
    "KEPT_DELETED",
    "VARIABLE",
    "ArrayNames",
    "BadCodeError",
    "Encoded",
    "ForeignDatabaseError",
    "Kept",
    "Library",
    "LibraryError",
    "Summary",
    "UnreadableSkillError",
    "array_names",
    "content_hash",
    "decode_document",
    "default_url",
    "encode_document",
    "told",
]
