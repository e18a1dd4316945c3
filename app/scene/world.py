"""What all sessions share: table, light and the meshes of the arm.

It is drawn once, on the server's scene. The link meshes have no frames there: each
session puts its own under them, see `app.scene.arm`.
"""

from typing import Final

import viser

from app.arm.protocol import Arm
from app.scene.style import CELL, SECTION_OF_TABLE, TABLE, Color

TABLE_SIZE: Final = 2.2
"""Side of the table [m]: the arm reaches about 1 m to every side."""
TABLE_THICKNESS: Final = 0.025
SKY: Final[Color] = (255, 255, 255)
GROUND: Final[Color] = (196, 200, 210)
AMBIENT: Final = 2.5
"""How bright the light from all around is [-]."""


def draw_world(api: viser.SceneApi, arm: Arm) -> None:
    """Draw the table, the light and the meshes of the arm's links.

    Parameters
    ----------
    api : viser.SceneApi
        The server's scene.
    arm : Arm
        Whose links are drawn, as ``/arm/<link>/mesh``.
    """
    _light(api)
    _draw_table(api)
    count: dict[str, int] = {}
    for mesh in arm.link_meshes:
        number = count[mesh.link] = count.get(mesh.link, 0) + 1
        api.add_mesh_simple(
            f"/arm/{mesh.link}/mesh{'' if number == 1 else number}",
            mesh.vertices,
            mesh.faces,
            color=readable(mesh.color),
            cast_shadow=False,
            receive_shadow=False,
        )


def _light(api: viser.SceneApi) -> None:
    """Light from above and, weaker, from all around.

    viser's environment map looks little different and makes a picture drawn in software take twice as long.
    """
    api.configure_default_lights(True, cast_shadow=False)
    api.configure_environment_map(None)
    api.add_light_hemisphere("/light", sky_color=SKY, ground_color=GROUND, intensity=AMBIENT)


def readable(color: Color) -> Color:
    """Lift near-black parts so that their shape is still seen."""
    red, green, blue = (round(62 + value * (255 - 62) / 255) for value in color)
    return red, green, blue


def _draw_table(api: viser.SceneApi) -> None:
    api.add_box(
        "/table",
        dimensions=(TABLE_SIZE, TABLE_SIZE, TABLE_THICKNESS),
        color=TABLE,
        position=(0.0, 0.0, -0.5 * TABLE_THICKNESS - 0.002),
        cast_shadow=False,
        receive_shadow=False,
    )
    api.add_grid(
        "/table_grid",
        width=TABLE_SIZE,
        height=TABLE_SIZE,
        cell_size=0.1,
        cell_color=CELL,
        cell_thickness=0.8,
        section_size=0.5,
        section_color=SECTION_OF_TABLE,
        section_thickness=1.0,
        shadow_opacity=0.0,
    )
