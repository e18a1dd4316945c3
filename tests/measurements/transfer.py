"""How well do tubes move with landmarks? ``python -m tests.measurements.transfer --out docs/transfer.md``.

Two questions. Do tubes keep what they promise, and their shape, after any move (`move`)? Is what they become
what a person would have shown there (`carried`, `left_out`)? The ramp adds to each place of the middle line
its share of how far start and goal were moved: what one would do without any map.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import tyro
from scipy.spatial.transform import Rotation

from app import skills
from app.resources import static_folder
from gc_core import (
    Demonstration,
    GeneralizedCylinder,
    Landmark,
    ThinPlateSpline,
    encode,
    generalize,
    register,
)
from gc_core.arrays import FloatArray
from gc_core.metrics import dtw, frechet
from gc_core.sections import SECTIONS
from tests.core.objects import KINDS, Scene, transfer
from tests.helpers_data import ALL_SETS, DATA, POSE_SETS, load
from tests.measurements import geometry, runs

FARTHEST: Final = 0.2
"""Landmarks are moved by up to this much [m]."""
TURN: Final = np.deg2rad(60.0)
"""Frames are turned by up to this much [rad]."""
STARTS: Final = 20
EVEN: Final = 100
"""Samples of a path that is compared."""
MOTIONS: Final = 40
"""Motions of each kind that are shown in two scenes."""


@dataclass(frozen=True)
class Moved:
    """What became of a tube after one move."""

    end_error: float
    """Of the directrix from the moved landmarks [mm]."""
    finite: bool
    folds: int
    """Stations that are folded by the determinant of the map's differences."""
    untold: int
    """Stations at which `diagnostics.folded` says something else."""
    ratio: float
    """Worst effective point by its polygon [-]."""
    centres_outside: int
    slope: float
    crossing: int
    unnamed: int
    """Stations that cut a neighbour and are not named."""
    outside: int
    """Runs from eta <= 1 that leave the tube."""
    jump: float
    """Longest step of a run by the median of those around it [-]."""
    shape: float
    """Directrix against the former one after the best similarity, root mean square by its length [%]."""


def skill(name: str) -> list[Demonstration]:
    """Demonstrations of a built-in skill."""
    document = skills.load_skill(static_folder() / "skills", name)
    return [shown.demonstration for shown in document.demonstrations]


def built_in() -> tuple[str, ...]:
    """Names of the built-in skills."""
    return skills.skill_names(static_folder() / "skills")


def random_landmarks(
    cylinder: GeneralizedCylinder, seed: int
) -> tuple[list[Landmark], list[Landmark], FloatArray]:
    """Start and goal as they are, moved, and the targets (2, 3); with odd seeds they are frames."""
    rng = np.random.default_rng(seed)
    ends = cylinder.directrix[[0, -1]]
    away = rng.normal(size=(2, 3))
    away *= FARTHEST * rng.uniform(0.0, 1.0, (2, 1)) ** (1.0 / 3.0) / np.linalg.norm(away, axis=1)[:, None]
    targets = ends + away
    if seed % 2 == 0:
        return [Landmark(end) for end in ends], [Landmark(target) for target in targets], targets
    axis = rng.normal(size=(2, 3))
    turn = Rotation.from_rotvec(
        TURN * rng.uniform(0.0, 1.0, (2, 1)) * axis / np.linalg.norm(axis, axis=1)[:, None]
    )
    after = [Landmark(target, q) for target, q in zip(targets, turn.as_quat(scalar_first=True), strict=True)]
    return [Landmark(end, np.array([1.0, 0.0, 0.0, 0.0])) for end in ends], after, targets


