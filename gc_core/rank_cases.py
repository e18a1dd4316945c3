"""What landmarks leave open: layouts that span less than space, or hardly more than less.

Everything here changes gradually while a landmark moves, also through the plane or the line of the others:
a direction is given up little by little, and so is the turn that a flat layout makes first.
"""

from __future__ import annotations

import numpy as np

from gc_core.arrays import FloatArray, IntArray

SAME_PLACE = 1e-6
"""Landmarks nearer than this are one [m]."""

SPANNED = 1e-6
"""Landmarks span a direction across which they differ by more than this part of their spread [-]."""

FLAT = 0.02
"""In a direction in which landmarks differ by less than this part of their spread, the affine part is held
back: the less they differ, the more it stays as it was. Both are root mean squares: of the corners of a
square, 20 cm from its middle, one lifted by 16 mm is the limit [-]."""

STIFFNESS = 0.001
"""... how strongly: against the bending energy of weights for a displacement of 1 each [-]."""

LEAST_TURN, WHOLE_TURN = np.deg2rad(60.0), np.deg2rad(90.0)
"""Layouts on a line or plane that turn by less are sheared; by more, wholly turned first; in between partly,
so that nothing jumps [rad]."""

GREATEST_SPIN = np.deg2rad(120.0)
"""Spins up to this angle are made, then less, and not half a circle, which looks like mirroring [rad]."""

NARROW = 0.1
"""Second by first moment of a layout below which it hardly tells how it spins about its length [-]."""

LEAST_STRETCH = 0.002
"""Landmarks are never brought closer than to this part of their spread: space would collapse [-]."""


