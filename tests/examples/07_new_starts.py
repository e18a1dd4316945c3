"""Pick the same thing up somewhere else: four new starts (Figs 7 and 8d of the paper).

``python tests/examples/07_new_starts.py [--out FOLDER]``
"""

import figures as fig
import numpy as np

from app.files import read
from app.resources import static_folder
from app.skills import load_card
from gc_core import encode, generalize, metrics, register, reproduce

skills = static_folder() / "skills"
demonstrations = read(skills / "pick_and_place.csv", units="m")
card = load_card(skills, "pick_and_place")
taught = encode(demonstrations, align_by="arc_length")

# The start is moved, the goal stays; the hand still closes where the motion begins.
before = np.array([taught.directrix[0], card.goal])
placings = [np.array([start, card.goal]) for start in card.new_starts]
tubes = [generalize(taught, register(before, after)) for after in placings]
runs = [reproduce(tube, 0.3 * tube.directrix[0] + 0.7 * tube.surface()[0, ::16]) for tube in tubes]

for after, tube, run in zip(placings, tubes, runs, strict=True):
    moved = 100 * np.linalg.norm(after[0] - before[0])
    closes, opens = np.flatnonzero(np.diff(run.gripper)) + 1
    away = 100 * np.linalg.norm(run.positions[:, [closes, opens]] - after, axis=2).max(axis=0)
    width = 2 * tube.radii.mean(axis=1)
    narrow = 100 * max(width[0], width[-1]) / width.max()
    inside = 100 * min(metrics.containment(tube, path) for path in run.positions)
    print(f"start moved by {moved:.0f} cm: the hand closes {away[0]:.1f} cm from it")
    print(f"    and opens {away[1]:.1f} cm from the goal")
    print(f"    ends {narrow:.0f} % as wide as the middle, {inside:.0f} % inside")

sheet = fig.sheet(8.6, 6.4)
grid = sheet.add_gridspec(2, 2)
for cell, (after, tube, run) in enumerate(zip(placings, tubes, runs, strict=True)):
    room = [each.surface() for each in (taught, *tubes)]
    axes = fig.space(sheet, grid[cell], fig.seen_flat(taught), room)
    axes.title(f"Start moved by {100 * np.linalg.norm(after[0] - before[0]):.0f} cm")
    fig.former(axes, taught)
    fig.tube(axes, tube)
    fig.lines(axes, list(run.positions), "reproductions", color=fig.REPRODUCTION, linewidth=1.0)
    closes, opens = np.flatnonzero(np.diff(run.gripper)) + 1
    for sample, mark, words in ((closes, "v", "hand closes"), (opens, "^", "hand opens")):
        axes.plot(run.positions[0, sample], mark, color=fig.INK, markersize=5, label=words, zorder=9)
    fig.landmarks(axes, before, after)
fig.scale_bar(axes, 0.2)
fig.legend(sheet)
figure = fig.save(sheet, "07_new_starts")
