"""Correct one run, and keep later runs on its side: Figs 11 and 12 of the paper.

``python tests/examples/10_constraint.py [--out FOLDER]``
"""

import figures as fig
import numpy as np

from app.files import read
from app.resources import static_folder
from app.skills import load_card
from gc_core import Constraint, constrain, encode, reproduce, soft_correction

skills = static_folder() / "skills"
card = load_card(skills, "the_lid")
tube = encode(read(skills / "the_lid.csv", units="m"), align_by="arc_length")
upper, lower = (reproduce(tube, start) for start in card.starts)

# The upper run is pressed down in its middle. What was moved is the refinement matrix V, and a rule:
# at each station a plane through the corrected place, across the correction.
middle = len(upper.positions) // 2
pressed = soft_correction(upper.positions, middle, displacement=(0.0, 0.0, -0.07), width=0.25)
lid = Constraint.from_correction(upper, pressed, name="Lid")
print(f"{lid.active.sum()} of {len(lid.stations)} stations have a plane")

# Later runs from other starts: what is above goes to the plane, what is below is the very same object.
starts = tube.directrix[0] + np.outer([0.95, 0.6, 0.3], card.starts[0] - tube.directrix[0]) / 0.75
free = [*(reproduce(tube, start) for start in starts), lower]
obeying = [constrain(run, [lid]) for run in free]
for run, ruled in zip(free, obeying, strict=True):
    moved = 100 * np.linalg.norm(ruled.positions - run.positions, axis=1).max()
    print("untouched" if ruled is run else f"moved by up to {moved:.1f} cm")

sheet = fig.sheet(7.2, 5.2)
grid = sheet.add_gridspec(2, 1)
parts = [fig.space(sheet, grid[column], fig.seen_across(tube)) for column in range(2)]
titles = ("The refinement matrix V: what the teacher moved", "Later runs: above they obey, below they stay")
for axes, title in zip(parts, titles, strict=True):
    axes.title(title)
    fig.former(axes, tube)
fig.arrows(parts[0], upper.positions[::6], lid.moves[::6])
before = [[upper.positions, lower.positions], [run.positions for run in free[:3]]]
after = [[pressed], [run.positions for run in obeying[:3]]]
fig.scale_bar(parts[1], 0.2)
for axes, old, new in zip(parts, before, after, strict=True):
    fig.lines(axes, old, "before", color=fig.INK, linewidth=0.9, linestyle="--")
    fig.lines(axes, new, "refined", color=fig.REFINED, linewidth=1.8)
    axes.plot(lower.positions, color=fig.REPRODUCTION, linewidth=1.6, label="lower run, untouched")
fig.legend(sheet)
figure = fig.save(sheet, "10_constraint")
