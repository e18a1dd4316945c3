"""Where the parts of a study are worked out: in this process, in several, or on a dask cluster.

All three are one thing: open an executor, give it parts, and take them as they are finished.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, contextmanager, nullcontext
from importlib import import_module
from threading import Thread
from typing import Any, Final, TypeAlias

from app.study.errors import ClusterError, MissingToolError, WorkerLostError
from app.study.experiments import Done, Job, work
from app.study.sources import DataSet

Executor: TypeAlias = Callable[[Iterable[Job], Mapping[str, DataSet]], Iterator[tuple[Job, Done]]]
"""Works out jobs on data sets by name; gives each with what it found, in any order."""

PATIENCE: Final = 20.0
"""A scheduler or a first worker that has not answered by then is not there [s]."""


def opened(scheduler: str | None, workers: int) -> AbstractContextManager[Executor]:
    """Open what a person asked for: a cluster, else one process or several."""
    if scheduler is not None:
        return cluster(scheduler)
    return processes(workers) if workers > 1 else nullcontext(in_this_process)


def in_this_process(jobs: Iterable[Job], data: Mapping[str, DataSet]) -> Iterator[tuple[Job, Done]]:
    """Work out one job after the other."""
    for job in jobs:
        yield job, calmly(job, data[job.part.data_set])


@contextmanager
def processes(count: int) -> Generator[Executor]:
    """Start `count` processes of this machine; they end with it, and with this process."""
    # Spawned: a forked copy of a process with threads may hang.
    pool = ProcessPoolExecutor(count, multiprocessing.get_context("spawn"), initializer=end_with_parent)

    def run(jobs: Iterable[Job], data: Mapping[str, DataSet]) -> Iterator[tuple[Job, Done]]:
        asked: dict[Future[Done], Job] = {
            pool.submit(calmly, job, data[job.part.data_set]): job for job in jobs
        }
        try:
            for future in as_completed(asked):
                yield asked.pop(future), future.result()
        except BrokenProcessPool as error:
            raise WorkerLostError("its process ended") from error

    try:
        yield run
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


@contextmanager
def cluster(address: str) -> Generator[Executor]:
    """Use a dask cluster that runs already.

    Raises
    ------
    MissingToolError
        If `distributed` is not installed.
    ClusterError
        If there is no scheduler at the address, or it has no workers.
    """
    dask = tool("distributed")
    try:
        client = dask.Client(address, timeout=PATIENCE)
    except (OSError, ValueError) as error:
        raise ClusterError(address, str(error) or "it does not answer") from error
    with client:
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError as error:
            raise ClusterError(address, "it has no workers") from error

        def run(jobs: Iterable[Job], data: Mapping[str, DataSet]) -> Iterator[tuple[Job, Done]]:
            # Data are a task's result, not scattered: the scheduler makes them again when a worker is lost.
            sent = {name: client.submit(as_it_is, each, pure=False) for name, each in data.items()}
            asked = {client.submit(calmly, job, sent[job.part.data_set], pure=False): job for job in jobs}
            lost = (dask.KilledWorker, dask.CancelledError)
            try:
                for future, done in dask.as_completed(asked, with_results=True):
                    yield asked[future], done
            except lost as error:
                raise WorkerLostError(str(error) or "the cluster gave the work up") from error
            except ImportError as error:
                raise ClusterError(address, f"its workers lack a package ({error})") from error

        yield run


def calmly(job: Job, data: DataSet) -> Done:
    """Work out one job with linear algebra on one thread, as every executor does.

    The limit stays: several threads of one dask worker would take it from each other.
    """
    tool("threadpoolctl").threadpool_limits(1)
    return work(job, data)


def as_it_is(data: DataSet) -> DataSet:
    """Put data where they are needed."""
    return data


def end_with_parent() -> None:
    """Let a worker process end when the one that started it is killed; Ctrl+C is for that one alone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        Thread(target=_end_after, args=(parent.join,), daemon=True).start()


def _end_after(wait: Callable[[], None]) -> None:
    wait()
    os._exit(1)


def tool(name: str) -> Any:
    """Import a package that only studies need.

    Raises
    ------
    MissingToolError
        If it is not installed.
    """
    try:
        return import_module(name)
    except ImportError as error:
        raise MissingToolError(name.partition(".")[0]) from error
