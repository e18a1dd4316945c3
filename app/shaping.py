"""The skill in every kind of cross-section, drawn by a worker while nothing is pulled."""

from concurrent.futures import Executor

from app.actor import Actor, Latest
from app.model import Model
from app.shapes import Shapes, same_but_for_section, shapes_of
from app.store import State


class Shaping:
    """Has a model drawn whenever its drawings would differ from the last ones."""

    def __init__(self, executor: Executor, actor: Actor) -> None:
        self._jobs = Latest(executor, actor)
        self._shaped: Model | None = None
        self.shapes: Shapes | None = None
        """Of a former model until those of the present one are made."""

    def follow(self, state: State) -> None:
        """Have the state's model drawn, unless it is or will be."""
        model = state.model
        if state.dragging is not None or model.cylinder is None:
            return
        if self._shaped is None or not same_but_for_section(self._shaped, model):
            self._shaped = model
            self._jobs.submit(lambda: shapes_of(model), self._accept)

    def _accept(self, shapes: Shapes) -> None:
        self.shapes = shapes
