"""What one tab asks for, put into the session's mailbox."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from app import skills
from app.actions import Drag, ViewName
from app.desk import Desk
from app.document import Document, FloatArray
from app.exports import is_skill, unpack
from app.files import Frame, Unit, inspect_bytes
from app.history import History, Version, version_of
from app.library import Summary
from app.pages import fresh_code
from app.scene import VIEWS
from app.sentences import when
from app.shelving import Job, Shelving, copied
from app.viewers import Viewer

if TYPE_CHECKING:
    from app.session import Session


class Seat:
    """The `Actions` of one tab; the session listens only to the one that works."""

    def __init__(self, session: Session, client_id: int) -> None:
        self._session, self._client_id = session, client_id
        self._kept: tuple[Version | None, str] = None, ""

    def _post(self, act: Callable[[Desk, float], None]) -> None:
        self._session.post(self._client_id, act)

    def edit(self, f: Callable[[Document], Document], name: str, key: str | None = None) -> None:
        """See `Actions.edit`."""
        self._post(lambda desk, now: desk.edit(f, name, now=now, key=key))

    def look(self, **changes: Any) -> None:
        """See `Actions.look`."""
        self._post(lambda desk, _: desk.look(**changes))

    def undo(self) -> None:
        """See `Actions.undo`."""
        self._post(lambda desk, now: desk.undo(now))

    def redo(self) -> None:
        """See `Actions.redo`."""
        self._post(lambda desk, now: desk.redo(now))

    def play(self, playing: bool) -> None:
        """See `Actions.play`."""
        self._post(lambda desk, now: desk.play(playing, now))

    def seek(self, time: float) -> None:
        """See `Actions.seek`."""
        self._post(lambda desk, now: desk.seek(time, now))

    def choose_run(self, run: int) -> None:
        """See `Actions.choose_run`."""
        self._post(lambda desk, now: desk.choose_run(run, now))

    def drag(self, drag: Drag) -> None:
        """See `Actions.drag`."""
        self._post(lambda desk, _: desk.drag(drag))

    def move_hand(self, position: FloatArray) -> None:
        """See `Actions.move_hand`."""
        self._post(lambda desk, now: desk.leading.move(position, now))

    def nudge_hand(self, by: FloatArray) -> None:
        """See `Actions.nudge_hand`."""
        self._post(lambda desk, now: desk.leading.nudge(by, now))

    def hold_tool(self, held: bool) -> None:
        """See `Actions.hold_tool`."""
        self._post(lambda desk, _: desk.leading.hold(held))

    def turn_tool(self, wxyz: object) -> None:
        """See `Actions.turn_tool`."""
        self._post(lambda desk, now: desk.leading.turn(wxyz, now))

    def nudge_turn(self, by: FloatArray) -> None:
        """See `Actions.nudge_turn`."""
        self._post(lambda desk, now: desk.leading.nudge_turn(by, now))

    def record(self) -> None:
        """See `Actions.record`."""
        self._post(lambda desk, now: desk.leading.record(now))

    def reposition(self) -> None:
        """See `Actions.reposition`."""
        self._post(lambda desk, now: desk.leading.reposition(now))

    def toggle_gripper(self) -> None:
        """See `Actions.toggle_gripper`."""
        self._post(lambda desk, _: desk.toggle_gripper())

    def start_replay(self) -> None:
        """See `Actions.start_replay`."""
        self._post(lambda desk, now: desk.start_replay(now))

    def stop_replay(self) -> None:
        """See `Actions.stop_replay`."""
        self._post(lambda desk, now: desk.amend(lambda a: a.end(now)))

    def miss_hand(self) -> None:
        """See `Actions.miss_hand`."""
        self._post(lambda desk, _: desk.amend(lambda a: a.missed()))

    def move_line(self, node: str, share: float, by: FloatArray) -> None:
        """See `Actions.move_line`."""
        self._post(lambda desk, now: desk.leading.move_line(node, share, by, now))

    def preview(self, choice: int) -> None:
        """See `Actions.preview`."""
        self._post(lambda desk, _: desk.amending.preview(choice))

    def answer(self, choice: int | None) -> None:
        """See `Actions.answer`."""
        self._post(lambda desk, now: answer(desk, choice, now))

    def try_physics(self) -> None:
        """See `Actions.try_physics`."""
        self._session.post(self._client_id, self._session.trials.begin)

    def play_trial(self, playing: bool) -> None:
        """See `Actions.play_trial`."""
        self._post(lambda desk, now: desk.play_trial(playing, now))

    def compare(self) -> None:
        """See `Actions.compare`."""
        self._session.post(self._client_id, self._session.comparing.begin)

    def see_from(self, view: ViewName) -> None:
        """See `Actions.see_from`."""
        self._session.at(self._client_id, lambda viewer: viewer.see_from(VIEWS[view]))

    def offer_file(self, name: str, content: bytes) -> None:
        """See `Actions.offer_file`."""
        if is_skill(name):
            self._session.look_into(self._client_id, name, lambda: unpack(name, content), self._open)
            return
        self._session.look_into(
            self._client_id,
            name,
            lambda: inspect_bytes(name, content),
            lambda reading: self._post(lambda desk, _: desk.offer_reading(reading)),
        )

    def accept_file(self, unit: Unit, frame: Frame) -> None:
        """See `Actions.accept_file`."""
        self._post(lambda desk, now: desk.accept_file(unit, frame, now))

    def decline_file(self) -> None:
        """See `Actions.decline_file`."""
        self._post(lambda desk, _: desk.decline_file())

    def prepare_export(self, suffix: str) -> None:
        """See `Actions.prepare_export`."""
        self._post(lambda desk, _: self._session.exporting.prepare(desk, suffix))

    def take_export(self) -> None:
        """See `Actions.take_export`."""

        def take(viewer: Viewer) -> None:
            parcel = self._session.exporting.parcel
            if parcel is not None and parcel.ready:
                viewer.send(parcel)

        self._session.at(self._client_id, take)

    def close_export(self) -> None:
        """See `Actions.close_export`."""
        self._post(lambda _desk, _now: self._session.exporting.put_away())

    def open_skill(self, name: str) -> None:
        """See `Actions.open_skill`; one's own work also gets an address where it stays."""
        folder = self._session.workshop.skills_folder

        def load(_desk: Desk, _now: float) -> None:
            self._open(skills.load_skill(folder, name) if name else skills.empty_skill())

        self._post(load)

    def _open(self, opened: Document) -> None:
        """Put a skill on the desk, and the present one away."""

        def open_it(desk: Desk, now: float) -> Job | None:
            desk.let_go(now)
            history = desk.store.history
            desk.open(opened, now)
            return self._put_away(history)

        self._session.shelve(self._client_id, open_it)

    def _put_away(self, history: History) -> Job | None:
        """Save one's own work under a code of its own, unless it was; say where it is once it is there."""
        present = history.present
        document = present.document
        if document.built_in or not document.demonstrations:
            return None
        again = present is self._kept[0]  # it may have been worked on there since
        code = self._kept[1] if again else fresh_code()
        where = f"{document.title} is kept at /s/{code} and in My skills. Undo brings it back here."

        def put_away(shelving: Shelving) -> str:
            if not again:
                shelving.put_away(code, history)
                self._kept = present, code
            return where

        return put_away

    def go_back(self, stamp: int) -> None:
        """See `Actions.go_back`."""
        self._post(lambda desk, now: go_back(desk, stamp, now))

    def copy_version(self, stamp: int) -> None:
        """See `Actions.copy_version`."""

        def prepare(desk: Desk, _: float) -> Job | None:
            version = version_of(desk.store.history, stamp)
            return None if version is None else lambda shelving: copied(shelving, version.document)

        self._session.shelve(self._client_id, prepare)

    def copy_skill(self, code: str) -> None:
        """See `Actions.copy_skill`."""

        def copy(shelving: Shelving) -> str:
            document = shelving.library.load(code)
            return "This skill is gone." if document is None else copied(shelving, document)

        self._shelve(copy)

    def delete_skill(self, code: str) -> None:
        """See `Actions.delete_skill`."""
        self._shelve(
            lambda s: _done(s.library.delete, code, s.library.recent, "is among the recently deleted")
        )

    def restore_skill(self, code: str) -> None:
        """See `Actions.restore_skill`."""
        self._shelve(lambda s: _done(s.library.restore, code, s.library.deleted, "is in My skills again"))

    def forget_skill(self, code: str) -> None:
        """See `Actions.forget_skill`."""
        self._shelve(lambda s: _done(s.library.forget, code, s.library.deleted, "is deleted for good"))

    def _shelve(self, job: Job) -> None:
        self._session.shelve(self._client_id, lambda _desk, _now: job)


def go_back(desk: Desk, stamp: int, now: float) -> None:
    """Work on another version of the skill, as a step that can be undone."""
    version = version_of(desk.store.history, stamp)
    if version is not None:
        made = when(datetime.fromtimestamp(version.made, UTC), datetime.now(UTC))
        name = f"go back to {made if version.name else 'the beginning'}"
        desk.edit(lambda _: version.document, name, now=now)


def _done(
    do: Callable[[str], bool], code: str, listed: Callable[[int, list[str]], list[Summary]], words: str
) -> str:
    """Do something with a skill of a list, and say what became of which."""
    titles = [summary.title for summary in listed(1, [code])]
    return f"{titles[0] if titles else 'It'} {words}." if do(code) else "This skill is gone already."


def answer(desk: Desk, choice: int | None, now: float) -> None:
    """Do what becomes of the correction that waits; a rule that is made shows its arrows."""
    known = len(desk.store.document.rules)
    desk.amend(lambda amending: amending.answer(choice, now))
    if len(desk.store.document.rules) > known:
        desk.look(rule=-1)
