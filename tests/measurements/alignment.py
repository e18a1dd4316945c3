"""Which alignment forgives people's timing? ``python -m tests.measurements.alignment``.

The five shapes of *Reaching* are drawn through the desk, the servo and the Jaco: once evenly, and with
pauses and uneven speed for each seed. Printed is how far the directrix of the uneven ones lies from
that of the even ones, for each alignment: station by station, and as a curve.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from app import skills
from app.arm import Jaco
from app.document import ALIGNMENTS, Alignment, FloatArray, Settings
from app.model import encode_as
from app.resources import static_folder
from gc_core import Demonstration
from tests.measurements.mouse import Habits, drawn_by_a_person, drawn_by_hand

SEEDS: Final = range(8)
PEOPLE: Final = {
    "pauses, still": Habits(),
    "pauses, trembling 0.5 mm": Habits(tremble=0.0005),
    "uneven speed alone": Habits(pauses=(0, 0)),
}


def shapes() -> tuple[FloatArray, ...]:
    """The paths of *Reaching*, each (K, 3) [m]."""
    document = skills.load_skill(static_folder() / "skills", "reaching")
    return tuple(shown.demonstration.positions for shown in document.demonstrations)


def directrix(demonstrations: Sequence[Demonstration], align_by: Alignment) -> FloatArray:
    """(N, 3) the middle line that the app would learn [m]."""
    return encode_as(tuple(demonstrations), Settings(align_by=align_by)).directrix


def station_distance(one: FloatArray, other: FloatArray) -> float:
    """Largest distance between the same stations of two curves (N, 3) [m]."""
    return float(np.max(np.linalg.norm(one - other, axis=1)))


def hausdorff(one: FloatArray, other: FloatArray) -> float:
    """Largest distance from a point of either polyline's vertices to the other polyline [m]."""
    return max(float(np.max(_to_polyline(one, other))), float(np.max(_to_polyline(other, one))))


def _to_polyline(points: FloatArray, line: FloatArray) -> FloatArray:
    begin, along = line[None, :-1], np.diff(line, axis=0)[None]
    away = points[:, None] - begin
    share = np.clip(np.sum(away * along, axis=2) / np.maximum(np.sum(along**2, axis=2), 1e-18), 0.0, 1.0)
    return np.min(np.linalg.norm(away - share[..., None] * along, axis=2), axis=1)


def main() -> None:
    """Measure and print."""
    arm, paths = Jaco(), shapes()
    even = drawn_by_hand(arm, paths)
    print(f"{'timing':28}{'alignment':14}{'stations [mm]':>22}{'curve (Hausdorff) [mm]':>28}")
    print(f"{'':42}{'median':>12}{'worst':>10}{'median':>16}{'worst':>12}")
    for people, habits in PEOPLE.items():
        sets = [drawn_by_a_person(arm, paths, habits, seed) for seed in SEEDS]
        for align_by in ALIGNMENTS:
            wanted = directrix(even, align_by)
            got = [directrix(one, align_by) for one in sets]
            at = 1000.0 * np.array([station_distance(wanted, curve) for curve in got])
            curve = 1000.0 * np.array([hausdorff(wanted, curve) for curve in got])
            print(
                f"{people:28}{align_by:14}{np.median(at):12.2f}{at.max():10.2f}"
                f"{np.median(curve):16.2f}{curve.max():12.2f}"
            )
    arm.close()


if __name__ == "__main__":
    main()
