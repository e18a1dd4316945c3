"""A session's work is saved after every gesture, by a worker, and once more where that failed."""

import logging
import math
import threading
from collections.abc import Callable
from concurrent.futures import Executor
from typing import Final

from app.actor import Actor, Latest
from app.desk import Desk
from app.drawing import drawing_of
from app.history import History
from app.library import Library
from app.model import Model
from app.store import Saving

AGAIN: Final = 5.0
"""A save that failed is tried again after this time [s]."""
SOON: Final = 2.0
"""Work that is not saved after this time is said not to be [s]."""

_log = logging.getLogger(__name__)


class Keeper:
    """Saves what is on a desk under the code of its session; all but writing happens in the mailbox."""

    def __init__(
        self,
        code: str,
        desk: Desk,
        library: Library,
        jobs: tuple[Executor, Actor],
        *,
        clock: Callable[[], float],
        on_saved: Callable[[], None],
    ) -> None:
        self._code, self._desk, self._library, self._clock = code, desk, library, clock
        self._jobs = Latest(*jobs)
        self._on_saved = on_saved
        self._saved = desk.store.history
        self._saving: History | None = self._saved
        self._since: float | None = None
        """When the work began to wait for being saved."""
        self._not_before = clock()
        self._writing = threading.Lock()

    @property
    def saving(self) -> Saving:
        """Whether the library holds what is on the desk."""
        if self._saved is self._desk.store.history:
            return "saved"
        late = self._since is not None and self._clock() - self._since > SOON
        return "late" if late or self._clock() < self._not_before else "saving"

    def follow(self, tried: frozenset[str]) -> None:
        """Have the desk's history saved, unless it is or will be, with what was tried of the lesson."""
        history = self._desk.store.history
        if history is self._saved:
            self._since = None
        elif self._since is None:
            self._since = self._clock()
        if history is not self._saving and self._clock() >= self._not_before:
            self._saving = history
            model = self._desk.model
            self._jobs.submit(
                lambda: self._write(history, tried, model), lambda error: self._written(history, error)
            )

    def finish(self, tried: frozenset[str]) -> None:
        """Let go of what is held, and save at once; from then on nothing is written."""
        try:
            self._desk.let_go(self._clock())
        finally:
            history = self._desk.store.history
            if history is not self._saved:
                self._saving = history
                error = self._write(history, tried, None)
                if error is not None:  # nobody is there to be told
                    _log.error("session %s is not saved: %s", self._code, error)
            # A job that still waits must not undo what is done when the skill is open again.
            self._saving, self._not_before = None, math.inf

    def _write(self, history: History, tried: frozenset[str], model: Model | None) -> Exception | None:
        """Save, in whichever thread, unless something newer was saved meanwhile."""
        with self._writing:
            if history is self._saving:
                learned = model is not None and model.source is history.present.document
                try:
                    drawing = drawing_of(model) if model is not None and learned else None
                    self._library.keep(self._code, history, tried=tried, drawing=drawing)
                except Exception as error:  # it goes on to the mailbox; whatever it is, it is tried again
                    return error
            return None

    def _written(self, history: History, error: Exception | None) -> None:
        if error is not None:
            self._saving = self._saved
            self._not_before = self._clock() + AGAIN
            raise error
        if history is self._saving:
            self._saved, self._since = history, None
            self._on_saved()
