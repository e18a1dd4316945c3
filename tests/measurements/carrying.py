"""Do moved tubes go where people would go? Errors against true demonstrations, beside simpler things.

The ramp adds to each place of the middle line its share of how far start and goal were moved: what one would
do without any map. Part of `tests.measurements.transfer`, which writes the page.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Final

import numpy as np

from app.model import STIFFNESS
from gc_core import (
    GeneralizedCylinder,
    Landmark,
    ThinPlateSpline,
    encode,
    generalize,
    register,
)
from gc_core.arrays import FloatArray
from gc_core.metrics import dtw, frechet
from tests.core.objects import Scene, Turning, transfer
from tests.helpers_data import load

EVEN: Final = 100
"""Samples of a path that is compared."""
SEEDS: Final = range(20_000, 20_060)
"""Motions that are shown in two scenes. Nothing was chosen by looking at these."""
LINES: Final = 8
"""Of the boundary that are compared."""
OBJECT: Final = "start point, object frame"
TOOL: Final = "start point, tool's frame at the end"
STIFF: Final = ", stiff"
"""Ends the names of maps as the app makes them."""

LAYOUTS: Final[dict[str, Callable[[Scene], list[Landmark]]]] = {
    "start and goal points": lambda scene: [scene.start_point(), scene.goal_point()],
    OBJECT: lambda scene: [scene.start_point(), scene.object_frame()],
    "start frame, object frame": lambda scene: [
        Landmark(scene.start, np.array([1.0, 0.0, 0.0, 0.0])),
        scene.object_frame(),
    ],
}


def even(path: FloatArray) -> FloatArray:
    """Path (EVEN, 3) evenly along its length."""
    gone = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))))
    return np.stack([np.interp(np.linspace(0.0, gone[-1], EVEN), gone, column) for column in path.T], axis=1)


def ramp(path: FloatArray, start: FloatArray, goal: FloatArray) -> FloatArray:
    """Path (N, 3), evenly sampled, led to a new start and goal (3,) in proportion to the way gone."""
    part = np.linspace(0.0, 1.0, len(path))[:, None]
    return path + (1.0 - part) * (start - path[0]) + part * (goal - path[-1])


def errors(path: FloatArray, truth: Sequence[FloatArray]) -> FloatArray:
    """Mean over true paths: DTW per sample, and Frechet (2,) [m]."""
    mine, shown = even(path), [even(one) for one in truth]
    return np.array([[dtw(mine, one) / EVEN, frechet(mine, one)] for one in shown]).mean(axis=0)


def both_maps(before: list[Landmark], after: list[Landmark], name: str) -> dict[str, ThinPlateSpline]:
    """The map of the paper and the app's, by name."""
    return {
        name: register(before, after),
        name + STIFF: register(before, after, stiffness=STIFFNESS),
    }


def carried(kind: str, turning: Turning, seeds: range = SEEDS) -> dict[str, FloatArray]:
    """Errors (motions, 2) [m] at the new pose: of each layout, of the ramp, and of what is taught there."""
    found: dict[str, list[FloatArray]] = {}
    for seed in seeds:
        case = transfer(seed, kind, turning)
        tube = encode(case.shown, align_by="arc_length")
        maps: dict[str, ThinPlateSpline] = {}
        for name, layout in LAYOUTS.items():
            maps |= both_maps(layout(case.before), layout(case.after), name)
        paths = {name: generalize(tube, spline, repair=False).directrix for name, spline in maps.items()}
        paths["ramp"] = ramp(tube.directrix, case.after.start, case.after.place)
        paths["taught there"] = encode(case.truth, align_by="arc_length").directrix
        for name, path in paths.items():
            found.setdefault(name, []).append(errors(path, [one.positions for one in case.truth]))
    return {name: np.array(rows) for name, rows in found.items()}


def left_out(
    name: str,
) -> Iterator[tuple[GeneralizedCylinder, GeneralizedCylinder, dict[str, ThinPlateSpline]]]:
    """For each public demonstration: a tube of the others, its own tube, and maps to its own ends."""
    shown = load(name)
    for j, truth in enumerate(shown):
        tube = encode(shown[:j] + shown[j + 1 :], align_by="arc_length")
        own = encode([truth], align_by="arc_length")
        before, after = ([Landmark(place) for place in one.directrix[[0, -1]]] for one in (tube, own))
        maps = both_maps(before, after, "start and goal points")
        if tube.orientations is not None and own.orientations is not None:
            ends = (
                [side[0], Landmark(side[1].position, turn)]
                for side, turn in ((before, tube.orientations[-1]), (after, own.orientations[-1]))
            )
            maps |= both_maps(*ends, TOOL)
        yield tube, own, maps


def public(name: str) -> dict[str, FloatArray]:
    """Errors (n, 2) [m] for each public demonstration: of the middle line, the ramp and a straight line."""
    found: dict[str, list[FloatArray]] = {}
    for tube, own, maps in left_out(name):
        start, goal = own.directrix[[0, -1]]
        paths = {layout: generalize(tube, spline).directrix for layout, spline in maps.items()}
        paths["ramp"] = ramp(tube.directrix, start, goal)
        paths["straight from start to goal"] = np.linspace(start, goal, EVEN)
        for layout, path in paths.items():
            found.setdefault(layout, []).append(errors(path, [own.directrix]))
    return {layout: np.array(rows) for layout, rows in found.items()}


def against_the_spline(
    tube: GeneralizedCylinder, moved: GeneralizedCylinder, spline: ThinPlateSpline, truth: FloatArray
) -> FloatArray:
    """Errors (2, 2) [m] of lines along the boundary: moved with the tube, and by the plain spline."""
    every = len(tube.angles) // LINES
    with_the_tube, alone = (
        np.mean([errors(lines[:, k], [truth]) for k in range(0, lines.shape[1], every)], axis=0)
        for lines in (moved.surface(), spline(tube.surface()))
    )
    return np.array([with_the_tube, alone])


def error_lines(title: str, found: dict[str, FloatArray]) -> Iterator[str]:
    """Rows on the errors of one kind of motion, relative to the ramp's."""
    base = found["ramp"]
    for name, rows in found.items():
        mean = 1000.0 * rows.mean(axis=0)
        ratios = (rows.sum(axis=0) / base.sum(axis=0), np.median(rows / base, axis=0))
        cells = [f"{mean[0]:.1f}", f"{mean[1]:.1f}", *(f"{value:.2f}" for pair in ratios for value in pair)]
        yield f"| {title} | {name} | {' | '.join(cells)} | {(rows / base).max():.2f} |"


ERRORS: Final = (
    "motion | landmarks | DTW [mm] | Frechet [mm] | DTW by ramp | Frechet by ramp "
    "| DTW: median | Frechet: median | worst"
)
