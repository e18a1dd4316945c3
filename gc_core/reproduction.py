"""The ratio rule: cylinder + start -> a new run.

A run keeps its direction in the moving frame and its ratio to the boundary. It always begins
at the start itself, wherever that is.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gc_core.arrays import BoolArray, FloatArray, finite, read_only
from gc_core.cylinder import GeneralizedCylinder
from gc_core.demonstration import check_places, sign_continuous
from gc_core.errors import InvalidSettingError, UnknownOptionError
from gc_core.joining import joins_of
from gc_core.location import ON_BOUNDARY
from gc_core.ratio_rule import runs, way_of

LAWS = ("fixed", "convergent")
"""How the ratio goes on: kept, or eased to a final value at the end."""

OUTSIDE = ("keep", "boundary", "directrix")
"""What a start outside of the tube does: keep its ratio, or be led to the boundary or the middle."""

_LED_TO = {"keep": float("inf"), "boundary": 1.0, "directrix": 0.0}


@dataclass(frozen=True, eq=False)
class Reproduction:
    """A new run, or S runs at once."""

    positions: FloatArray
    """(K, 3) or (S, K, 3) tool tip; the first is the start [m]."""
    times: FloatArray
    """(K,) from 0 [s]."""
    stations: FloatArray
    """(K,) stations of the cylinder; the first may be fractional [-]."""
    ratios: FloatArray
    """(K,) or (S, K) ratio eta at each station [-]."""
    orientations: FloatArray | None
    """(K, 4) w, x, y, z, or None."""
    gripper: FloatArray | None
    """(K,) or None."""
    start_inside: bool | BoolArray
    """Whether the start lies in the tube; (S,) for S runs."""
    law: str = "fixed"
    """Law of the ratio."""

    def __post_init__(self) -> None:
        for field in fields(self):
            content = getattr(self, field.name)
            # A thousand runs are megabytes: what nobody can write to is not copied again.
            if isinstance(content, np.ndarray) and _can_be_written(cast("NDArray[Any]", content)):
                object.__setattr__(self, field.name, read_only(cast("NDArray[Any]", content)))


def reproduce(
    cylinder: GeneralizedCylinder,
    start: ArrayLike,
    *,
    law: str = "fixed",
    final_ratio: float = 0.0,
    at: float | None = None,
    outside: str = "keep",
) -> Reproduction:
    """Run the skill from a new start.

    A start inside the tube joins where it lies (first passage). A start outside joins at station 0, or at the
    nearest station when that is clearly later and nearer; what it is off that section's plane fades
    out smoothly. Several starts share the stations from the earliest join on; a run that joins later waits
    at its start.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
    start : (3,) or (S, 3) array
        Where to begin: inside, at the centre, outside or off the planes [m].
    law : {"fixed", "convergent"}
        Keep the ratio, or ease it (C1 in arc length) to `final_ratio` at the end.
    final_ratio : float
        For "convergent": ratio at the end, at least 0; smaller ratios are kept [-].
    at : float or None
        Station at which to join, from 0 to N - 2 and rounded, in place of the choice above.
    outside : {"keep", "boundary", "directrix"}
        What is done with a ratio above 1: it is kept, which leads far away where the first slice is
        narrow and a later one wide; or the run is led smoothly to the boundary or to the directrix. A start
        before the first plane and within the outline of the first slice has a ratio of at most 1: it
        comes straight in and keeps it.

    Returns
    -------
    Reproduction
        Finite; inside the tube from its first sample on when the start is (and lies in the section `at`).

    Raises
    ------
    ShapeError, NotFiniteError, TooFarError
        If the start is no place, or more than 1e6 m away.
    UnknownOptionError, InvalidSettingError
        If the law, the final ratio or the station do not exist.

    Notes
    -----
    p_i = c_i + eta R_i(theta) (cos theta N_i + sin theta B_i), theta fixed in the moving frame [1]_, Eq. 8,
    with the unit direction and the centre that are missing there.

    What a start is off this path fades out along the directrix with level ends, over a tenth of its length or
    twice the offset d if more, but over what is left at most: a join adds at most 0.75 times the directrix's
    own pace where 2 d are left, 1.5 d / rest where less is left, 3 where hardly anything is left,
    in which case a rest of d remains at the end.

    References
    ----------
    .. [1] S. R. Ahmadzadeh, M. A. Rana, S. Chernova. Generalized Cylinders for Learning, Reproduction,
       Generalization, and Refinement of Robot Skills. RSS 2017. doi:10.15607/RSS.2017.XIII.021
    """
    if law not in LAWS:
        raise UnknownOptionError("law", law, LAWS)
    if outside not in OUTSIDE:
        raise UnknownOptionError("outside", outside, OUTSIDE)
    if not 0.0 <= final_ratio < np.inf:
        raise InvalidSettingError("final_ratio", final_ratio, "a ratio of at least 0")
    single = _is_one(start)
    starts = finite(start, "start", (3,))[None] if single else finite(start, "start", (None, 3))
    check_places("start", starts)
    joins = joins_of(cylinder, starts, at)
    first = float(joins.stations.min()) if len(starts) else 0.0
    stations = np.concatenate(([first], np.arange(int(first) + 1.0, len(cylinder.directrix))))
    kept = np.where(
        joins.ratios > 1.0 + ON_BOUNDARY, np.minimum(joins.ratios, _LED_TO[outside]), joins.ratios
    )
    final = kept if law == "fixed" else np.minimum(kept, final_ratio)
    positions, ratios = runs(cylinder, way_of(cylinder, starts, joins, kept, final), stations)
    return _reproduction(cylinder, stations, positions, ratios, inside=joins.inside, law=law, single=single)


def _reproduction(
    cylinder: GeneralizedCylinder,
    stations: FloatArray,
    positions: FloatArray,
    ratios: FloatArray,
    *,
    inside: BoolArray,
    law: str,
    single: bool,
) -> Reproduction:
    times = np.interp(stations, np.arange(len(cylinder.times)), cylinder.times)
    low = int(stations[0])
    orientations = cylinder.orientations
    if orientations is not None:
        part = stations[0] - low
        begin = orientations[low] * (1.0 - part) + orientations[min(low + 1, len(orientations) - 1)] * part
        orientations = np.concatenate((begin[None] / np.linalg.norm(begin), orientations[low + 1 :]))
        orientations = sign_continuous(orientations)
    return Reproduction(
        positions=positions[0] if single else positions,
        times=times - times[0],
        stations=stations,
        ratios=ratios[0] if single else ratios,
        orientations=orientations,
        gripper=None if cylinder.gripper is None else cylinder.gripper[low:],
        start_inside=bool(inside[0]) if single else inside,
        law=law,
    )


def _is_one(start: ArrayLike) -> bool:
    """Whether a start is a single place rather than rows of them."""
    try:
        return np.ndim(start) == 1
    except ValueError:
        # Rows of different length, which `finite` refuses in words.
        return False


def _can_be_written(array: NDArray[Any]) -> bool:
    """Whether an array, or one that it is a view of, is not read-only."""
    if array.flags.writeable:
        return True
    return isinstance(array.base, np.ndarray) and _can_be_written(array.base)
