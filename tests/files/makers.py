"""Files of every kind, made in memory; and the real data, when it is there."""

import io
import os
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest
from scipy.io import savemat

from gc_core import Demonstration

DATA = Path(os.environ.get("GC_TEACH_DATA", Path(__file__).parents[3] / "shared" / "data"))
needs_data = pytest.mark.skipif(
    not DATA.is_dir(), reason=f"no public data sets at {DATA}; set GC_TEACH_DATA to their folder"
)


def line(n: int = 20, *, scale: float = 1.0) -> np.ndarray:
    """A curved path of (n, 3)."""
    u = np.linspace(0.0, 1.0, n)
    return scale * np.stack([u, np.sin(u), 0.3 + u**2], axis=1)


def quaternions(n: int = 20) -> np.ndarray:
    """Unit quaternions (n, 4), wxyz, that turn about z."""
    half = np.linspace(0.0, 0.7, n)
    return np.stack([np.cos(half), 0.0 * half, 0.0 * half, np.sin(half)], axis=1)


def demonstrations() -> list[Demonstration]:
    """Three of different lengths; not all have orientations, a gripper or a name."""
    rng = np.random.default_rng(5)
    return [
        Demonstration(
            np.cumsum(rng.uniform(0.005, 0.02, 20)), line(20), quaternions(20), name="Over the top"
        ),
        Demonstration(np.arange(31) / 30.0, line(31) * 0.9, gripper=np.repeat([0.0, 1.0], [15, 16])),
        Demonstration(np.arange(12) * 0.1, line(12) + 0.1, quaternions(12), np.ones(12), "from, the; left"),
    ]


def csv_of(rows: np.ndarray, header: str = "t,x,y,z") -> bytes:
    body = "\n".join(",".join(repr(float(v)) for v in row) for row in rows)
    return f"{header}\n{body}\n".encode()


def mat_of(*paths: np.ndarray, name: str = "smoothData") -> bytes:
    cell = np.empty((1, len(paths)), dtype=object)
    cell[0, :] = list(paths) if len(paths) > 1 else [paths[0]]
    out = io.BytesIO()
    savemat(out, {name: cell}, do_compression=True)
    return out.getvalue()


def npy_of(array: np.ndarray, *, allow_pickle: bool = False) -> bytes:
    out = io.BytesIO()
    np.save(out, array, allow_pickle=allow_pickle)
    return out.getvalue()


def npz_of(**arrays: np.ndarray) -> bytes:
    out = io.BytesIO()
    np.savez_compressed(out, **arrays)
    return out.getvalue()


def zip_of(members: dict[str, bytes]) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return out.getvalue()


def hdf5_of(poses: np.ndarray, clock: np.ndarray | None = None) -> bytes:
    out = io.BytesIO()
    with h5py.File(out, "w") as file:
        file["demo1/tf_info/pos_rot_data"] = poses
        if clock is not None:
            file["demo1/time_info/time_data"] = clock
    return out.getvalue()


def poses_of(positions: np.ndarray, wxyz: np.ndarray) -> np.ndarray:
    """(7, T) as the lab writes it: xyz, then xyzw."""
    return np.vstack([positions.T, wxyz[:, [1, 2, 3, 0]].T])


GOOD: dict[str, bytes] = {
    "a.csv": csv_of(np.column_stack([np.arange(20) / 10.0, line()])),
    "a.mat": mat_of(line(), line() + 0.1),
    "a.npy": npy_of(np.stack([line(), line() + 0.1])),
    "a.npz": npz_of(positions=np.stack([line(), line() + 0.1]), times=np.arange(20) / 10.0),
    "a.h5": hdf5_of(poses_of(line(), quaternions()), np.stack([np.full(20, 1.6e9), np.arange(20) * 4e7])),
}
"""One well-formed file of each kind."""
