"""Cases on the workers of a dask.distributed scheduler."""

from __future__ import annotations

import asyncio
import sys
import threading
import warnings
from concurrent.futures import Executor, Future
from typing import Any
from weakref import WeakSet

from geomdrap.errors import SweepError
from geomdrap.surface import Surface
from geomdrap.sweep.case import Case, Job
from geomdrap.sweep.pool import plugin_modules
from geomdrap.sweep.row import Row

CONNECT, WORKERS = 4.0, 2.0  # s for the scheduler to answer, and for a worker to be there
LEAST_ROOM, AHEAD = 64, 4  # cases handed over at a time: workers may join


class ClusterPool:
    """A dask.distributed scheduler: a case whose worker dies is draped again by another one.

    The job travels as the result of a task: workers hand it on to each other, and where those that have it die it is
    made again. Raises SweepError where dask is not installed, and where no scheduler or no worker answers within ten
    seconds.
    """

    def __init__(self, job: Job, address: str):
        try:
            import cloudpickle
            from distributed import KilledWorker
        except ImportError as error:
            raise SweepError("--scheduler needs dask.distributed: pip install 'geomdrap[dask]'") from error
        self.lost: tuple[type[BaseException], ...] = (KilledWorker,)
        self.client = _connect(address)
        for module in plugin_modules(job):  # no worker could import them
            cloudpickle.register_pickle_by_value(sys.modules[module])
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Sending large graph")  # once, and that is what it is for
            self.job = self.client.submit(cloudpickle.loads, cloudpickle.dumps(job), pure=False)
        self.executor: Executor = self.client.get_executor(pure=False)

    @property
    def room(self) -> int:
        """How many cases to hand over at a time."""
        return max(LEAST_ROOM, AHEAD * sum(self.client.nthreads().values()))

    def submit(self, case: Case) -> Future[Row]:
        """Hand over a case."""
        return self.executor.submit(row_on_worker, self.job, case)

    def restart(self) -> None:
        """Nothing to do: the scheduler hands cases to other workers."""

    def close(self) -> None:
        """Drop what is not done, and leave the scheduler to others."""
        self.executor.shutdown(wait=False)
        self.client.close(timeout=2)


def _connect(address: str) -> Any:
    """A client of the scheduler, which has a worker. Raises SweepError where one of the two does not answer."""
    from distributed import Client

    try:
        asyncio.run(asyncio.wait_for(_identity(address), CONNECT))  # the client's own waits for a deaf one for ever
        client = Client(address, timeout=0.75 * CONNECT, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise SweepError(
            f"no dask scheduler answers at {address!r} within {CONNECT:.0f} s: check the address "
            f"(as in tcp://10.0.0.5:8786), and that one runs there ({_first_line(error)})"
        ) from error
    try:
        client.wait_for_workers(1, timeout=WORKERS)
    except TimeoutError as error:
        client.close(timeout=1)
        raise SweepError(
            f"the dask scheduler at {address} has no workers; start one: dask worker {address}"
        ) from error
    return client


def _first_line(error: BaseException) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]


async def _identity(address: str) -> Any:
    """What a scheduler says of itself."""
    from distributed.core import rpc

    async with rpc(address) as scheduler:
        return await scheduler.identity()


_LOCK = threading.Lock()
_WARM: WeakSet[Surface] = WeakSet()


def row_on_worker(job: Job, case: Case) -> Row:
    """The row of a case; what all cases share is made by one thread of a worker, while the others wait for it."""
    if job.surface not in _WARM:
        with _LOCK:
            if job.surface not in _WARM:
                row = job.row(case)
                if row.reason is None:
                    _WARM.add(job.surface)
                return row
    return job.row(case)
