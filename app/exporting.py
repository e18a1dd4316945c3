"""A desk's skill as a file: made by a worker, shown before it is taken."""

from collections.abc import Callable
from concurrent.futures import Executor

from app.actor import Actor, Latest
from app.arm.protocol import Arm
from app.desk import Desk
from app.document import Document
from app.exports import Subject, parcel
from app.model import learn
from app.parcel import Parcel
from gc_core import GcError


class Exporting:
    """At most one file that a person looks at before taking it."""

    def __init__(self, executor: Executor, actor: Actor, make_arm: Callable[[], Arm]) -> None:
        self._jobs = Latest(executor, actor)
        self._make_arm = make_arm
        self.parcel: Parcel | None = None
        """None: nobody has asked, or it was put away."""
        self._of: Document | None = None

    def prepare(self, desk: Desk, suffix: str) -> None:
        """Have the committed skill written in a format; it is there when the worker has done it."""
        document, model = desk.store.document, desk.model
        run, plan = desk.stage.playback.run, desk.stage.plan(model)
        known = plan if model.source is document else None
        self._of = document
        asked = self.parcel = Parcel(suffix)

        def job() -> Parcel:
            try:
                learned = learn(document, model)
                chosen = min(run, max(len(learned.runs) - 1, 0))
                return parcel(suffix, Subject(document, learned, self._make_arm, chosen, known))
            except GcError as error:
                return Parcel(suffix, problem=str(error))

        def done(made: Parcel) -> None:
            if self.parcel is asked:
                self.parcel = made

        self._jobs.submit(job, done)

    def follow(self, desk: Desk) -> None:
        """Have it made anew when the skill has changed: what is taken is what is on the desk."""
        if self.parcel is not None and desk.store.document is not self._of:
            self.prepare(desk, self.parcel.suffix)

    def put_away(self) -> None:
        """Forget the file."""
        self.parcel = None
