"""Colours of drawings inside panels, of the light and of the dark theme: the paper's, as in the scene."""

from typing import Final

RED: Final = "light-dark(#C4161C,#FF5A4F)"
"""What was shown."""
BLUE: Final = "light-dark(#1F3FA8,#6E8BFF)"
"""The middle line."""
MAGENTA: Final = "light-dark(#E04BDC,#F59BF2)"
"""A run. All are functions of CSS, so only for `style`."""
EDGE: Final = "light-dark(#14266c,#aebcff)"
"""The rim of a slice."""
