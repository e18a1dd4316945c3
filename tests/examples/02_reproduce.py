"""Run a learned skill from new starts by the ratio rule, with both laws.

``python tests/examples/02_reproduce.py [--out FOLDER]``
"""

import figures as fig
import numpy as np

from app.files import read
from app.resources import static_folder
from gc_core import encode, metrics, reproduce

demonstrations = read(static_folder() / "skills" / "reaching.csv", units="m")
cylinder = encode(demonstrations)

# Four starts in the first section, each at the same part of the way from the centre to the boundary.
centre, boundary = cylinder.directrix[0], cylinder.surface()[0]
starts = centre + 0.8 * (boundary[:: len(boundary) // 4] - centre)

# A run keeps its direction in the moving frame; "fixed" keeps its ratio to the boundary as well,
# "convergent" takes the ratio to zero, so that all runs end in one place.
fixed = reproduce(cylinder, starts)
convergent = reproduce(cylinder, starts, law="convergent")

goal = cylinder.directrix[-1]
for name, runs in (("fixed", fixed), ("convergent", convergent)):
    ends = [1000 * metrics.end_error(path, goal) for path in runs.positions]
    inside = min(metrics.containment(cylinder, path) for path in runs.positions)
    print(f"{name}: {100 * inside:.0f} % inside, ends within {max(ends):.1f} mm of the directrix's end")

sheet = fig.sheet(7.2, 3.9)
grid = sheet.add_gridspec(1, 2, width_ratios=(2.2, 1), wspace=0.12)
axes = fig.space(sheet, grid[0], fig.seen_flat(cylinder))
fig.tube(axes, cylinder)
shown = [demonstration.positions for demonstration in demonstrations]
fig.lines(axes, shown, "demonstrations", color=fig.DEMONSTRATION, linewidth=0.6, alpha=0.6)
fig.lines(axes, list(fixed.positions), "reproductions, fixed law", color=fig.REPRODUCTION, linewidth=1.6)
axes.plot(starts, "o", color=fig.REPRODUCTION, markersize=5, label="new starts")
fig.scale_bar(axes, 0.2)
fig.legend(sheet)

away = sheet.add_subplot(grid[1])
for runs, style, name in ((fixed, "-", "fixed"), (convergent, "--", "convergent")):
    distance = 100 * np.linalg.norm(runs.positions - cylinder.directrix, axis=2)
    paths = [np.stack((100 * cylinder.arc_length, row), axis=1) for row in distance]
    fig.lines(away, paths, name, color=fig.REPRODUCTION, linewidth=1.1, linestyle=style)
away.set(xlabel="length of the directrix [cm]", ylabel="distance from it [cm]", ylim=0, box_aspect=1.1)
away.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncols=2)
figure = fig.save(sheet, "02_reproduce")
