"""Linear algebra on one thread: the matrices of a diagnosis are too small to be shared out.

A second thread of OpenBLAS waits for work in a loop between the many small calls. It takes as much processor time as
the first, and on a machine that has other things to do the first waits for it.
"""

from __future__ import annotations

from contextlib import AbstractContextManager


def one_blas_thread() -> AbstractContextManager[object]:
    """Within this context BLAS, of numpy and of scipy, uses one thread; afterwards as many as before."""
    import scipy.linalg  # noqa: F401  (brings its own BLAS, which can be limited only once it is there)
    from threadpoolctl import threadpool_limits

    limits: AbstractContextManager[object] = threadpool_limits(limits=1, user_api="blas")
    return limits
