"""Move both ends at once: Fig. 7 of the paper.

``python tests/examples/08_both_ends.py [--out FOLDER]``
"""

import figures as fig
import numpy as np

from app.files import read
from app.resources import static_folder
from app.skills import load_card
from gc_core import encode, generalize, metrics, register, reproduce

skills = static_folder() / "skills"
new_places = {
    "curved_reach_and_place": ((0.44, -0.12, 0.18), (-0.16, -0.36, 0.13)),
    "pick_and_place": ((0.26, -0.46, 0.14), (-0.38, -0.34, 0.06)),
}

sheet = fig.sheet(8.6, 4.2)
grid = sheet.add_gridspec(1, len(new_places))
before, after, taught, tubes, runs = {}, {}, {}, {}, {}
for column, (name, places) in enumerate(new_places.items()):
    card = load_card(skills, name)
    taught[name] = encode(read(skills / f"{name}.csv", units="m"), align_by="arc_length")

    # Two landmarks, both moved: the map turns and stretches space along the line between them.
    before[name] = np.array([taught[name].directrix[0], card.goal])
    after[name] = np.array(places)
    bend = register(before[name], after[name])
    tube = tubes[name] = generalize(taught[name], bend)
    runs[name] = reproduce(tube, 0.3 * tube.directrix[0] + 0.7 * tube.surface()[0, ::16])

    moved = 100 * np.linalg.norm(after[name] - before[name], axis=1)
    missed = 1000 * np.linalg.norm(tube.directrix[[0, -1]] - after[name], axis=1).max()
    inside = 100 * min(metrics.containment(tube, path) for path in runs[name].positions)
    print(f"{card.title}: start moved by {moved[0]:.0f} cm, goal by {moved[1]:.0f} cm ({bend.case})")
    print(f"    landmarks met to {missed:.1f} mm, {inside:.0f} % of the runs inside")

    axes = fig.space(sheet, grid[column], fig.seen_flat(taught[name]))
    axes.title(f"{card.title}: start by {moved[0]:.0f} cm, goal by {moved[1]:.0f} cm")
    fig.former(axes, taught[name])
    fig.tube(axes, tube)
    fig.lines(axes, list(runs[name].positions), "reproductions", color=fig.REPRODUCTION, linewidth=1.0)
    fig.landmarks(axes, before[name], after[name])
    fig.scale_bar(axes, 0.2)
fig.legend(sheet)
figure = fig.save(sheet, "08_both_ends")
