"""A whole skill as files: to keep, to send, to play, to print, for a real arm; and back."""

from app.exports.checking import ForeignSkillError
from app.exports.formats import (
    FORMATS,
    Format,
    NothingToExportError,
    Subject,
    file_name,
    format_of,
    parcel,
    summary,
)
from app.exports.joint_trajectory import UnsafeRunError, joint_trajectory
from app.exports.skill_file import is_skill, pack, unpack

__all__ = [
    "FORMATS",
    "ForeignSkillError",
    "Format",
    "NothingToExportError",
    "Subject",
    "UnsafeRunError",
    "file_name",
    "format_of",
    "is_skill",
    "joint_trajectory",
    "pack",
    "parcel",
    "summary",
    "unpack",
]
