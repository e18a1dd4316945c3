"""The project's tests, fastest first; see ARCHITECTURE.md.

One thread for the linear algebra, said here because this is read before numpy is: two cores serve everything,
and threads of the algebra only fight over them.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")
