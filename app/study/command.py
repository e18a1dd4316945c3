"""``gc-teach study``: methods x data sets x kinds of slices x alignments, into tables and a report."""

from __future__ import annotations

import json as json_text
import os
from pathlib import Path
from typing import Annotated

import tyro

from app.commands import Place
from app.study.executors import opened
from app.study.report import write_report
from app.study.running import Outcome, run_study
from app.study.spec import read_spec, spec_path
from gc_core import InvalidSettingError


def study(
    spec: tyro.conf.Positional[Path],
    *,
    data: Place = None,
    out: Place = None,
    scheduler: Annotated[str | None, tyro.conf.arg(metavar="ADDRESS", help_behavior_hint="")] = None,
    workers: Annotated[
        int | None, tyro.conf.arg(metavar="INT", help_behavior_hint="(default: one a core)")
    ] = None,
    json: bool = False,
) -> None:
    """Run a study of many skills and methods, and write its tables and a report.

    Finished parts are kept: started again, a study goes on where it was interrupted.

    Args:
        spec: TOML file, or the name of one that comes with gc-teach: paper, public-data.
        data: Folder of the recordings, in place of the one that the spec names.
        out: Folder for tables and report; NAME-study here unless given.
        scheduler: Address of a dask scheduler whose workers are to do it, such as tcp://127.0.0.1:8786.
        workers: Processes of this machine; 1 works in this process alone.
        json: Print one JSON value instead of words.
    """
    asked = os.cpu_count() or 1 if workers is None else workers
    if asked < 1:
        raise InvalidSettingError("The number of workers", asked, "at least 1")
    path = spec_path(spec)
    folder = Path(f"{path.stem}-study") if out is None else out
    found = run_study(read_spec(path, data), folder, opened(scheduler, asked))
    report = write_report(found, folder)
    print(_json(found, folder) if json else _words(found, report), flush=True)


def _json(found: Outcome, folder: Path) -> str:
    return json_text.dumps(
        {
            "rows": found.rows,
            "failed": found.failed,
            "parts": len(found.found),
            "skipped": found.skipped,
            "seconds": round(found.seconds, 3),
            "out": str(folder),
        }
    )


def _words(found: Outcome, report: Path) -> str:
    again = f", {found.skipped} of them finished before" if found.skipped else ""
    failed = f" {found.failed} runs failed; the report says why." if found.failed else ""
    return (
        f"{found.spec.title}: {found.rows} runs in {len(found.found)} parts{again}, in {found.seconds:.0f} s."
        f"{failed}\nTables: {report.with_name('results.csv')} and .parquet, times in timings.*; "
        f"report: {report}"
    )
