"""The edits: pure functions ``Document -> Document``.

Each returns a new document, or *the same object* when there is nothing to change;
the store relies on that to tell a real edit from an echo of a widget. Input that
makes no sense raises an `EditError` that says what to do instead.
"""

from app.edits.checks import LARGEST_COORDINATE, EditError, point
from app.edits.landmarks import (
    KIND_NAMES,
    MOST_LANDMARKS,
    add_landmark,
    move_landmark,
    put_landmark_back,
    put_landmarks_back,
    remove_landmark,
    rename_landmark,
    set_smoothing,
    turn_landmark,
)
from app.edits.skill import (
    add_demonstrations,
    add_rule,
    add_start,
    delete_demonstration,
    delete_rule,
    duplicate_demonstration,
    edit,
    enable_rule,
    move_start,
    mute_demonstration,
    remove_start,
    rename_demonstration,
    rename_rule,
    rename_skill,
    replace_demonstration,
    set_align_by,
    set_section,
    set_stations,
    skill_of,
    trim_demonstration,
)

__all__ = [
    "KIND_NAMES",
    "LARGEST_COORDINATE",
    "MOST_LANDMARKS",
    "EditError",
    "add_demonstrations",
    "add_landmark",
    "add_rule",
    "add_start",
    "delete_demonstration",
    "delete_rule",
    "duplicate_demonstration",
    "edit",
    "enable_rule",
    "move_landmark",
    "move_start",
    "mute_demonstration",
    "point",
    "put_landmark_back",
    "put_landmarks_back",
    "remove_landmark",
    "remove_start",
    "rename_demonstration",
    "rename_landmark",
    "rename_rule",
    "rename_skill",
    "replace_demonstration",
    "set_align_by",
    "set_section",
    "set_smoothing",
    "set_stations",
    "skill_of",
    "trim_demonstration",
    "turn_landmark",
]
