"""What a person can do: the words between the browser and the session.

Panels and scene know only these; every call posts to the session's mailbox and
returns at once, so that a viser callback never waits and never changes anything.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, Literal, Protocol, TypeAlias

from app.document import Document, FloatArray
from app.files import Frame, Unit

Phase: TypeAlias = Literal["start", "update", "end"]
ViewName: TypeAlias = Literal["3D", "Front", "Side", "Top"]

VIEW_NAMES: Final[tuple[ViewName, ...]] = ("3D", "Front", "Side", "Top")
"""Named viewpoints, as the view buttons show them."""


@dataclass(frozen=True, eq=False)
class Drag:
    """One event of a pull on something in the scene, checked and stamped on arrival."""

    node: str
    """Scene name of what was grabbed, for instance ``/demonstrations/2``."""
    phase: Phase
    grabbed: FloatArray
    """(3,) the point of the object under the pointer [m]; it moves with the object."""
    pointer: FloatArray
    """(3,) the pointer on the camera-parallel plane through the grabbed point [m]."""
    time: float
    """Session time of arrival [s]."""
    vertical: bool = False
    """Shift is held: only the height changes."""
    eye: FloatArray | None = None
    """(3,) the camera [m], where it is known."""
    ahead: FloatArray | None = None
    """(3,) where the camera looks, a unit vector, where it is known."""
    aside: bool = False
    """Pulled with the right button: moves the hand without recording."""


class Actions(Protocol):
    """What panels and scene may ask for."""

    def edit(self, f: Callable[[Document], Document], name: str, key: str | None = None) -> None:
        """Make one undo step, called ``name`` on the undo button (``move goal``)."""
        ...

    def look(self, **changes: Any) -> None:
        """Change fields of the `View`."""
        ...

    def undo(self) -> None:
        """Take the last edit back."""
        ...

    def redo(self) -> None:
        """Do the last undone edit again."""
        ...

    def play(self, playing: bool) -> None:
        """Start or pause the playback."""
        ...

    def seek(self, time: float) -> None:
        """Move the playhead [s]."""
        ...

    def choose_run(self, run: int) -> None:
        """Let the arm play another reproduction."""
        ...

    def drag(self, drag: Drag) -> None:
        """Begin, continue or end a pull."""
        ...

    def move_hand(self, position: FloatArray) -> None:
        """Lead the hand to a place (3,) [m]; recorded only after `record`."""
        ...

    def nudge_hand(self, by: FloatArray) -> None:
        """Lead the hand on by a little (3,) [m]; recorded only after `record`."""
        ...

    def hold_tool(self, held: bool) -> None:
        """Hold the tool as it is while the hand is moved, or let it turn freely."""
        ...

    def turn_tool(self, wxyz: object) -> None:
        """Turn the tool to an orientation w, x, y, z, checked where it is done, and hold it so."""
        ...

    def nudge_turn(self, by: FloatArray) -> None:
        """Turn the tool by a little about its own x, y and z (3,) [rad], and hold it so."""
        ...

    def record(self) -> None:
        """Begin a demonstration that is made by buttons and numbers, or end it."""
        ...

    def reposition(self) -> None:
        """Bring a hand that is stuck to where it is wanted, by another posture of the arm."""
        ...

    def toggle_gripper(self) -> None:
        """Open or close the hand; recorded while it is pulled."""
        ...

    def see_from(self, view: ViewName) -> None:
        """Look from one of the named viewpoints of the scene."""
        ...

    def start_replay(self) -> None:
        """Replay what the `View` names, slowly, and let the hand be pulled aside."""
        ...

    def stop_replay(self) -> None:
        """End the replay where it is."""
        ...

    def miss_hand(self) -> None:
        """Say what can be pulled while it replays: somebody clicked beside it."""
        ...

    def move_line(self, node: str, share: float, by: FloatArray) -> None:
        """Pull a line after a part (0 .. 1) of the way along it, by a displacement (3,) [m]."""
        ...

    def preview(self, choice: int) -> None:
        """Show what another choice of the `Proposal` would do."""
        ...

    def answer(self, choice: int | None) -> None:
        """Do with a correction what one of the choices says; None discards it."""
        ...

    def try_physics(self) -> None:
        """Let the arm play the run in a physical world, under the limits of its motors."""
        ...

    def play_trial(self, playing: bool) -> None:
        """Show in the scene what the arm did there."""
        ...

    def compare(self) -> None:
        """Let the methods that the `View` names learn what the tube has learned, and run."""
        ...

    def offer_file(self, name: str, content: bytes) -> None:
        """Read an uploaded recording and show what is in it, before it is accepted."""
        ...

    def accept_file(self, unit: Unit, frame: Frame) -> None:
        """Add the demonstrations of the offered file."""
        ...

    def decline_file(self) -> None:
        """Forget the offered file."""
        ...

    def prepare_export(self, suffix: str) -> None:
        """Have the skill written as a file with this suffix, and show what is in it."""
        ...

    def take_export(self) -> None:
        """Send the file that is shown to this tab."""
        ...

    def close_export(self) -> None:
        """Forget the file that is shown."""
        ...

    def open_skill(self, name: str) -> None:
        """Open a built-in skill, or an empty one (``""``), in place of the present one; can be undone."""
        ...

    def go_back(self, stamp: int) -> None:
        """Work on an earlier version of the skill again; can be undone."""
        ...

    def copy_version(self, stamp: int) -> None:
        """Make a skill of its own of a version of this one."""
        ...

    def copy_skill(self, code: str) -> None:
        """Make a skill of its own of a saved one, as it was last saved."""
        ...

    def delete_skill(self, code: str) -> None:
        """Put a saved skill among the recently deleted."""
        ...

    def restore_skill(self, code: str) -> None:
        """Bring a recently deleted skill back."""
        ...

    def forget_skill(self, code: str) -> None:
        """Delete a recently deleted skill for good."""
        ...
