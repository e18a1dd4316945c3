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

SLICING_ROUNDS = 3
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

    A line that does not reach its plane is continued straight, within one step at its ends.
    """
    turned = np.swapaxes(frames, 1, 2)
    count = len(lines)
    normals = frames[:, :, 0]
    offsets = np.einsum("ij,ij->i", directrix, normals)
    height = (lines @ normals[:, :, None])[..., 0] - offsets[:, None]
    station = np.repeat(np.arange(count, dtype=np.float64)[:, None], lines.shape[1], axis=1)
    place = lines
    column = np.arange(lines.shape[1])[None, :]
    size = 1e-12 * max(float(np.abs(height).max()), float(np.abs(directrix).max()))
    for _ in range(SLICING_ROUNDS):
        if np.abs(height).max() <= size:
            break
        index = np.clip(station.astype(np.intp), 0, count - 2)
        low, high = lines[index, column], lines[index + 1, column]
        step = high - low
        rise = np.einsum("ilk,ik->il", step, normals)
        start = np.einsum("ilk,ik->il", low, normals) - offsets[:, None]
        part = -start / np.where(np.abs(rise) > 1e-12, rise, np.inf)
        station = np.clip(index + np.clip(part, -3.0, 4.0), 0.0, count - 1.0)
        place = low + np.clip(part, -1.0, 2.0)[..., None] * step
        height = np.einsum("ilk,ik->il", place, normals) - offsets[:, None]
    return ((place - directrix[:, None]) @ np.swapaxes(turned, 1, 2))[..., 1:]


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
