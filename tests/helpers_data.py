"""Public recordings for tests, from `../shared/data` beside the repository or from $GC_TEACH_DATA.

Nothing of it is part of the project: tests that need it skip, and say so, where it is missing.
"""

from __future__ import annotations

import os
from pathlib import Path

import h5py
import numpy as np
import pytest
import scipy.io

from gc_core import Demonstration

DATA = Path(os.environ.get("GC_TEACH_DATA", Path(__file__).resolve().parents[1].parent / "shared" / "data"))

TLGC_SETS = ("alpha", "reaching1", "synthetic0")
POSE_SETS = ("bottle2shelf", "openbox", "platestandingtolying", "pouring")
ALL_SETS = (*TLGC_SETS, *POSE_SETS, "lab")

HUNDREDTH_SECOND = 0.01
CENTIMETRE = 0.01


def load(name: str) -> list[Demonstration]:
    """Demonstrations [m, s] of one of `ALL_SETS`; skips the test when the data are not there."""
    if not DATA.is_dir():
        pytest.skip(f"the public recordings are not at {DATA.name}; set GC_TEACH_DATA to their folder")
    if name in TLGC_SETS:
        return _tlgc(name)
    return _lab() if name == "lab" else _poses(name)


def _tlgc(name: str) -> list[Demonstration]:
    cells = scipy.io.loadmat(DATA / "tlgc" / f"{name}.mat")["smoothData"].ravel()
    return [
        Demonstration(HUNDREDTH_SECOND * np.arange(len(path)), path, name=f"{name} {j + 1}")
        for j, path in enumerate(cells)
    ]


def _poses(name: str) -> list[Demonstration]:
    recorded = np.load(DATA / "robotasks" / "pos_ori" / f"{name}.npy")
    times = HUNDREDTH_SECOND * np.arange(recorded.shape[1])
    return [
        Demonstration(times, CENTIMETRE * poses[:, :3], orientations=poses[:, 3:], name=f"{name} {j + 1}")
        for j, poses in enumerate(recorded)
    ]


def _lab() -> list[Demonstration]:
    return [_lab_recording(path) for path in sorted((DATA / "canal_lab_demos").glob("*.h5"))]


def _lab_recording(path: Path) -> Demonstration:
    with h5py.File(path) as file:
        poses = np.asarray(file["demo1/tf_info/pos_rot_data"]).T
        seconds, nanoseconds = np.asarray(file["demo1/time_info/time_data"])
    times = (seconds - seconds[0]) + 1e-9 * nanoseconds
    fresh = np.concatenate(([True], np.diff(np.maximum.accumulate(times)) > 0.0))
    return Demonstration(
        times[fresh] - times[0], poses[fresh, :3], orientations=poses[fresh][:, [6, 3, 4, 5]], name=path.stem
    )