def move(cylinder: GeneralizedCylinder, seed: int, *, repair: bool = True) -> Moved:
    """Move a tube's start and goal at random, and measure what comes out by plain geometry."""
    before, after, targets = random_landmarks(cylinder, seed)
    spline = register(before, after)
    moved = generalize(cylinder, spline, repair=repair)
    starts = runs.in_first_section(moved, STARTS, np.random.default_rng(seed))
    followed = runs.follow(moved, starts)
    folds = folded(cylinder, spline)
    cutting = geometry.cutting_stations(moved)
    surface = moved.surface()
    return Moved(
        end_error=1000.0 * float(np.linalg.norm(moved.directrix[[0, -1]] - targets, axis=1).max()),
        finite=bool(np.isfinite(surface).all() and np.isfinite(moved.effective_points).all()),
        folds=int(folds.sum()),
        untold=int((folds != moved.diagnostics.folded).sum()),
        ratio=float(geometry.ratios_to_polygons(moved).max()),
        centres_outside=int((~geometry.centres_inside(moved)).sum()),
        slope=float(geometry.slopes(moved).max()),
        crossing=int(moved.diagnostics.crossing.sum()),
        unnamed=int((cutting & ~moved.diagnostics.crossing).sum()),
        outside=followed.outside,
        jump=followed.worst,
        shape=100.0 * shape_change(cylinder.directrix, moved.directrix),
    )


def folded(cylinder: GeneralizedCylinder, spline: ThinPlateSpline) -> np.ndarray:
    """Stations (N,) at whose centre or boundary the map's Jacobian has a determinant of 0 or less."""
    places = np.concatenate((cylinder.directrix[:, None], cylinder.surface()), axis=1)
    determinant = np.linalg.det(spline.jacobian(places.reshape(-1, 3))).reshape(places.shape[:2])
    return (determinant <= 0.0).any(axis=1)


def shape_change(one: FloatArray, other: FloatArray) -> float:
    """Root mean square distance of curves (N, 3) after the best similarity, by the other's length [-]."""
    a, b = one - one.mean(axis=0), other - other.mean(axis=0)
    left, sizes, right = np.linalg.svd(b.T @ a)
    sign = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    scale = float((sizes * sign).sum() / (a**2).sum())
    rest = b - scale * a @ (left @ np.diag(sign) @ right).T
    length = float(np.linalg.norm(np.diff(other, axis=0), axis=1).sum())
    return float(np.sqrt((rest**2).sum(axis=1).mean())) / length


def even(path: FloatArray) -> FloatArray:
    """Path (EVEN, 3) evenly along its length."""
    gone = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))))
    return np.stack([np.interp(np.linspace(0.0, gone[-1], EVEN), gone, column) for column in path.T], axis=1)


def ramp(path: FloatArray, start: FloatArray, goal: FloatArray) -> FloatArray:
    """Path (N, 3), evenly sampled, led to a new start and goal (3,) in proportion to the way gone."""
    part = np.linspace(0.0, 1.0, len(path))[:, None]
    return path + (1.0 - part) * (start - path[0]) + part * (goal - path[-1])


def errors(path: FloatArray, truth: Sequence[Demonstration]) -> FloatArray:
    """Mean over true demonstrations: DTW per sample, and Frechet (2,) [m]."""
    mine = even(path)
    shown = [even(demonstration.positions) for demonstration in truth]
    return np.array([[dtw(mine, path) / EVEN, frechet(mine, path)] for path in shown]).mean(axis=0)


LAYOUTS: Final[dict[str, Callable[[Scene], list[Landmark]]]] = {
    "start and goal points": lambda scene: [scene.start_point(), scene.goal_point()],
    "start point, object frame": lambda scene: [scene.start_point(), scene.object_frame()],
    "start frame, object frame": lambda scene: [
        Landmark(scene.start, np.array([1.0, 0.0, 0.0, 0.0])),
        scene.object_frame(),
    ],
}