def merged(source: FloatArray, target: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Replace sources (L, 3) in one place by one, with the mean of their targets (L, 3)."""
    apart = np.linalg.norm(source[:, None] - source[None], axis=2)
    group: IntArray = np.argmax(apart <= SAME_PLACE, axis=1)
    keep, member = np.unique(group, return_inverse=True)
    if len(keep) == len(source):
        return source, target
    total = np.zeros((len(keep), 3))
    np.add.at(total, member, target)
    counts = np.bincount(member).astype(np.float64)[:, None]
    return source[keep], np.asarray(total / counts, dtype=np.float64)


def spread(centred: FloatArray) -> float:
    """Root mean square distance of points (L, 3) from their mean [m]; 1 where they are one."""
    return float(np.sqrt(np.einsum("ij,ij->", centred, centred) / len(centred))) or 1.0


def dimensions(scaled: FloatArray) -> tuple[int, int]:
    """Dimensions that points (L, 3) of spread 1 span, and those in which they differ by `FLAT` or more."""
    sizes = np.linalg.svd(scaled / np.sqrt(len(scaled)), compute_uv=False)
    return int((sizes > SPANNED).sum()), int((sizes >= FLAT).sum())


def change_of_affine(
    scaled: FloatArray, gain: FloatArray, wanted: FloatArray, stiffness: float
) -> FloatArray:
    """Choose how the affine part changes, in directions that landmarks hardly span too.

    Parameters
    ----------
    scaled : (L, 3) array
        Landmarks about their mean, of spread 1 [-].
    gain, wanted : (3, 3) arrays
        The change D that bends least solves ``gain @ D = wanted``; both vanish where nothing is spanned.
    stiffness : float
        Holds it back in every direction [-].

    Returns
    -------
    (3, 3) array
        That change; 0 in directions in which they do not differ, and held back where they hardly do [-].
    """
    count = len(scaled)
    squares, axes = np.linalg.eigh(scaled.T @ scaled / count)
    flat = np.maximum(1.0 - np.maximum(squares, 0.0) / FLAT**2, 0.0) ** 2
    held = (axes * (count * STIFFNESS * flat + stiffness)) @ axes.T
    return np.asarray(np.linalg.solve(gain + held, wanted), dtype=np.float64)


def first_turn(source: FloatArray, target: FloatArray) -> FloatArray:
    """Find the rotation that a flat or straight layout makes before it is bent.

    A shear would mirror what is across where it turns by more than a right angle.

    Parameters
    ----------
    source, target : (L, 3) array
        Landmarks about their mean, before and after [m].

    Returns
    -------
    (3, 3) array
        The identity below `LEAST_TURN`. From `WHOLE_TURN` on the smallest rotation of the layout's longest
        direction, and about it the one that brings the rest nearest to its target. But where that direction
        stays and only the other side is up afterwards, the layout is mirrored and not spun: it was dragged
        through itself, and a spin would come suddenly.

    References
    ----------
    .. [1] W. Kabsch. A solution for the best rotation to relate two sets of vectors.
       Acta Crystallographica A32, 1976.
    """
    left, sizes, right = np.linalg.svd(target.T @ source)
    if sizes[0] <= (LEAST_STRETCH**2) * float(np.einsum("ij,ij->", source, source)):
        return np.eye(3)
    smallest = between(right[0], left[:, 0])
    nearest = left @ np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))]) @ right
    about, spin = np.asarray(left[:, 0], dtype=np.float64), nearest @ smallest.T
    sine = 0.5 * float(about @ (spin[[2, 0, 1], [1, 2, 0]] - spin[[1, 2, 0], [2, 0, 1]]))
    angle = float(np.arctan2(sine, 0.5 * (np.trace(spin) - 1.0)))
    # What lies almost on a line hardly tells how it spins about it.
    angle *= _gradual(float(sizes[1]) / (NARROW * float(sizes[0])))
    over = _gradual((abs(angle) - GREATEST_SPIN) / (np.pi - GREATEST_SPIN))
    turned = float(np.arccos(np.clip(about @ right[0], -1.0, 1.0)))
    angle *= 1.0 - over * (1.0 - _gradual((turned - LEAST_TURN) / LEAST_TURN))
    return _partly(_rotation(_cross(about), angle) @ smallest)


def _gradual(part: float) -> float:
    """Rise from 0 at part 0 to 1 at part 1, with level ends."""
    part = min(max(part, 0.0), 1.0)
    return part * part * (3.0 - 2.0 * part)


def _cross(axis: FloatArray) -> FloatArray:
    """Matrix (3, 3) of the cross product with a vector (3,)."""
    x, y, z = axis
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def _rotation(cross: FloatArray, angle: float) -> FloatArray:
    """Rotation (3, 3) by an angle about a unit axis, given by its cross product (3, 3)."""
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)


def _partly(rotation: FloatArray) -> FloatArray:
    """Leave a rotation (3, 3) away when it is small, and do it gradually."""
    angle = float(np.arccos(np.clip(0.5 * (np.trace(rotation) - 1.0), -1.0, 1.0)))
    part = _gradual((angle - LEAST_TURN) / (WHOLE_TURN - LEAST_TURN))
    if part in (0.0, 1.0):
        return rotation if part else np.eye(3)
    return _rotation((rotation - rotation.T) / (2.0 * np.sin(angle)), part * angle)


def between(a: FloatArray, b: FloatArray) -> FloatArray:
    """Smallest rotation (3, 3) of unit vector a to b; opposite ones turn about the most upright axis."""
    axis, cos = np.asarray(np.cross(a, b), dtype=np.float64), float(a @ b)
    if cos < -1.0 + 1e-9:
        up = np.array([0.0, 0.0, 1.0]) if abs(a[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
        axis = up - (up @ a) * a
        axis = axis / float(np.linalg.norm(axis))
        return 2.0 * np.outer(axis, axis) - np.eye(3)
    cross = _cross(axis)
    return np.eye(3) + cross + cross @ cross / (1.0 + cos)


def not_collapsed(source: FloatArray, target: FloatArray, turn: FloatArray) -> FloatArray:
    """Keep targets (L, 3) about their mean from falling into one place: the turned source, much smaller."""
    before, after = (float(np.sqrt(np.einsum("ij,ij->", side, side))) for side in (source, target))
    return target + max(LEAST_STRETCH - after / max(before, 1e-300), 0.0) * (source @ turn.T)


def words(count: int, rank: int, strong: int, *, turned: bool, stiff: bool, merged_count: int) -> str:
    """Say which case it is.

    Parameters
    ----------
    count : int
        Landmarks in different places.
    rank : int
        Dimensions that they span.
    strong : int
        Those of them in which they differ by `FLAT` or more.
    turned : bool
        Whether they make a turn first.
    stiff : bool
        Whether a change of the affine part has a price.
    merged_count : int
        Landmarks that were merged into others.

    Returns
    -------
    str
    """
    turn = "a turn, then " if turned else ""
    if rank == 0:
        said = "one landmark: a translation"
    elif count == 2:
        said = f"two landmarks: {turn}a stretch along them"
    elif count == 3 and strong == 2 and not stiff:
        said = f"three landmarks: {turn}an affine map that keeps what is across"
    elif strong == 3:
        said = turn + ("an affine map" if count == 4 and not stiff else "a thin-plate spline")
    else:
        almost = "almost " if rank > strong else ""
        place = "on a line" if strong == 1 else "in a plane"
        said = f"landmarks {almost}{place}: {turn}a thin-plate spline that keeps what is across"
    said += " with a stiff affine part" if stiff and rank else ""
    return said + (f" ({merged_count} in the same place merged)" if merged_count else "")
