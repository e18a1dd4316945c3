"""What makes a drag wait although nothing of it is being computed: memory and its garbage.

Arrays of a few hundred kilobytes come and go with every update. The C library hands such memory back
to the system each time, and the next update has it mapped again, page by page: 500 faults of 2 us in
an encoding. A full garbage collection goes through every object of every imported module: 55-80 ms
in the middle of some drag.
"""

import ctypes
import gc
import sys
from typing import Final

TRIM_THRESHOLD, MMAP_THRESHOLD = -1, -3
"""Numbers of glibc's malloc.h."""
KEPT: Final = 16 << 20
"""Free memory at the end of a heap that is not handed back [bytes]; a core has eight heaps at most."""
LARGE: Final = 4 << 20
"""Arrays from this size on are mapped on their own and handed back [bytes]."""


def avoid_pauses() -> None:
    """Prepare a process that serves; call it when everything is imported and made.

    What is alive then is never looked at by the collector again, and memory is kept for the next update.
    Other C libraries than glibc stay as they are.
    """
    gc.collect()
    gc.freeze()
    if sys.platform == "linux":
        library = ctypes.CDLL(None)
        if hasattr(library, "mallopt"):
            library.mallopt(TRIM_THRESHOLD, KEPT)
            library.mallopt(MMAP_THRESHOLD, LARGE)
