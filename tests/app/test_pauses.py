"""A process that serves: what it made at its start costs no drag anything any more."""

from __future__ import annotations

import subprocess
import sys

import pytest

ALIVE = """
import gc, numpy
from app.pauses import avoid_pauses
before = len(gc.get_objects())
avoid_pauses()
print(len(gc.get_objects()) / before)
"""
FAULTS = """
import resource, numpy
from app.pauses import avoid_pauses
def updates():
    for _ in range(20):
        [numpy.ones(40_000) for _ in range(8)]
def faults():
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt
avoid_pauses()
updates()
before = faults()
updates()
print(faults() - before)
"""


def printed(code: str) -> float:
    """What a fresh interpreter prints, since this changes the whole process."""
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    return float(run.stdout)


def test_a_full_collection_does_not_look_at_what_the_start_made() -> None:
    assert printed(ALIVE) < 0.1


@pytest.mark.skipif(sys.platform != "linux", reason="only glibc can be told to keep memory")
def test_arrays_of_an_update_use_the_memory_of_those_before() -> None:
    assert printed(FAULTS) < 100  # 5600 without
