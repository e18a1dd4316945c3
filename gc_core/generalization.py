"""Cylinder + map of space -> cylinder (Algorithm 3 of the paper)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gc_core.arrays import FloatArray
from gc_core.cylinder import GeneralizedCylinder, crossing_stations, section_surface
from gc_core.demonstration import sign_continuous
from gc_core.frames import arc_length, rotation_minimizing_frames, tangents
from gc_core.radius import loop_radii, slope_limited, widened_to_hold
from gc_core.registration import ThinPlateSpline

SLICING_ROUNDS = 4
"""Steps along a line of the mapped surface towards the plane that should cut it."""


def generalize(cylinder: GeneralizedCylinder, registration: ThinPlateSpline) -> GeneralizedCylinder:
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
    frames = _frames(cylinder, directrix, jacobian)
    n_rays = len(cylinder.angles)
    lines = registration(np.concatenate((cylinder.surface(), cylinder.effective_points), axis=1))
    local = _cut_again(lines, directrix, frames)
    length = arc_length(directrix)
    radii = np.maximum(loop_radii(local[:, :n_rays], n_rays), cylinder.diagnostics.minimum_half_width)
    radii = slope_limited(widened_to_hold(radii, local[:, n_rays:]), length)
    points = directrix[:, None] + local[:, n_rays:] @ np.swapaxes(frames[:, :, 1:], 1, 2)
    surface = section_surface(directrix, frames, cylinder.angles, radii)
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
            crossing=crossing_stations(surface, frames[:, :, 0]),
            folded=np.linalg.det(jacobian) <= 0.0,
        ),
    )


def _frames(cylinder: GeneralizedCylinder, directrix: FloatArray, jacobian: FloatArray) -> FloatArray:
    """Frames (N, 3, 3) along the mapped directrix, tilted from its tangents as the old ones were."""
    before, after = tangents(cylinder.directrix), tangents(directrix)
    old = cylinder.frames[:, :, 0]
    cross = np.cross(before, after)
    cos = np.einsum("ij,ij->i", before, after)[:, None]
    # Rodrigues' turn of each old normal by the turn of its tangent; a half turn has no axis of its own.
    along = np.einsum("ij,ij->i", cross, old)[:, None]
    normals = old * cos + np.cross(cross, old) + cross * along / np.maximum(1.0 + cos, 1e-9)
    tilted = cylinder.diagnostics.tilt[:, None] > 0.0
    normals = np.where(tilted, normals, after)
    normals = normals / np.sqrt(np.einsum("ij,ij->i", normals, normals))[:, None]
    return rotation_minimizing_frames(directrix, normals, jacobian[0] @ cylinder.frames[0, :, 1])


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


def _turned(quaternions: FloatArray | None, jacobian: FloatArray) -> FloatArray | None:
    """Turn orientations (N, 4) by the rotation nearest to each Jacobian (N, 3, 3)."""
    if quaternions is None:
        return None
    left, _, right = np.linalg.svd(jacobian)
    left[:, :, 2] *= np.linalg.det(left @ right)[:, None]
    turn = _matrix_quaternions(left @ right)
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
