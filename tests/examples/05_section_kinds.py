"""One motion, four kinds of section: Fig. 6 of the paper.

``python tests/examples/05_section_kinds.py [--out FOLDER]``
"""

import figures as fig

from app.files import read
from app.resources import static_folder
from gc_core import encode

demonstrations = read(static_folder() / "skills" / "reaching.csv", units="m")
shown = [demonstration.positions for demonstration in demonstrations]

# 128 corners a section let the hull follow the demonstrations closely.
kinds = {"circle": "Circle", "ellipse": "Ellipse", "closed_spline": "Closed spline", "hull": "Hull"}
cylinders = {kind: encode(demonstrations, section=kind, angles=128) for kind in kinds}
for kind, cylinder in cylinders.items():
    print(f"{kind}: {1000 * cylinder.volume:.1f} dm3")

sheet = fig.sheet(8.6, 5.4)
grid = sheet.add_gridspec(2, 4, width_ratios=(1.9, 1, 1.9, 1))
middle, widest = 60, cylinders["circle"]
reach = 118 * widest.radii[middle].max()
for place, (kind, cylinder) in enumerate(cylinders.items()):
    row, column = divmod(place, 2)
    axes = fig.space(sheet, grid[row, 2 * column], fig.seen_flat(widest), [widest.surface()])
    fig.tube(axes, cylinder)
    fig.lines(axes, shown, "demonstrations", color=fig.DEMONSTRATION, linewidth=0.7)
    section = cylinder.surface()[middle]
    fig.lines(axes, [section[[*range(128), 0]]], "section beside it", color=fig.INK, linewidth=1.0)
    axes.title(f"{kinds[kind]}: {1000 * cylinder.volume:.1f} dm³")
    fig.scale_bar(axes, 0.2)

    section = sheet.add_subplot(grid[row, 2 * column + 1])
    fig.slice_of(section, cylinder, middle)
    section.set(xlim=(-reach, reach), ylim=(-reach, reach))
fig.legend(sheet)
figure = fig.save(sheet, "05_section_kinds")
