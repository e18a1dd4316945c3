"""What a document teaches: a pure function ``Document -> Model``, stage by stage.

encode -> register and generalize -> reproduce -> constrain. A stage whose inputs are
the same objects as last time is not computed again, so that dragging a start costs a
reproduction and not a cylinder. Input that cannot be encoded is not an error here:
the model then says in a sentence what is wrong.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app import ruling
from app.anchors import Anchor, landmark_of, same_anchors
from app.document import Document, FloatArray, Settings
from app.inverse import places_before
from gc_core import (
    Constraint,
    Contradiction,
    Demonstration,
    GcError,
    GeneralizedCylinder,
    Reproduction,
    ThinPlateSpline,
    coarser,
    constrain,
    contradictions,
    encode,
    generalize,
    register,
    reproduce,
)

COARSE_ANGLES: Final = 32
"""Corners of a cross-section while something is dragged; more are not drawn then."""
BEGINNING: Final = 0.1
"""A start within this part of the tube may join where it lies [-]."""
STIFFNESS: Final = 0.03
"""Of the map: more, and turned objects take less of the motion along; less, and one way point that is pulled
takes all of it along (docs/transfer.md) [m]."""
DEFAULT_RATIO: Final = 0.5
"""Without a start of one's own, the first reproduction begins this far off-centre."""


@dataclass(frozen=True, eq=False)
class Run:
    """One reproduction and what it was before the rules."""

    start: FloatArray
    """(3,) where it begins [m]."""
    free: Reproduction
    """By the ratio rule alone."""
    reproduction: Reproduction
    """After the rules; the same object as ``free`` where no rule bites."""
    constraints: tuple[Constraint, ...] = ()
    """The rules that were on."""


