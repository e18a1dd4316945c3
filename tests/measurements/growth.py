"""How does the time to encode grow? ``python -m tests.measurements.growth --out docs/growth.png``.

Demonstrations, samples and stations grow one at a time, from five demonstrations of 1,500 samples at 200
stations x 64 angles. Beside the picture a page with the slopes is written, under the same name.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import tyro
from matplotlib.figure import Figure

from gc_core import encode
from gc_core.alignment import ALIGNMENTS
from gc_core.arrays import FloatArray
from tests.core.shapes import bundle

SIZES: Final[Mapping[str, tuple[int, ...]]] = {
    "demonstrations": (5, 10, 20, 35, 50, 70, 100),
    "samples": (1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000),
    "stations": (50, 100, 200, 400, 700, 1_000, 1_400, 2_000),
}
USUAL: Final = {"demonstrations": 5, "samples": 1_500, "stations": 200}
LINEAR: Final = 1.05
"""A slope up to this is called linear: 1 and what repeated measuring leaves open [-]."""
ROUNDS: Final = 5
LONG: Final = 20.0
"""Nothing larger is tried after an encoding that took this long [s]."""
BOUND: Final = ("time", "arc_length")
"""Alignments that must not grow worse than linearly; others are shown for information."""


@dataclass(frozen=True, eq=False)
class Growth:
    """Times of one alignment along one size."""

    size: str
    align_by: str
    numbers: FloatArray
    """(K,) of demonstrations, samples or stations."""
    seconds: FloatArray
    """(K,) of processor time, the least of some rounds [s]."""

    @property
    def slope(self) -> float:
        """Of the straight line through all points on logarithmic axes."""
        return _slope(self.numbers, self.seconds)

    @property
    def last_slope(self) -> float:
        """Of the line through the three largest sizes."""
        return _slope(self.numbers[-3:], self.seconds[-3:])

    @property
    def linear(self) -> bool:
        """Whether it grows no worse than linearly, over all sizes and over the largest."""
        return max(self.slope, self.last_slope) <= LINEAR


def measure(size: str, align_by: str) -> Growth:
    """Encode ever larger problems."""
    numbers: list[int] = []
    seconds: list[float] = []
    for number in SIZES[size]:
        numbers.append(number)
        seconds.append(_least_time(USUAL | {size: number}, align_by))
        if seconds[-1] > LONG:
            break
    return Growth(size, align_by, np.array(numbers, dtype=np.float64), np.array(seconds))


def _least_time(sizes: Mapping[str, int], align_by: str) -> float:
    """Least processor time to encode fresh demonstrations [s]; alone or not, the machine does that work."""
    took: list[float] = []
    for _ in range(ROUNDS):
        shown = bundle(0, sizes["demonstrations"], sizes["samples"])
        begin = time.process_time()
        encode(shown, stations=sizes["stations"], align_by=align_by)
        took.append(time.process_time() - begin)
        if took[-1] > 1.0:
            break
    return min(took)


def _slope(numbers: FloatArray, seconds: FloatArray) -> float:
    return float(np.polyfit(np.log(numbers), np.log(seconds), 1)[0])


def picture(grown: list[Growth]) -> Figure:
    """One plot for each size, on logarithmic axes."""
    figure = Figure(figsize=(12.0, 4.0), layout="constrained")
    for axes, size in zip(np.ravel(figure.subplots(1, len(SIZES))), SIZES, strict=True):
        mine = [growth for growth in grown if growth.size == size]
        for growth in mine:
            label = f"{growth.align_by}: slope {growth.slope:.2f}"
            axes.loglog(growth.numbers, 1000.0 * growth.seconds, "o-", label=label)
        first = mine[0]
        guide = first.seconds[0] * first.numbers / first.numbers[0]
        axes.loglog(first.numbers, 1000.0 * guide, "k:", label="linear")
        axes.set(xlabel=size, ylabel="encode [ms]")
        axes.grid(visible=True, which="both", alpha=0.25)
        axes.legend(fontsize="small")
    return figure


PAGE: Final = """# How encoding grows

Made by `python -m tests.measurements.growth --out docs/growth.png`: closed splines of 64 angles, from
{demonstrations} demonstrations of {samples:,} samples at {stations} stations, of which one grows at a time.
Every time is the least processor time of {rounds}, with demonstrations that no cache knows. The slope
is that of the straight line on logarithmic axes, over all sizes and over the three largest; not worse
than linear means at most {linear} in both.

![time to encode by number of demonstrations, samples and stations]({picture})

| grows | alignment | from | to | slope | largest | not worse than linear |
|---|---|---|---|---|---|---|
"""


def page(grown: list[Growth], name: str) -> str:
    """The table of slopes, in Markdown."""
    text = PAGE.format(**USUAL, rounds=ROUNDS, linear=LINEAR, picture=name)
    for g in grown:
        ends = " | ".join(
            f"{number:,.0f}: {1000.0 * second:.1f} ms"
            for number, second in zip(g.numbers[[0, -1]], g.seconds[[0, -1]], strict=True)
        )
        verdict = "yes" if g.linear else "no" if g.align_by in BOUND else "no (for information)"
        text += f"| {g.size} | {g.align_by} | {ends} | {g.slope:.2f} | {g.last_slope:.2f} | {verdict} |\n"
    return text


def main(*, out: Path = Path("docs/growth.png"), align: tuple[str, ...] = ALIGNMENTS) -> None:
    """Measure, draw and write.

    Parameters
    ----------
    out
        Picture; the page goes beside it.
    align
        Alignments.
    """
    grown: list[Growth] = []
    for size in SIZES:
        for align_by in align:
            grown.append(measure(size, align_by))
            g = grown[-1]
            print(f"{size:16}{align_by:12} slope {g.slope:.2f}, largest {g.last_slope:.2f}", flush=True)
    picture(grown).savefig(out, dpi=100)
    text = page(grown, out.name)
    out.with_suffix(".md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    tyro.cli(main)
