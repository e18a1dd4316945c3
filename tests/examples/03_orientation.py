"""Learn how the hand turns, and turn it so in a new run.

``python tests/examples/03_orientation.py [--out FOLDER]``
"""

from dataclasses import replace

import figures as fig
import numpy as np

from app.files import read
from app.resources import static_folder
from gc_core import Demonstration, encode, reproduce


def lowering(shown: Demonstration, begin: float, end: float) -> Demonstration:
    """Let the hand, which points along its x axis, sink from one angle below level to another [rad]."""
    part = shown.times / shown.times[-1]
    half = 0.5 * (begin + (end - begin) * part**2 * (3.0 - 2.0 * part))
    zero = np.zeros_like(half)
    # A turn by twice `half` about y, then half a turn about z: the goal lies towards -x.
    return replace(shown, orientations=np.stack((zero, -np.sin(half), zero, np.cos(half)), axis=1))


def pointing(wxyz: np.ndarray) -> np.ndarray:
    """Where the hand points (K, 3): its x axis."""
    w, x, y, z = wxyz.T
    return np.stack((1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)), axis=1)


# The built-in recordings have positions only; here, nobody holds the hand quite as in the other ones.
recorded = read(static_folder() / "skills" / "reaching.csv", units="m")
habits = np.deg2rad([(2, 80), (15, 86), (8, 68), (-6, 89), (20, 76)])
demonstrations = [lowering(shown, *habit) for shown, habit in zip(recorded, habits, strict=True)]

# The mean rotation of each station is learned, and a run takes it along.
cylinder = encode(demonstrations)
run = reproduce(cylinder, start=cylinder.directrix[0] + 0.5 * cylinder.radii[0, 0] * cylinder.frames[0, :, 1])
below = np.rad2deg(np.arcsin(-pointing(run.orientations)[:, 2]))
print(f"The hand sinks from {below[0]:.1f} to {below[-1]:.1f} degrees below level.")

sheet = fig.sheet(7.2, 3.9)
grid = sheet.add_gridspec(1, 2, width_ratios=(2.2, 1), wspace=0.12)
axes = fig.space(sheet, grid[0], fig.seen_flat(cylinder))
fig.tube(axes, cylinder)
axes.plot(run.positions, color=fig.REPRODUCTION, linewidth=2.0, label="reproduction")
some = np.linspace(0, len(run.positions) - 1, 13).astype(int)
tips = run.positions[some] + 0.09 * pointing(run.orientations[some])
hands = list(np.stack((run.positions[some], tips), axis=1))
fig.lines(axes, hands, "where the hand points", color=fig.INK, linewidth=1.6)
axes.plot(tips, "o", color=fig.INK, markersize=2.5)
fig.scale_bar(axes, 0.2)
fig.legend(sheet)

angles = sheet.add_subplot(grid[1], box_aspect=1.1, xlabel="time [s]", ylabel="hand below level [°]")
shown = [(d.times, np.rad2deg(np.arcsin(-pointing(d.orientations)[:, 2]))) for d in demonstrations]
fig.lines(angles, [np.stack(pair, axis=1) for pair in shown], "shown", color=fig.DEMONSTRATION, linewidth=0.9)
angles.plot(run.times, below, color=fig.REPRODUCTION, linewidth=2.2, label="reproduction")
angles.legend()
figure = fig.save(sheet, "03_orientation")
