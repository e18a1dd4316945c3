"""Files that are none: truncated, of wrong types, not finite, huge, bombs, pickles, tricks with names."""

from __future__ import annotations

import io
import json
import pickle
import struct
from typing import Final

import h5py
import numpy as np

from tests.files.makers import GOOD, csv_of, hdf5_of, line, mat_of, npy_of, npz_of, zip_of

TRACES: Final[list[str]] = []
"""What a file's code would leave here, if it was run."""


class Bomb:
    """Leaves a trace when it is unpickled."""

    def __reduce__(self) -> tuple[object, ...]:
        return (TRACES.append, ("ran",))


def _nan() -> np.ndarray:
    path = line()
    path[6, 1] = np.nan
    return path


def _announcing(shape: tuple[int, ...]) -> bytes:
    out = io.BytesIO()
    np.lib.format.write_array_header_1_0(out, {"descr": "<f8", "fortran_order": False, "shape": shape})
    return out.getvalue()


def _bomb() -> bytes:
    """An archive that announces two gigabytes."""
    content = zip_of({"positions.npy": bytes(1000)})
    size = content.rindex(b"PK\1\2") + 24
    return content[:size] + struct.pack("<I", 2**31) + content[size + 4 :]


def _linked(**parts: object) -> bytes:
    out = io.BytesIO()
    with h5py.File(out, "w") as file:
        for name, part in parts.items():
            file[name] = part
    return out.getvalue()


_HEADER: Final = json.dumps({"format": 1, "document": {"Document": {"title": "x"}}})

MALFORMED: Final[dict[str, bytes]] = {
    "half.mat": GOOD["a.mat"][: len(GOOD["a.mat"]) // 2],
    "half.npy": GOOD["a.npy"][: len(GOOD["a.npy"]) // 2],
    "half.npz": GOOD["a.npz"][: len(GOOD["a.npz"]) // 2],
    "half.h5": GOOD["a.h5"][: len(GOOD["a.h5"]) // 2],
    "half.gcteach": zip_of({"skill.json": _HEADER.encode()})[:-20],
    "empty.csv": b"",
    "blank.npz": b" \n ",
    "noise.mat": bytes(range(256)) * 8,
    "noise.gcteach": bytes(range(256)) * 8,
    "picture.csv": b"\x89PNG\r\n\x1a\n" + bytes(64),
    "words.csv": b"t,x,y,z\n0,here,and,there\n",
    "short.csv": b"x,y,z\n0,0,0\n1,1\n",
    "flat.csv": b"t,x,y\n0,0,0\n1,1,1\n",
    "backwards.csv": b"t,x,y,z\n0,0,0,0\n2,1,0,0\n1,2,0,0\n",
    "text.npy": npy_of(np.array([["a", "b", "c"]] * 5)),
    "planar.npy": npy_of(line()[:, :2]),
    "cell.mat": mat_of(line(), name="somethingElse"),
    "rows.h5": hdf5_of(np.ones((6, 20))),
    "nan.csv": csv_of(np.column_stack([np.arange(20) / 10.0, _nan()])),
    "nan.mat": mat_of(_nan()),
    "nan.npz": npz_of(positions=_nan()),
    "infinite.csv": b"x,y,z\n0,0,0\n1e999,0,0\n",
    "far.csv": b"x,y,z\n0,0,0\n1e300,0,0\n",
    "announced.npy": _announcing((10**12, 3)),
    "announced.npz": zip_of({"positions.npy": _announcing((10**12, 3))}),
    "many.npy": npy_of(np.zeros((200_001, 3), dtype=np.int8)),
    "bomb.npz": _bomb(),
    "bomb.gcteach": _bomb(),
    "pickle.npy": pickle.dumps(Bomb()),
    "objects.npz": zip_of({"positions.npy": npy_of(np.array([Bomb()], dtype=object), allow_pickle=True)}),
    "outside.gcteach": zip_of({"skill.json": _HEADER.encode(), "../../outside.npy": npy_of(line())}),
    "link.h5": _linked(demo1=h5py.ExternalLink("/etc/passwd", "/demo1")),
    "no_kind.exe": b"MZ" + bytes(100),
}
