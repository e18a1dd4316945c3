"""The server: an address ``/s/<code>`` is a session; everything that sessions share is made here."""

import functools
import logging
import signal
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence, Set
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Final

import viser

from app import edits, skills, web
from app.arm.jaco import Jaco
from app.arm.protocol import Arm
from app.document import Document
from app.exports import is_skill, unpack
from app.files import content_of, inspect
from app.library import Library
from app.pages import fresh_code
from app.resources import static_folder
from app.scene import draw_world, look_from_here
from app.session import FORGOTTEN_AFTER, Session, Workshop
from gc_core import GcError

MOST_SESSIONS: Final = 40
"""More people at once than one process can serve."""
MOST_ISSUED: Final = 10_000
"""Fresh codes that are remembered, to tell them from mistyped ones."""
NOTHING_THERE: Final = (
    "Nothing is saved under this address, so a new skill begins here. If you were given it, compare it "
    "letter by letter: capitals count."
)
DELETED: Final = "This skill is among the recently deleted. The first change brings it back."
_SWEEP: Final = 5.0
"""Forgotten sessions are looked for this often [s]."""

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Options:
    """How the server is started."""

    host: str
    port: int
    library: str
    """Address of the database."""


class Server:
    """Serves sessions until it is closed."""

    def __init__(
        self, options: Options, first: Callable[[], Document], make_arm: Callable[[], Arm] = Jaco
    ) -> None:
        """Open the port.

        Parameters
        ----------
        options : Options
        first : callable
            Makes the document of a fresh session.
        make_arm : callable
            Makes an arm for a session.

        Raises
        ------
        GcError
            If the port is busy or the library cannot be opened.
        """
        self._first = first
        self._sessions: dict[str, Session] = {}
        self._lock = threading.Lock()
        self._closed = threading.Event()
        self._issued: deque[str] = deque(maxlen=MOST_ISSUED)
        workers = ThreadPoolExecutor(2, thread_name_prefix="worker")
        static = static_folder()
        folder = static / "skills"
        titles = [(name, skills.load_skill(folder, name).title) for name in skills.skill_names(folder)]
        self._workshop = Workshop(Library(options.library), workers, make_arm, folder, titles)
        self._viser = web.open_server(
            host=options.host,
            port=options.port,
            health=self._health,
            static=static,
            new_code=self._fresh_code,
            on_refused=self._refused,
        )
        arm = make_arm()
        draw_world(self._viser.scene, arm)
        look_from_here(self._viser.initial_camera)
        arm.close()
        self._viser.on_client_connect(self._connect)
        self._viser.on_client_disconnect(self._disconnect)
        threading.Thread(target=self._sweep, name="sweep", daemon=True).start()

    @property
    def port(self) -> int:
        """The port that is listened on."""
        return self._viser.get_port()

    def close(self) -> None:
        """Save every session and stop; a second call does nothing."""
        if self._closed.is_set():
            return
        self._closed.set()
        with self._lock:
            sessions, self._sessions = tuple(self._sessions.values()), {}
        for session in sessions:
            session.close()
        self._viser.stop()
        self._workshop.workers.shutdown(wait=True, cancel_futures=True)
        self._workshop.library.close()

    def _health(self) -> dict[str, object]:
        return {"ok": not self._closed.is_set(), "sessions": len(self._sessions)}

    def _connect(self, client: viser.ClientHandle) -> None:
        try:
            code = web.code_of(client)
        except LookupError:
            return  # gone already
        web.low_latency(client)
        try:
            session = self._session(code)
        except GcError as error:
            client.gui.add_markdown(f"**This page cannot be opened.** {escape(str(error))}")
            return
        except Exception:  # the end of a thread: nobody else would tell the person
            _log.exception("session %s cannot be opened", code)
            client.gui.add_markdown(
                "**This page cannot be opened** because of a fault in the program. What was saved is kept."
            )
            return
        session.attach(client, web.known_codes(client))

    def _disconnect(self, client: viser.ClientHandle) -> None:
        for session in tuple(self._sessions.values()):
            session.detach(client.client_id)

    def _session(self, code: str) -> Session:
        with self._lock:
            session = self._sessions.get(code)
            if session is None:
                if len(self._sessions) >= MOST_SESSIONS:
                    raise TooManySessionsError(len(self._sessions))
                session = self._sessions[code] = self._open(code)
            session.empty_since = None  # somebody is on the way
            return session

    def _open(self, code: str) -> Session:
        kept = self._workshop.library.open(code)
        if kept is None:
            said = "" if code in self._issued else NOTHING_THERE
        else:
            said = DELETED if kept.deleted else ""
        return Session(code, kept or self._first(), self._workshop, said)

    def _fresh_code(self) -> str:
        code = fresh_code()
        self._issued.append(code)
        return code

    def _refused(self, client_id: int, name: str, size: int) -> None:
        limit = web.UPLOAD_LIMIT
        words = f"{name} was not taken: other files are still on their way. Add it when they are there."
        if size > limit:
            words = (
                f"{name} has {size / 2**20:.0f} MB; a recording may have up to {limit >> 20} MB. Leave out "
                "what does not belong to the motion, or save every tenth sample."
            )
        for session in tuple(self._sessions.values()):
            session.tell(client_id, words)

    def _present(self) -> Set[int]:
        return self._viser.get_clients().keys()

    def _sweep(self) -> None:
        while not self._closed.wait(_SWEEP):
            for session in tuple(self._sessions.values()):
                session.reconcile(self._present)
            deadline = time.monotonic() - FORGOTTEN_AFTER
            with self._lock:
                gone = [
                    code
                    for code, session in self._sessions.items()
                    if session.empty_since is not None and session.empty_since < deadline
                ]
                forgotten = [self._sessions.pop(code) for code in gone]
                for session in forgotten:  # saved before anybody may open it again
                    try:
                        session.close()
                    except Exception:  # the others must be swept all the same
                        _log.exception("session %s did not close", session.code)


def stop_signal() -> threading.Event:
    """Catch SIGTERM and SIGINT from now on; the event is set when one has come."""
    stop = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda _number, _frame: stop.set())
    return stop


class TooManySessionsError(GcError):
    """The server is full."""

    def __init__(self, n_sessions: int) -> None:
        super().__init__(
            f"{n_sessions} people are working here already, which is all that this server can serve. "
            "Try again in a few minutes."
        )
        self.n_sessions = n_sessions


def first_document(files: Sequence[str | Path]) -> Callable[[], Document]:
    """Say what a fresh session opens: a skill's file, demonstrations of several files, or *Reaching*.

    Raises
    ------
    FileError
        If a file cannot be read.
    """
    if not files:
        return lambda: skills.load_skill(static_folder() / "skills", "reaching")
    if len(files) == 1 and is_skill(Path(files[0]).name):
        skill = unpack(Path(files[0]).name, content_of(Path(files[0])))
        return lambda: skill
    readings = [inspect(file) for file in files]
    for reading in readings:
        _log.info("%s: %s", reading.name, reading.summary)
    demonstrations = [d for reading in readings for d in reading.accepted()]
    title = ", ".join(reading.name.rpartition(".")[0] for reading in readings)
    return functools.partial(edits.skill_of, title, demonstrations)
