"""What the examples draw with, and where their figures go."""

from __future__ import annotations

import argparse
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib as mpl
from PIL import Image

from app.figures.sheet import (
    DEMONSTRATION,
    INK,
    REFINED,
    REPRODUCTION,
    STYLE,
    TUBE,
    arrows,
    bodies,
    faces_of,
    former,
    landmarks,
    legend,
    lines,
    saved,
    scale_bar,
    sheet,
    slice_of,
    space,
    tube,
)
from app.figures.views import seen_across, seen_flat

__all__ = (
    "DEMONSTRATION",
    "INK",
    "REFINED",
    "REPRODUCTION",
    "TUBE",
    "arrows",
    "bodies",
    "faces_of",
    "former",
    "landmarks",
    "legend",
    "lines",
    "save",
    "scale_bar",
    "seen_across",
    "seen_flat",
    "sheet",
    "slice_of",
    "space",
    "tube",
)

mpl.rcParams |= STYLE


def save(figure: Any, name: str) -> Path:
    """Write a figure into the folder given by ``--out``, or here, and say where it is."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", type=Path, default=Path(), help="folder for the figure")
    folder: Path = parser.parse_args().out
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.png"
    with Image.open(BytesIO(saved(figure, "png", 130))) as picture:
        small = picture.convert("RGB").quantize(192, dither=Image.Dither.NONE)
    small.save(path, optimize=True)
    print(f"figure: {path}")
    return path
