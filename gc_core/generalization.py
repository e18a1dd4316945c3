"""Cylinder + map of space -> cylinder (Algorithm 3 of the paper)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gc_core.arrays import FloatArray
from gc_core.cylinder import GeneralizedCylinder
from gc_core.demonstration import sign_continuous
from gc_core.frames import angles_between, arc_length, rotation_minimizing_frames, tangents
from gc_core.radius import loop_radii, slope_limited, widened_to_hold
from gc_core.registration import ThinPlateSpline
from gc_core.surface import crossing_stations, section_surface
from gc_core.tilting import tilted_normals

SLICING_ROUNDS = 4
"""Steps along a line of the mapped surface towards the plane that should cut it."""


def generalize(
    cylinder: GeneralizedCylinder, registration: ThinPlateSpline, *, repair: bool = True
) -> GeneralizedCylinder:
    """Bend a cylinder with the space around it.

    The directrix and the boundary are mapped and the frames rebuilt. The mapped sections are neither flat nor
    perpendicular to the new directrix: the surface is cut again by the new planes, along its lines of equal
    angle, and the effective points along theirs. Orientations turn with the map.

    Parameters
    ----------
    cylinder : GeneralizedCylinder
        With N stations and M angles.
    registration : ThinPlateSpline
        Map of space, from `register`.
    repair : bool
        Tilt the planes where the map makes more sections cross than did before; else they keep their angles
        to the directrix, which is quicker.

    Returns
    -------
    GeneralizedCylinder
        With the same stations, angles, times and gripper. A rigid map moves the cylinder and changes nothing
        else. `diagnostics.folded` tells where the map turns space inside out, `crossing` is found anew.

    References
    ----------
    .. [1] S. R. Ahmadzadeh, M. A. Rana, S. Chernova. Generalized Cylinders for Learning, Reproduction,
       Generalization, and Refinement of Robot Skills. RSS 2017, Algorithm 3. doi:10.15607/RSS.2017.XIII.021
    """
    directrix = registration(cylinder.directrix)
    jacobian = registration.jacobian(cylinder.directrix)
    along = tangents(directrix)
    normals = _carried_normals(cylinder, jacobian, along)
    mapped = _Mapped(
        cylinder,
        directrix,
        registration(np.concatenate((cylinder.surface(), cylinder.effective_points), axis=1)),
        jacobian[0] @ cylinder.frames[0, :, 1],
    )
    frames, radii, points = mapped.cut(normals)
    surface = section_surface(directrix, frames, cylinder.angles, radii)
    crossing = crossing_stations(surface, normals)
    if repair and crossing.sum() > cylinder.diagnostics.crossing.sum():
        normals = tilted_normals(directrix, normals, surface, mapped.surface)
        frames, radii, points = mapped.cut(normals)
        crossing = crossing_stations(mapped.surface(normals), normals)
    return replace(
        cylinder,
        directrix=directrix,
        frames=frames,
        radii=radii,
        effective_points=points,
        aligned=registration(cylinder.aligned),
        orientations=_turned(cylinder.orientations, jacobian),
        diagnostics=replace(
            cylinder.diagnostics,
            crossing=crossing,
            tilt=angles_between(normals, along),
            folded=np.linalg.det(jacobian) <= 0.0,
        ),
    )


@dataclass(frozen=True, eq=False)
class _Mapped:
    """The lines of a mapped cylinder, to be cut by planes."""

    cylinder: GeneralizedCylinder
    """As it was taught."""
    directrix: FloatArray
    """(N, 3) mapped [m]."""
    lines: FloatArray
    """(N, M + n, 3) mapped: of the boundary, then of the effective points [m]."""
    first: FloatArray
    """(3,) wanted first N [-]."""

    def cut(self, normals: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Cut the lines by planes with these normals (N, 3): frames, radii and effective points."""
        frames = rotation_minimizing_frames(self.directrix, normals, self.first)
        local = _cut_again(self.lines, self.directrix, frames)
        n_rays = len(self.cylinder.angles)
        radii = np.maximum(
            loop_radii(local[:, :n_rays], n_rays), self.cylinder.diagnostics.minimum_half_width
        )
        step = np.diff(self.directrix, axis=0)
        length = np.sqrt(np.einsum("ij,ij->i", step, step))[:, None]
        radii = slope_limited(widened_to_hold(radii, local[:, n_rays:]), length)
        points = self.directrix[:, None] + local[:, n_rays:] @ np.swapaxes(frames[:, :, 1:], 1, 2)
        return frames, radii, points

    def surface(self, normals: FloatArray) -> FloatArray:
        """Vertices (N, M, 3) of the sections in planes with these normals (N, 3) [m]."""
        frames, radii, _ = self.cut(normals)
        return section_surface(self.directrix, frames, self.cylinder.angles, radii)


