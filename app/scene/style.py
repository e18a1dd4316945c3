"""How things look: one place for every colour, width and size of the scene.

The colours are those of the paper's figures. Colour is never the only code: what is
muted is dashed, what was refined is twice as wide and has dots at its ends. Widths of
lines are in pixels, sizes of bodies in metres.
"""

from typing import Final, TypeAlias

Color: TypeAlias = tuple[int, int, int]
"""Red, green, blue, each 0..255."""

DEMONSTRATION: Final[Color] = (196, 22, 28)
MUTED: Final[Color] = (224, 150, 152)
DIRECTRIX: Final[Color] = (31, 63, 168)
TUBE: Final[Color] = (142, 150, 166)
REPRODUCTION: Final[Color] = (224, 75, 220)
REFINED: Final[Color] = (26, 158, 115)
FREE: Final[Color] = (120, 126, 136)
LANDMARK: Final[Color] = (242, 186, 26)
LANDMARK_GHOST: Final[Color] = (247, 222, 158)
THING: Final[Color] = (150, 128, 108)
"""What stands in the way."""
CARRIED: Final[Color] = (128, 146, 128)
"""What can be pushed and carried."""
THING_EDGE: Final[Color] = (74, 62, 52)
OBJECT_AXES: Final[tuple[Color, Color, Color]] = ((200, 40, 40), (30, 140, 60), (40, 80, 200))
"""Of an object's own x, y and z."""
HAND: Final[Color] = (92, 104, 122)
WARNING: Final[Color] = (240, 140, 0)
WARNING_GHOST: Final[Color] = (250, 205, 140)
SECTION: Final[Color] = (20, 38, 108)
GUIDE: Final[Color] = (104, 112, 124)
SHADOW: Final[Color] = (112, 119, 132)
TABLE: Final[Color] = (232, 235, 239)
CELL: Final[Color] = (214, 219, 226)
SECTION_OF_TABLE: Final[Color] = (192, 199, 208)

TUBE_OPACITY: Final = 0.32
FORMER_OPACITY: Final = 0.12
"""Of the tube as it was taught, while landmarks are moved."""

THIN: Final = 2.0
THICK: Final = 4.0
DOUBLE: Final = 8.0
COMPARED: Final = 5.0
"""Wider than the middle line, whose blue is near to that of a method."""
HATCHED: Final = 11.0
"""Wider than every line that it may lie over."""

HAND_RADIUS: Final = 0.025
START_RADIUS: Final = 0.016
LANDMARK_RADIUS: Final = 0.030
VIA_RADIUS: Final = 0.018
OBJECT_HALF: Final = 0.030
"""Half the side of an object's box, and the radius of an obstacle [m]."""
HANDLE_RADIUS: Final = 0.011
"""Of the balls by which a thing is sized."""
DOT_RADIUS: Final = 0.009
"""At the ends of a refined path."""
GHOST_RADIUS: Final = 0.014
PICK_RADIUS: Final = 0.010
"""How near to a line the pointer has to be [m]."""

HAND_GRIP: Final = 0.30
"""Length of the invisible rods that let a ball win over lines in front of it [m]; see `app.scene.grip`."""
START_GRIP: Final = 0.25
"""Less than the hand: where both are, the hand is meant."""
START_GRIP_BESIDE: Final = 0.50
"""More than a hand that plays, whose wide rod lies over a start that is seen beside its ball."""
LANDMARK_GRIP: Final = 1.10
"""More than a hand that plays, which lies on the goal at each end, and past wide curves before it."""
