"""Learn a generalized cylinder from five demonstrations, and look at it.

``python tests/examples/01_encode.py [--out FOLDER]``
"""

import figures as fig

from app.files import read
from app.resources import static_folder
from gc_core import encode, metrics

demonstrations = read(static_folder() / "skills" / "reaching.csv", units="m")

# The middle line, a frame at each of its 200 stations, and in each frame's plane a closed curve around
# the places where the demonstrations cross it.
cylinder = encode(demonstrations, section="closed_spline", stations=200)

shown = [demonstration.positions for demonstration in demonstrations]
inside = metrics.containment(cylinder, cylinder.effective_points.reshape(-1, 3))
print(f"{len(shown)} demonstrations -> {len(cylinder.directrix)} stations, {cylinder.arc_length[-1]:.2f} m")
print(f"volume: {1000 * cylinder.volume:.1f} dm3, crossings inside: {100 * inside:.0f} %")
print(*cylinder.diagnostics.sentences(), sep="\n")

middle = 60
sheet = fig.sheet(7.2, 3.9)
grid = sheet.add_gridspec(1, 2, width_ratios=(2.2, 1), wspace=0.12)
axes = fig.space(sheet, grid[0], fig.seen_flat(cylinder))
fig.tube(axes, cylinder)
fig.lines(axes, shown, "demonstrations", color=fig.DEMONSTRATION, linewidth=0.9)
section = cylinder.surface()[middle]
fig.lines(axes, [section[[*range(len(section)), 0]]], "section on the right", color=fig.INK, linewidth=1.1)
fig.scale_bar(axes, 0.2)

section_axes = sheet.add_subplot(grid[1])
fig.slice_of(section_axes, cylinder, middle)
section_axes.set_title(f"Section at {100 * cylinder.arc_length[middle]:.0f} cm")
fig.legend(sheet)
figure = fig.save(sheet, "01_encode")
