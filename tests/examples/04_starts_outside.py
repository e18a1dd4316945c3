"""Begin outside of the tube, and say what that should mean.

``python tests/examples/04_starts_outside.py [--out FOLDER]``
"""

import figures as fig
import numpy as np

from app.files import read
from app.resources import static_folder
from gc_core import encode, reproduce

demonstrations = read(static_folder() / "skills" / "reaching.csv", units="m")
cylinder = encode(demonstrations)

# Below the first section, half its width outside of the boundary.
centre, boundary = cylinder.directrix[0], cylinder.surface()[0]
start = centre + 1.8 * (boundary[np.argmin(boundary[:, 2])] - centre)

# The run always begins at the start itself; the policy says where it is led.
policies = {
    "keep": "keep the ratio",
    "boundary": "ease to the boundary",
    "directrix": "ease to the directrix",
}
runs = {policy: reproduce(cylinder, start, outside=policy) for policy in policies}
for policy, run in runs.items():
    print(f"{policy}: ratio {run.ratios[0]:.2f} at the start, {run.ratios[-1]:.2f} at the end")

sheet = fig.sheet(7.2, 3.9)
grid = sheet.add_gridspec(1, 2, width_ratios=(2.2, 1), wspace=0.12)
axes = fig.space(sheet, grid[0], fig.seen_flat(cylinder))
fig.tube(axes, cylinder)
ratios = sheet.add_subplot(grid[1], box_aspect=1.1)
for (policy, words), dashes in zip(policies.items(), ("-", "--", ":"), strict=True):
    look = {"color": fig.REPRODUCTION, "linewidth": 1.8, "linestyle": dashes, "label": words}
    axes.plot(runs[policy].positions, **look)
    ratios.plot(100 * cylinder.arc_length[-len(runs[policy].ratios) :], runs[policy].ratios, **look)
axes.plot(start, "o", color=fig.REPRODUCTION, markersize=6, label="start")
fig.scale_bar(axes, 0.2)
fig.legend(sheet)
ratios.axhline(1, color=fig.TUBE, linewidth=1.2)
ratios.annotate("boundary", (100, 1), xytext=(0, 3), textcoords="offset points", ha="right", color=fig.INK)
ratios.set(xlabel="length of the directrix [cm]", ylabel="ratio η", ylim=0)
figure = fig.save(sheet, "04_starts_outside")
