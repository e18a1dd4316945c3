"""Place the same thing somewhere else: three new goals, nothing shown again (Figs 7 and 8b of the paper).

``python tests/examples/06_new_goals.py [--out FOLDER]``
"""

import figures as fig
import numpy as np

from app.files import read
from app.resources import static_folder
from app.skills import load_card
from gc_core import encode, generalize, metrics, register, reproduce

skills = static_folder() / "skills"
demonstrations = read(skills / "curved_reach_and_place.csv", units="m")
card = load_card(skills, "curved_reach_and_place")
taught = encode(demonstrations, align_by="arc_length")

# Two landmarks: where the motion starts, and where it leads. The goal is moved, the start stays.
before = np.array([taught.directrix[0], card.goal])
placings = [np.array([before[0], goal]) for goal in card.new_goals]

# A map of space takes the landmarks to their new places; the cylinder is bent with the space around it.
maps = [register(before, after) for after in placings]
tubes = [generalize(taught, bend) for bend in maps]

# New runs by the ratio rule, all from the same part of the way from the centre to the boundary.
runs = [reproduce(tube, 0.3 * tube.directrix[0] + 0.7 * tube.surface()[0, ::16]) for tube in tubes]

for after, bend, tube, run in zip(placings, maps, tubes, runs, strict=True):
    moved = 100 * np.linalg.norm(after[1] - before[1])
    missed = 1000 * metrics.end_error(tube.directrix, after[1])
    inside = min(metrics.containment(tube, path) for path in run.positions)
    print(f"goal moved by {moved:.0f} cm ({bend.case}): met to {missed:.1f} mm, {100 * inside:.0f} % inside")

sheet = fig.sheet(8.6, 3.2)
grid = sheet.add_gridspec(1, 3)
for column, (after, tube, run) in enumerate(zip(placings, tubes, runs, strict=True)):
    room = [each.surface() for each in (taught, *tubes)]
    axes = fig.space(sheet, grid[column], fig.seen_flat(taught), room)
    axes.title(f"Goal moved by {100 * np.linalg.norm(after[1] - before[1]):.0f} cm")
    fig.former(axes, taught)
    fig.tube(axes, tube)
    fig.lines(axes, list(run.positions), "reproductions", color=fig.REPRODUCTION, linewidth=1.0)
    fig.landmarks(axes, before, after)
fig.scale_bar(axes, 0.2)
fig.legend(sheet)
figure = fig.save(sheet, "06_new_goals")