@dataclass(frozen=True, eq=False)
class Model:
    """Everything that is computed from a document."""

    source: Document
    demonstrations: tuple[Demonstration, ...] = ()
    """Those that were learned from."""
    taught: GeneralizedCylinder | None = None
    """The cylinder where it was taught."""
    anchors: tuple[Anchor, ...] = ()
    registration: ThinPlateSpline | None = None
    """From taught to present landmarks; None when nothing was moved."""
    cylinder: GeneralizedCylinder | None = None
    """The cylinder where the landmarks stand now."""
    constraints: tuple[Constraint, ...] = ()
    """The rules that are on, moved with the landmarks."""
    contradictions: tuple[Contradiction, ...] = ()
    """Which of them cannot be obeyed together, and where."""
    runs: tuple[Run, ...] = ()
    coarse: bool = False
    """Encoded for a preview: with `COARSE_ANGLES`, crossing sections not mended."""
    hasty: bool = False
    """Bent for a preview: with `COARSE_ANGLES`, crossing sections not mended."""
    problem: str | None = None
    """Why there is no cylinder although something was shown."""

    @property
    def start_shift(self) -> FloatArray:
        """(3,) how far the start landmark, and every start with it, was moved [m]."""
        start = self._start
        return np.zeros(3) if start is None else start.now - start.taught

    @property
    def _start(self) -> Anchor | None:
        return next((anchor for anchor in self.anchors if anchor.kind == "start"), None)

    def carried(self, place: FloatArray) -> FloatArray:
        """Give where a start (3,) that was placed when the skill was taught is now [m].

        The start landmark takes it along; without one, the map does.
        """
        if self.registration is None:
            return place
        if self._start is not None:
            shift = self.start_shift
            return place + shift if np.any(shift) else place
        return self.registration(place)

    def taken_back(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Find where present places (P, 3) would be if nothing had been moved [m].

        Returns
        -------
        taught : (P, 3) array
            [m].
        misses : (P,) array
            See `app.inverse.places_before` [m].
        """
        if self.registration is None or self.taught is None:
            return places, np.zeros(len(places))
        return places_before(self.registration, places, self.taught.directrix)

    def start_taken_back(self, place: FloatArray) -> FloatArray:
        """Find where to keep a start (3,) that shall be at a place now [m]: undoes `carried`."""
        if self.registration is None or self._start is not None:
            return place - self.start_shift
        return self.taken_back(place[None])[0][0]

    def rule_taken_back(self, constraint: Constraint) -> Constraint:
        """Find how to keep a rule that was made with what is shown; see `app.ruling.taken_back`."""
        return ruling.taken_back(constraint, self.registration, self.taught)


def learn(document: Document, previous: Model | None = None, *, coarse: bool = False) -> Model:
    """Compute a document's model, reusing what the previous one has already.

    Parameters
    ----------
    document : Document
        What was shown, moved and corrected.
    previous : Model, optional
        Any earlier model; its stages are reused where their inputs are the same objects.
    coarse : bool
        What has to be encoded is only a preview.

    Returns
    -------
    Model
        With ``source`` set to the document.
    """
    former = previous or Model(Document(""))
    if former.source is document:
        return former
    demonstrations = tuple(s.demonstration for s in document.demonstrations if not s.muted)
    model = Model(document, demonstrations, coarse=coarse)
    try:
        model = _encode(model, former)
        model = replace(model, anchors=_anchors(model, former))
        model = _generalize(model, former, coarse=coarse)
        return _reproduce(model, former)
    except GcError as error:
        return replace(model, problem=str(error))


def _encode(model: Model, former: Model) -> Model:
    settings = model.source.settings
    if not model.demonstrations:
        return model
    unchanged = _same(model.demonstrations, former.demonstrations) and settings == former.source.settings
    if unchanged and former.taught is not None and (model.coarse or not former.coarse):
        return replace(model, taught=former.taught, coarse=former.coarse)
    return replace(model, taught=encode_as(model.demonstrations, settings, coarse=model.coarse))


def encode_as(
    demonstrations: tuple[Demonstration, ...], settings: Settings, *, coarse: bool = False
) -> GeneralizedCylinder:
    """Encode demonstrations by a document's settings; coarsely for a preview."""
    return encode(
        demonstrations,
        section=settings.section,
        stations=settings.stations,
        angles=COARSE_ANGLES if coarse else None,
        align_by=settings.align_by,
        repair=not coarse,
    )


def _generalize(model: Model, former: Model, *, coarse: bool) -> Model:
    anchors = model.anchors
    unchanged = (
        model.taught is former.taught
        and same_anchors(anchors, former.anchors)
        and model.source.smoothing == former.source.smoothing
    )
    if unchanged and not former.problem and (coarse or not former.hasty):
        return replace(
            model,
            anchors=former.anchors,
            registration=former.registration,
            cylinder=former.cylinder,
            hasty=former.hasty,
        )
    if model.taught is None or not any(anchor.moved for anchor in anchors):
        return replace(model, cylinder=model.taught)
    registration = register(
        [landmark_of(anchor, anchor.taught, None) for anchor in anchors],
        [landmark_of(anchor, anchor.now, anchor.turn) for anchor in anchors],
        model.source.smoothing,
        stiffness=STIFFNESS,
    )
    taught = coarser(model.taught, COARSE_ANGLES) if coarse else model.taught
    cylinder = generalize(taught, registration, repair=not coarse)
    return replace(model, registration=registration, cylinder=cylinder, hasty=coarse)


def _anchors(model: Model, former: Model) -> tuple[Anchor, ...]:
    """Give every landmark a position, from the ends of the directrix where it has none.

    One that stands where it stood is the same object as before, so that it is not drawn again.
    """
    known = {anchor.name: anchor for anchor in former.anchors}
    ends: dict[str, FloatArray] = {}
    if model.taught is not None:
        ends = {"start": model.taught.directrix[0], "goal": model.taught.directrix[-1]}
    anchors: list[Anchor] = []
    for place in model.source.landmarks:
        taught = place.taught if place.taught is not None else ends.get(place.kind)
        if taught is not None:
            now = place.now if place.now is not None else taught
            anchor = Anchor(place.name, taught, now, place.kind, place.turn)
            before = known.get(place.name, anchor)
            anchors.append(before if same_anchors((before,), (anchor,)) else anchor)
    return tuple(anchors)


def _reproduce(model: Model, former: Model) -> Model:
    cylinder = model.cylinder
    if cylinder is None:
        return model
    model = _rule(model, former)
    constraints = model.constraints
    starts = _starts(model, cylinder)
    former_runs = former.runs if cylinder is former.cylinder else ()
    runs = tuple(
        _run(cylinder, start, constraints, former_runs[i] if i < len(former_runs) else None)
        for i, start in enumerate(starts)
    )
    return replace(model, runs=runs)


def _rule(model: Model, former: Model) -> Model:
    """Take the rules where the landmarks stand; the former ones where nothing changed."""
    source, before = model.source, former.source
    rules = ruling.enabled(source)
    learned = former.cylinder is not None and model.registration is former.registration
    if learned and _same(rules, ruling.enabled(before)):
        constraints = former.constraints
    else:
        constraints = ruling.carried(rules, model.registration)
    unchanged = constraints is former.constraints and source.settings.stations == before.settings.stations
    if unchanged and ruling.names(source) == ruling.names(before):
        return replace(model, constraints=constraints, contradictions=former.contradictions)
    found = contradictions(constraints, source.settings.stations, ruling.names(source))
    return replace(model, constraints=constraints, contradictions=found)


def _run(
    cylinder: GeneralizedCylinder,
    start: FloatArray,
    constraints: tuple[Constraint, ...],
    former: Run | None,
) -> Run:
    if former is None or not np.array_equal(start, former.start):
        free = reproduce_whole(cylinder, start)
        return Run(start, free, constrain(free, constraints), constraints)
    if former.constraints is constraints:
        return former
    return Run(former.start, former.free, constrain(former.free, constraints), constraints)


def reproduce_whole(cylinder: GeneralizedCylinder, start: FloatArray) -> Reproduction:
    """Run the whole skill from a start, wherever it is.

    A start that lies near a later part of the tube does not cut the skill short, which would happen
    suddenly while it is dragged, above all where the tube comes back to its beginning.
    """
    run = reproduce(cylinder, start, outside="boundary")
    if run.stations[0] <= BEGINNING * len(cylinder.directrix):
        return run
    return reproduce(cylinder, start, at=0, outside="boundary")


def _starts(model: Model, cylinder: GeneralizedCylinder) -> tuple[FloatArray, ...]:
    if not model.source.starts:
        centre, rim = cylinder.directrix[0], cylinder.surface()[0, 0]
        return (centre + DEFAULT_RATIO * (rim - centre),)
    return tuple(map(model.carried, model.source.starts))


def _same(one: tuple[object, ...], other: tuple[object, ...]) -> bool:
    return len(one) == len(other) and all(a is b for a, b in zip(one, other, strict=True))
