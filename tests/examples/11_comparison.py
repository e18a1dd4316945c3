"""Five starts beside other methods: Fig. 9 of the paper.

``python tests/examples/11_comparison.py [--out FOLDER]``
"""

import figures as fig

from app.baselines import methods
from app.comparison import Task, claims, compare
from app.resources import static_folder
from app.skills import load_skill

skill = load_skill(static_folder() / "skills", "around_an_obstacle")
demonstrations = tuple(each.demonstration for each in skill.demonstrations)
shown = [each.positions for each in demonstrations]
task = Task(demonstrations, things=skill.things)
names = {
    "gc": "Generalized cylinder",
    "dmp-5": "DMP, 5 weights",
    "dmp-10": "DMP, 10 weights",
    "ramp": "Mean with a linear ramp",
    "gmr-5": "GMM/GMR, 5 Gaussians",
    "gmr-10": "GMM/GMR, 10 Gaussians",
}
found = compare(task, methods(tuple(names)), 5)

# Each claim comes with what was measured, and says so where it does not hold.
for claim in claims(found):
    print(claim.sentence)
for row in found.rows:
    print(row.failed or f"{row.method}: {row.contacts} of 5 runs touch what is in the way")

sheet = fig.sheet(8.6, 5.6)
grid = sheet.add_gridspec(2, 3)
for cell, row in enumerate(found.rows):
    room = [found.cylinder.surface(), *shown, *map(fig.faces_of, task.things)]
    axes = fig.space(sheet, grid[cell], fig.seen_flat(found.cylinder), room)
    fig.bodies(axes, task.things)
    fig.lines(
        axes, [each.positions for each in demonstrations], "demonstrations", color=fig.DEMONSTRATION, lw=0.6
    )
    runs = [run.positions for run in found.runs.get(row.method, ())]
    fig.lines(axes, runs, "runs from five starts", color=fig.REPRODUCTION, lw=1.4)
    axes.plot(found.starts, "o", color=fig.INK, markersize=3, label="starts")
    left = "failed" if row.spread_mid_m is None else f"half way {100 * row.spread_mid_m:.1f} cm apart"
    axes.title(f"{names[row.method]}\n{left}")
fig.scale_bar(axes, 0.2)
fig.legend(sheet)
figure = fig.save(sheet, "11_comparison")