def _carried_normals(cylinder: GeneralizedCylinder, jacobian: FloatArray, along: FloatArray) -> FloatArray:
    """Normals (N, 3) tilted from the new tangents `along` as the old ones were from the old tangents."""
    if not cylinder.diagnostics.tilt.any():
        return along
    turn = _rotations(jacobian)
    before = (turn @ tangents(cylinder.directrix)[:, :, None])[..., 0]
    normals = (turn @ cylinder.frames[:, :, :1])[..., 0]
    # What remains to the new tangent is the smallest rotation; a half turn has no axis of its own.
    cross = np.cross(before, along)
    cos = np.einsum("ij,ij->i", before, along)[:, None]
    share = np.einsum("ij,ij->i", cross, normals)[:, None] / np.maximum(1.0 + cos, 1e-9)
    normals = normals * cos + np.cross(cross, normals) + cross * share
    return normals / np.sqrt(np.einsum("ij,ij->i", normals, normals))[:, None]


def _cut_again(lines: FloatArray, directrix: FloatArray, frames: FloatArray) -> FloatArray:
    """Cut lines (N, L, 3), sampled at the stations, with the planes: section coordinates (N, L, 2).

    A line that does not reach its plane is continued straight by at most one step, then projected.
    """
    count, width = lines.shape[:2]
    normals = frames[:, :, 0]
    offsets = np.einsum("ij,ij->i", directrix, normals)
    exact = 1e-9 * float(arc_length(directrix)[-1])
    height = ((lines @ normals[:, :, None])[..., 0] - offsets[:, None]).ravel()
    flat = lines.reshape(-1, 3)
    place = flat.copy()
    off = np.flatnonzero(np.abs(height) > exact)
    plane = off // width
    # Sample of the line that begins the piece to try first: where a straight line would meet the plane.
    step = np.diff(lines, axis=0, append=2.0 * lines[-1:] - lines[-2:-1])
    rise = (step @ normals[:, :, None]).ravel()[off]
    guess = np.clip(-height[off] / np.where(np.abs(rise) > exact, rise, np.inf), -20.0, 20.0)
    begin = np.clip(plane + np.floor(guess).astype(np.intp), 0, count - 2) * width + off % width
    steps = step.reshape(-1, 3)
    for _ in range(SLICING_ROUNDS):
        if not off.size:
            break
        low, along = np.take(flat, begin, axis=0), np.take(steps, begin, axis=0)
        normal = np.take(normals, off // width, axis=0)
        rise = np.einsum("ij,ij->i", along, normal)
        start = np.take(offsets, off // width) - np.einsum("ij,ij->i", low, normal)
        part = start / np.where(np.abs(rise) > exact, rise, np.inf)
        along *= np.clip(part, -1.0, 2.0)[:, None]
        place[off] = low + along
        # Where the line was left by its piece, the piece that the plane should lie in is tried next.
        left = np.flatnonzero((part < 0.0) | (part > 1.0))
        off, begin, part = off[left], begin[left], part[left]
        ahead = begin // width + np.floor(np.clip(part, -8.0, 8.0)).astype(np.intp)
        following = np.clip(ahead, 0, count - 2) * width + off % width
        fresh = following != begin
        off, begin = off[fresh], following[fresh]
    return (place.reshape(lines.shape) - directrix[:, None]) @ frames[:, :, 1:]


def _rotations(jacobian: FloatArray) -> FloatArray:
    """Rotations (N, 3, 3) nearest to Jacobians (N, 3, 3): their polar factors."""
    left, _, right = np.linalg.svd(jacobian)
    left[:, :, 2] *= np.linalg.det(left @ right)[:, None]
    return np.asarray(left @ right, dtype=np.float64)


def _turned(quaternions: FloatArray | None, jacobian: FloatArray) -> FloatArray | None:
    """Turn orientations (N, 4) by the rotation nearest to each Jacobian (N, 3, 3)."""
    if quaternions is None:
        return None
    turn = _matrix_quaternions(_rotations(jacobian))
    w, x, y, z = turn.T
    a, b, c, d = quaternions.T
    product = np.stack(
        (
            w * a - x * b - y * c - z * d,
            w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b,
            w * d + x * c - y * b + z * a,
        ),
        axis=1,
    )
    return sign_continuous(product / np.linalg.norm(product, axis=1, keepdims=True))


def _matrix_quaternions(matrices: FloatArray) -> FloatArray:
    """Unit quaternions (N, 4) w, x, y, z of rotation matrices (N, 3, 3), by the largest component."""
    m = matrices
    xx, yy, zz = m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]
    x, y, z = m[:, 2, 1] - m[:, 1, 2], m[:, 0, 2] - m[:, 2, 0], m[:, 1, 0] - m[:, 0, 1]
    xy, xz, yz = m[:, 0, 1] + m[:, 1, 0], m[:, 0, 2] + m[:, 2, 0], m[:, 1, 2] + m[:, 2, 1]
    candidates = np.stack(
        (
            np.stack((1 + xx + yy + zz, x, y, z), axis=1),
            np.stack((x, 1 + xx - yy - zz, xy, xz), axis=1),
            np.stack((y, xy, 1 - xx + yy - zz, yz), axis=1),
            np.stack((z, xz, yz, 1 - xx - yy + zz), axis=1),
        ),
        axis=1,
    )
    largest = np.argmax(np.einsum("nii->ni", candidates), axis=1)
    chosen = candidates[np.arange(len(m)), largest]
    return chosen / np.linalg.norm(chosen, axis=1, keepdims=True)
