"""Correct one demonstration and learn again: Fig. 10 of the paper.

``python tests/examples/09_incremental_refinement.py [--out FOLDER]``
"""

import figures as fig
import numpy as np

from app.files import read
from app.resources import static_folder
from gc_core import encode, refined, reproduce, soft_correction

skills = static_folder() / "skills"
demonstrations = read(skills / "the_dip.csv", units="m")
before = encode(demonstrations, align_by="arc_length")

# The first demonstration is pulled down in its middle. The pull fades out along the path: its ends stay.
path = demonstrations[0].positions
length = np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))
grabbed = int(np.searchsorted(length, 0.5 * length[-1]))
dipped = soft_correction(path, grabbed, displacement=(0.0, 0.0, -0.09), width=0.25)

# It takes the place of its original, and the skill is learned again: the mean dips by one third of that.
corrected = refined(demonstrations, 0, dipped)
after = encode(corrected, align_by="arc_length")
sunk = (before.directrix - after.directrix)[:, 2]
print(
    f"pulled by {100 * (path - dipped)[:, 2].max():.1f} cm: the directrix sinks by {100 * sunk.max():.1f} cm"
)

# New runs from the same ratio, in the middle and level with it, sink with it.
runs = []
for tube in (before, after):
    rim = tube.surface()[0, np.argmin(np.abs(tube.surface()[0, :, 2] - tube.directrix[0, 2]))]
    runs.append(reproduce(tube, tube.directrix[0] + np.outer([0.0, 0.5], rim - tube.directrix[0])).positions)
print("new runs sink by", *(f"{100 * fall:.1f} cm" for fall in (runs[0] - runs[1])[:, :, 2].max(axis=1)))

sheet = fig.sheet(7.2, 5.2)
grid = sheet.add_gridspec(2, 1)
for column, (tube, run) in enumerate(zip((before, after), runs, strict=True)):
    room = [before.surface(), after.surface(), dipped]
    axes = fig.space(sheet, grid[column], fig.seen_across(before), room)
    axes.title(("As shown", "Demonstration 1 corrected, learned again")[column])
    fig.tube(axes, tube)
    shown = [shown.positions for shown in (demonstrations, corrected[1:])[column]]
    fig.lines(axes, shown, "demonstrations", color=fig.DEMONSTRATION, linewidth=0.9)
    fig.lines(axes, list(run[1:]), "reproduction", color=fig.REPRODUCTION, linewidth=1.6)
    if column:
        axes.plot(path, color=fig.INK, linewidth=0.9, linestyle="--", label="before its correction")
        axes.plot(dipped, color=fig.REFINED, linewidth=2.0, label="corrected")
        fig.scale_bar(axes, 0.2)
fig.legend(sheet)
figure = fig.save(sheet, "09_incremental_refinement")
