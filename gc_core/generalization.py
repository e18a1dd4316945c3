"""Cylinder + map of space -> cylinder (Algorithm 3 of the paper)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gc_core.arrays import BoolArray, FloatArray
from gc_core.cylinder import GeneralizedCylinder
from gc_core.frames import angles_between, tangents
from gc_core.image import image_of
from gc_core.registration import ThinPlateSpline, has_corner, turns_inside_out
from gc_core.surface import crossing_stations, section_surface
from gc_core.tilting import tilted_normals
from gc_core.turns import nearest_rotations, turned


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
        else. `diagnostics.folded` tells where the map turns space inside out, on the directrix or the
        boundary; `crossing` is found anew. `section` names the kind that was taught: a bent ellipse is none.

    References
    ----------
    .. [1] S. R. Ahmadzadeh, M. A. Rana, S. Chernova. Generalized Cylinders for Learning, Reproduction,
       Generalization, and Refinement of Robot Skills. RSS 2017, Algorithm 3. doi:10.15607/RSS.2017.XIII.021
    """
    jacobian = _along_the_directrix(cylinder, registration)
    image = image_of(cylinder, registration, jacobian[0] @ cylinder.frames[0, :, 1])
    along = tangents(image.directrix)
    normals = _carried_normals(cylinder, jacobian, along)
    frames, radii, points = image.cut(normals)
    surface = section_surface(image.directrix, frames, cylinder.angles, radii)
    crossing = crossing_stations(surface, normals)
    if repair and crossing.sum() > cylinder.diagnostics.crossing.sum():
        normals = tilted_normals(image.directrix, normals, surface, image.surface)
        frames, radii, points = image.cut(normals)
        surface = section_surface(image.directrix, frames, cylinder.angles, radii)
        crossing = crossing_stations(surface, normals)
    orientations = cylinder.orientations
    return replace(
        cylinder,
        directrix=image.directrix,
        frames=frames,
        radii=radii,
        effective_points=points,
        aligned=registration(cylinder.aligned),
        orientations=None if orientations is None else turned(orientations, jacobian),
        diagnostics=replace(
            cylinder.diagnostics,
            crossing=crossing,
            tilt=angles_between(normals, along),
            folded=_folded(cylinder, registration),
        ),
    )


def _along_the_directrix(cylinder: GeneralizedCylinder, registration: ThinPlateSpline) -> FloatArray:
    """Jacobians (N, 3, 3) at the stations; where one is a landmark, the mean of those to either side.

    The map has a corner there: at an end of the tube only the side that the tube is on counts.
    """
    line = cylinder.directrix
    jacobian = registration.jacobian(line)
    corners = has_corner(registration, line)
    if corners.any():
        between = registration.jacobian(0.5 * (line[1:] + line[:-1]))
        sides = np.concatenate((between[:1], between, between[-1:]))
        jacobian[corners] = 0.5 * (sides[:-1] + sides[1:])[corners]
    return jacobian


def _folded(cylinder: GeneralizedCylinder, registration: ThinPlateSpline) -> BoolArray:
    """Stations (N,) whose centre or boundary the map turns inside out."""
    places = np.concatenate((cylinder.directrix[:, None], cylinder.surface()), axis=1)
    inside_out = turns_inside_out(registration, places.reshape(-1, 3)).reshape(places.shape[:2])
    return np.asarray(inside_out.any(axis=1))


def _carried_normals(cylinder: GeneralizedCylinder, jacobian: FloatArray, along: FloatArray) -> FloatArray:
    """Normals (N, 3) tilted from the new tangents `along` as the old ones were from the old tangents."""
    if not cylinder.diagnostics.tilt.any():
        return along
    turn = nearest_rotations(jacobian)
    before = (turn @ tangents(cylinder.directrix)[:, :, None])[..., 0]
    normals = (turn @ cylinder.frames[:, :, :1])[..., 0]
    # What remains to the new tangent is the smallest rotation; a half turn has no axis of its own.
    cross = np.cross(before, along)
    cos = np.einsum("ij,ij->i", before, along)[:, None]
    share = np.einsum("ij,ij->i", cross, normals)[:, None] / np.maximum(1.0 + cos, 1e-9)
    normals = normals * cos + np.cross(cross, normals) + cross * share
    return normals / np.sqrt(np.einsum("ij,ij->i", normals, normals))[:, None]
