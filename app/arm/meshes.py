"""The Jaco's looks: upstream's 111 000 triangles made light enough for a browser.

Reading and decimating takes seconds and heavy imports, so it happens once,
when the cache is filled; afterwards one small file is read.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from app.arm import urdf
from app.arm.errors import ArmModelError
from app.arm.protocol import LinkMesh

_FILE = "meshes.npz"
_KEPT = 0.12
_FEWEST, _MOST = 452, 4000
"""Triangles of a part after decimation: this share of them, but within these bounds."""
_SHARP = np.radians(40.0)
"""Edges sharper than this stay visible: their corners are not shared [rad]."""


def write(folder: Path) -> None:
    """Read upstream's meshes, lighten them and write them into one file.

    Parameters
    ----------
    folder : Path
        Existing folder.

    Raises
    ------
    ArmModelError
        If a mesh is missing.
    """
    visuals = urdf.visuals()
    lighter = {mesh: _lighten(mesh) for mesh in sorted({visual.mesh for visual in visuals})}
    arrays: dict[str, Any] = {"links": np.array([visual.link for visual in visuals])}
    for number, visual in enumerate(visuals):
        vertices, faces, color = lighter[visual.mesh]
        arrays |= {f"vertices{number}": vertices, f"faces{number}": faces, f"color{number}": color}
    np.savez(folder / _FILE, **arrays)


def read(folder: Path) -> tuple[LinkMesh, ...]:
    """Read what `write` wrote; the arrays are read-only.

    Raises
    ------
    ArmModelError
        If the file is missing or damaged.
    """
    path = folder / _FILE
    try:
        with np.load(path) as arrays:
            return tuple(_link_mesh(arrays, number, str(link)) for number, link in enumerate(arrays["links"]))
    except (OSError, ValueError, KeyError) as error:
        raise ArmModelError(f"{path} is damaged", f"Delete the folder {folder} and start again.") from error


def _link_mesh(arrays: Any, number: int, link: str) -> LinkMesh:
    vertices, faces = arrays[f"vertices{number}"], arrays[f"faces{number}"]
    vertices.setflags(write=False)
    faces.setflags(write=False)
    red, green, blue = (int(value) for value in arrays[f"color{number}"])
    return LinkMesh(link, vertices, faces, (red, green, blue))


def _lighten(path: Path) -> tuple[Any, Any, Any]:
    # Imported here because it takes three seconds that a warm cache does not need.
    trimesh, simplification = import_module("trimesh"), import_module("fast_simplification")
    if not path.exists():
        raise ArmModelError(f"{path.name} is missing", f"Install {urdf.PACKAGE}==6.0.0 again.")
    (mesh,) = trimesh.load_scene(path).dump()
    color = np.asarray(mesh.visual.material.main_color[:3], dtype=np.uint8)
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    wanted = float(np.clip(_KEPT * len(mesh.faces), _FEWEST, _MOST))
    corners, triangles = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    if wanted < len(triangles):
        corners, triangles = simplification.simplify(
            corners.astype(np.float32), triangles, target_reduction=1.0 - wanted / len(triangles)
        )
    light = trimesh.Trimesh(corners, triangles, process=True)
    shaded = trimesh.graph.smooth_shade(light, angle=_SHARP)
    return np.asarray(shaded.vertices, np.float32), np.asarray(shaded.faces, np.uint32), color
