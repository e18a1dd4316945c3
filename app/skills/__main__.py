"""``python -m app.skills [FOLDER]``: write the built-in skills anew, by default into ``static/skills``."""

from __future__ import annotations

import sys
from pathlib import Path

from app.arm import Jaco
from app.skills.making import make, write
from app.skills.recipes import RECIPES


def main(arguments: list[str]) -> None:
    """Make every recipe and say what was written."""
    folder = Path(arguments[0]) if arguments else Path(__file__).parents[2] / "static" / "skills"
    arm = Jaco()
    for recipe in RECIPES:
        made = make(recipe, arm)
        write(made, folder, recipe.name)
        size = (folder / f"{recipe.name}.csv").stat().st_size
        sys.stdout.write(f"{recipe.title}: {len(made.demonstrations)} demonstrations, {size / 1000:.0f} kB\n")
    arm.close()


if __name__ == "__main__":
    main(sys.argv[1:])
