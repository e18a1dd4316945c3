"""A study cut into independent parts: one experiment with one method on one data set.

What a part finds depends on the plan, its data and the versions alone, never on the order or on
who works at it; its key is made of all of these, so that a finished part is known again.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import lru_cache
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from itertools import product
from pathlib import Path
from typing import Final, Literal, TypeAlias

import numpy as np

from app.document import Alignment
from app.study.measures import Row
from app.study.sources import DataSet
from app.study.spec import Plan, Spec

Experiment: TypeAlias = Literal["left_out", "moves", "starts"]
EXPERIMENTS: Final[tuple[Experiment, ...]] = ("left_out", "moves", "starts")
TUBE: Final = "gc"
"""The method that has kinds of slices."""
OURS: Final = "gc-teach"
CODE: Final = ("gc_core/*.py", "app/baselines/*.py", "app/study/*.py", "app/comparison.py", "app/likeness.py")
PACKAGES: Final = (OURS, "numpy", "scipy", "dtaidistance", "gmr", "movement_primitives")
"""What the numbers come from."""


@dataclass(frozen=True, order=True)
class Part:
    """What is done at once, in the order of the tables."""

    experiment: Experiment
    data_set: str
    alignment: Alignment
    method: str
    section: str
    """Kind of slices; empty for methods without."""

    @property
    def name(self) -> str:
        """How it is called, whatever else is done."""
        return "/".join((self.experiment, self.data_set, self.alignment, self.method, self.section or "-"))


def parts_of(spec: Spec, data: Sequence[DataSet]) -> tuple[Part, ...]:
    """Cut a study into parts, sorted.

    A single demonstration cannot be left out, so that data sets of one have no such part.
    """
    asked = (spec.plan.leave_one_out, spec.plan.moves > 0, spec.plan.starts > 0)
    wanted: list[Experiment] = [each for each, is_asked in zip(EXPERIMENTS, asked, strict=True) if is_asked]
    kinds = [
        (method, section)
        for method in spec.methods
        for section in (spec.sections if method == TUBE else ("",))
    ]
    return tuple(
        sorted(
            Part(experiment, each.name, alignment, method, section)
            for experiment, each, alignment, (method, section) in product(
                wanted, data, spec.alignments, kinds
            )
            if experiment != "left_out" or len(each.demonstrations) > 1
        )
    )


def key_of(plan: Plan, part: Part, data: DataSet, made_with: Mapping[str, str]) -> str:
    """Digest of all that a part's numbers depend on."""
    amount: dict[Experiment, dict[str, float]] = {
        "starts": {"starts": plan.starts},
        "moves": {"moves": plan.moves, "farthest_m": plan.farthest_m},
        "left_out": {},
    }
    content = {
        "part": part.name,
        "seed": plan.seed,
        "amount": amount[part.experiment],
        "data": data.digest,
        "versions": dict(made_with),
        "columns": [each.name for each in fields(Row)],
    }
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:32]


def random_numbers(plan: Plan, part: Part) -> np.random.Generator:
    """Random numbers of a part, from the study's seed and the part's name.

    Methods and kinds of slices share them, so that all run from the same starts and to the same goals.
    """
    shared = f"{part.experiment}/{part.data_set}/{part.alignment}"
    words = np.frombuffer(sha256(shared.encode()).digest(), dtype="<u4")
    return np.random.default_rng(np.random.SeedSequence([plan.seed, *words.tolist()]))


@lru_cache(maxsize=1)
def versions() -> Mapping[str, str]:
    """Versions of `PACKAGES`; one that is missing is called so. Ours has a digest of its code behind it."""
    found = {name: _version(name) for name in PACKAGES}
    return found | {OURS: f"{found[OURS]}+{_code()}"}


def _code() -> str:
    """Digest of the code that numbers come from, which changes more often than its version."""
    home = Path(__file__).resolve().parents[2]
    content = sha256()
    for path in sorted(path for pattern in CODE for path in home.glob(pattern)):
        content.update(path.name.encode() + path.read_bytes())
    return content.hexdigest()[:12]


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "missing"
