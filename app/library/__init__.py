"""Saved skills: a SQLite file by default, PostgreSQL by address."""

from app.library.codec import FORMAT, Encoded, array_names, content_hash, decode_document, encode_document
from app.library.connect import VARIABLE, default_url
from app.library.errors import BadCodeError, ForeignDatabaseError, LibraryError, UnreadableSkillError
from app.library.library import ArrayNames, Library, Summary

__all__ = [
    "FORMAT",
    "VARIABLE",
    "ArrayNames",
    "BadCodeError",
    "Encoded",
    "ForeignDatabaseError",
    "Library",
    "LibraryError",
    "Summary",
    "UnreadableSkillError",
    "array_names",
    "content_hash",
    "decode_document",
    "default_url",
    "encode_document",
]