def carried(kind: str, *, turned: bool, motions: int = MOTIONS) -> dict[str, FloatArray]:
    """Errors (motions, 2) [m] at the new pose: of each layout, of the ramp, and of what is taught there."""
    found: dict[str, list[FloatArray]] = {}
    for seed in range(motions):
        case = transfer(seed, kind, turned=turned)
        tube = encode(case.shown, align_by="arc_length")
        paths = {
            name: generalize(tube, register(layout(case.before), layout(case.after)), repair=False).directrix
            for name, layout in LAYOUTS.items()
        }
        paths["ramp"] = ramp(tube.directrix, case.after.start, case.after.place)
        paths["taught there"] = encode(case.truth, align_by="arc_length").directrix
        for name, path in paths.items():
            found.setdefault(name, []).append(errors(path, case.truth))
    return {name: np.array(rows) for name, rows in found.items()}


def left_out(name: str) -> dict[str, FloatArray]:
    """Errors (n, 2) [m] for each public demonstration, from a tube of the others and its own ends."""
    shown, found = load(name), dict[str, list[FloatArray]]()
    for j, truth in enumerate(shown):
        others = shown[:j] + shown[j + 1 :]
        tube = encode(others, align_by="arc_length")
        start, goal = truth.positions[0], truth.positions[-1]
        before, after = tube.directrix[[0, -1]], np.stack((start, goal))
        point = register(before, after)
        assert tube.orientations is not None
        assert truth.orientations is not None
        frame = register(
            [Landmark(before[0]), Landmark(before[1], tube.orientations[-1])],
            [Landmark(start), Landmark(goal, truth.orientations[-1])],
        )
        paths = {
            "start and goal points": generalize(tube, point).directrix,
            "start point, tool's frame at the end": generalize(tube, frame).directrix,
            "the same spline, of the mean path alone": frame(tube.directrix),
            "ramp": ramp(tube.directrix, start, goal),
        }
        for layout, path in paths.items():
            found.setdefault(layout, []).append(errors(path, [truth]))
    return {layout: np.array(rows) for layout, rows in found.items()}


HEADINGS: Final = (
    "set | section | end error [mm] | not finite | folds: moves | untold | ratio | centres outside | dR/ds "
    "| crossing: moves | unnamed | runs out | jump: unfolded | folded | shape: median [%] | worst [%]"
)


def move_line(name: str, section: str, moves: Sequence[Moved]) -> str:
    """One row on the moves of one tube."""
    shape = [m.shape for m in moves]
    return (
        f"| {name} | {section} | {max(m.end_error for m in moves):.4f} | {sum(not m.finite for m in moves)} "
        f"| {sum(m.folds > 0 for m in moves)} | {sum(m.untold for m in moves)} "
        f"| {max(m.ratio for m in moves):.6f} | {sum(m.centres_outside for m in moves)} "
        f"| {max(m.slope for m in moves):.2f} | {sum(m.crossing > 0 for m in moves)} "
        f"| {sum(m.unnamed for m in moves)} | {sum(m.outside for m in moves)} "
        f"| {worst_jump(moves, folded=False):.2f} | {worst_jump(moves, folded=True):.2f} "
        f"| {np.median(shape):.2f} | {max(shape):.2f} |"
    )


def worst_jump(moves: Sequence[Moved], *, folded: bool) -> float:
    """Worst jump of a run after moves that fold the tube somewhere, or after those that do not."""
    return max((m.jump for m in moves if (m.folds > 0) == folded), default=0.0)


def error_lines(title: str, found: dict[str, FloatArray]) -> Iterator[str]:
    """Rows on the errors of one kind of motion, relative to the ramp's."""
    base = found["ramp"]
    for name, rows in found.items():
        millimetres = 1000.0 * rows.mean(axis=0)
        total, single = rows.sum(axis=0) / base.sum(axis=0), rows / base
        yield (
            f"| {title} | {name} | {millimetres[0]:.1f} | {millimetres[1]:.1f} "
            f"| {total[0]:.2f} | {total[1]:.2f} "
            f"| {np.median(single[:, 0]):.2f} | {np.median(single[:, 1]):.2f} | {single.max():.2f} |"
        )


