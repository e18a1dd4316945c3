"""A study from its spec to its tables: what is finished is taken, the rest is worked out and kept."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Final

from app.study.errors import FolderError, StoppedError
from app.study.executors import Executor, in_this_process, tool
from app.study.experiments import Done, Job
from app.study.keeping import Shelf
from app.study.parts import Part, key_of, parts_of, versions
from app.study.sources import DataSet, open_data
from app.study.spec import Spec
from app.study.table import write_tables

TOOLS: Final = ("jinja2", "matplotlib", "pyarrow", "tqdm", "threadpoolctl")
"""Needed by every study, and asked for before it begins."""


@dataclass(frozen=True)
class Outcome:
    """A finished study."""

    spec: Spec
    data: tuple[DataSet, ...]
    found: tuple[tuple[Part, Done], ...]
    """Sorted by part."""
    skipped: int
    """Parts that were finished before."""
    seconds: float

    @property
    def rows(self) -> int:
        """Runs in the table."""
        return sum(len(done.rows) for _, done in self.found)

    @property
    def failed(self) -> int:
        """Runs that there are not, with a reason in the table."""
        return sum(row.failed is not None for _, done in self.found for row in done.rows)


def run_study(spec: Spec, out: Path, executor: AbstractContextManager[Executor]) -> Outcome:
    """Run a study, and write its tables.

    Parameters
    ----------
    spec : Spec
    out : Path
        Folder for ``parts/``, ``results.*`` and ``timings.*``.
    executor : context manager
        Where parts are worked out, see `app.study.executors`; opened only if anything is to be done.

    Returns
    -------
    Outcome
        Results that depend neither on the executor nor on interruptions.

    Raises
    ------
    StudyError
        If the spec names what there is not, results cannot be kept, a worker is lost, or somebody stops it.
    """
    began = perf_counter()
    for name in TOOLS:
        tool(name)
    data = open_data(spec)
    by_name = {each.name: each for each in data}
    parts = parts_of(spec, data)
    made_with = dict(versions())
    keys = {part: key_of(spec.plan, part, by_name[part.data_set], made_with) for part in parts}
    shelf = Shelf(out / "parts")
    found = {part: done for part in parts if (done := shelf.get(keys[part])) is not None}
    skipped = len(found)
    jobs = [Job(spec.plan, part, made_with) for part in parts if part not in found]
    try:
        for part, done in _finished(jobs, by_name, executor, skipped):
            shelf.put(keys[part], part, done)
            found[part] = done
    except KeyboardInterrupt as error:
        raise StoppedError(len(found), len(parts)) from error
    ordered = tuple((part, found[part]) for part in parts)
    try:
        write_tables(out, ordered)
    except OSError as error:
        raise FolderError(str(out), error.strerror or str(error)) from error
    return Outcome(spec, data, ordered, skipped, perf_counter() - began)


def _finished(
    jobs: Sequence[Job], data: dict[str, DataSet], executor: AbstractContextManager[Executor], before: int
) -> Iterator[tuple[Part, Done]]:
    """Give parts as they are finished, with a bar on stderr that counts them."""
    # Into a file, a line now and then; on a screen, a bar that moves.
    every = 0.2 if sys.stderr.isatty() else 10.0
    bar = partial(
        tool("tqdm").tqdm,
        mininterval=every,
        total=before + len(jobs),
        initial=before,
        unit="part",
        desc="study",
        smoothing=0.05,
    )
    # A cluster that does not answer is said before there is a bar.
    with executor if jobs else nullcontext(in_this_process) as work_out, bar() as shown:
        for job, done in work_out(jobs, data):
            yield job.part, done
            shown.update()