def head(headings: str) -> str:
    return f"| {headings} |\n|{'---|' * (headings.count('|') + 1)}"


INTRODUCTION: Final = """# Moving tubes with landmarks

Made by `python -m tests.measurements.transfer --out docs/transfer.md`. One BLAS thread; the
recordings are public and not part of the project.

## Random moves

Start and goal of every tube moved by up to {farthest:g} m each, {moves} moves a row: every other time as
points, else as frames that are turned by up to 60 degrees about any axis. lambda = 0; sections that cross are
mended.

- *end error*: directrix from the moved landmarks. *folds*: moves at which the Jacobian's determinant is 0 or
  less somewhere on the directrix or the boundary; *untold*: stations at which `diagnostics.folded` differs.
- *ratio*: worst effective point by its polygon, at most 1 inside. *dR/ds*: along the directrix.
- *crossing*: moves after which sections cross; *unnamed*: stations that cut a neighbour and are not named.
- *runs out*: of {starts} runs a move from eta <= 1, how many leave the tube; *jump*: longest step by the
  median of the 21 steps around it, after moves that fold nothing, and after those that do.
- *shape*: directrix against the taught one after the best similarity (Procrustes), root mean square by
  its length.

A mapped ellipse is no ellipse any more, nor is any other kind: the sections of a mapped tube are the mapped
boundary, cut again and widened to hold what they must. `section` goes on naming the kind that was taught.
"""

TRANSFER: Final = """
## Transfer with a truth

`tests.core.objects`: {motions} motions of each kind, five demonstrations at pose A and five at pose B; the
object is moved by 10 to 25 cm and turned by 20 to 90 degrees about the vertical, or moved alone. Errors of
the middle line against the five at B: DTW per sample and Frechet distance [mm]; by the ramp's, as a ratio of
the means, as a median over motions, and at worst. *taught there* is the middle line of the demonstrations at
B: what people differ by among themselves.
"""

PUBLIC: Final = """
## Public recordings: each demonstration from the others

The tube of all others is moved to the ends of the one left out.
"""

ERRORS: Final = (
    "motion | landmarks | DTW [mm] | Frechet [mm] | DTW by ramp | Frechet by ramp "
    "| DTW: median | Frechet: median | worst"
)


def moves_of(shown: list[Demonstration], section: str, count: int) -> list[Moved]:
    """Move one tube many times."""
    tube = encode(shown, section=section, align_by="arc_length")
    return [move(tube, seed) for seed in range(count)]


def main(*, moves: int = 200, motions: int = MOTIONS, out: Path | None = None) -> None:
    """Measure, and write the page.

    Parameters
    ----------
    moves
        Random moves of each tube.
    motions
        Motions of each kind that are shown at two poses.
    out
        Markdown file; the screen when not given.
    """
    public = ALL_SETS if DATA.is_dir() else ()
    parts = [INTRODUCTION.format(farthest=FARTHEST, moves=moves, starts=STARTS), head(HEADINGS)]
    for name in (*built_in(), *public):
        shown = load(name) if name in public else skill(name)
        for section in SECTIONS:
            parts.append(move_line(name, section, moves_of(shown, section, moves)))
            print(parts[-1], file=sys.stderr, flush=True)
    parts += [TRANSFER.format(motions=motions), head(ERRORS)]
    for kind in KINDS:
        for turned in (True, False):
            title = f"{kind}, {'turned' if turned else 'moved alone'}"
            parts += error_lines(title, carried(kind, turned=turned, motions=motions))
    if public:
        parts += [PUBLIC, head(ERRORS)]
        for name in POSE_SETS:
            parts += error_lines(name, left_out(name))
    page = "\n".join(parts) + "\n"
    if out is None:
        print(page)
    else:
        out.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    tyro.cli(main)
