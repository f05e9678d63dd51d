"""Where cases run: in this process, in processes of this machine, or through any executor."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import sys
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from geomdrap.errors import SweepError
from geomdrap.sweep.case import Case, Job
from geomdrap.sweep.row import Row

if TYPE_CHECKING:
    from multiprocessing.synchronize import Event

AHEAD = 2  # cases a worker has before it, so that none waits
PATIENCE = 60.0  # s that a worker waits for the others to be asked for: its parent may have died
ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")  # processes share the cores already


class Pool(Protocol):
    """What a sweep needs of the place where it runs.

    ``room``: how many cases to hand over at a time; ``lost``: what a case raises whose worker has died.
    """

    @property
    def room(self) -> int:
        """How many cases to hand over at a time."""

    @property
    def lost(self) -> tuple[type[BaseException], ...]:
        """What a case raises whose worker has died."""

    def submit(self, case: Case) -> Future[Row]:
        """Hand over a case."""

    def restart(self) -> None:
        """Make the place fit for use again after a worker has died."""

    def close(self) -> None:
        """Drop what has not begun, and let the workers go."""


class ThroughExecutor:
    """Any ``concurrent.futures.Executor``, which stays open; without one, this process, a case at a time."""

    lost: tuple[type[BaseException], ...] = ()

    def __init__(self, job: Job, executor: Executor | None = None, room: int = 1):
        self.job, self.executor, self.room = job, executor, room

    def submit(self, case: Case) -> Future[Row]:
        """Hand over a case, and the job with it; without an executor it is done at once."""
        if self.executor is not None:
            return self.executor.submit(self.job.row, case)
        future: Future[Row] = Future()
        future.set_result(self.job.row(case))
        return future

    def restart(self) -> None:
        """Nothing to do: an executor looks after itself."""

    def close(self) -> None:
        """Nothing to do: the executor is the caller's."""


class LocalPool:
    """Worker processes that get the job once, when they start.

    They are forked off a clean server where there is one, as threads of this process (of libraries, of progress)
    would not survive a fork of itself. The first case is draped here, while the workers start: the kernels are then
    compiled by one process. Raises SweepError for effects that cannot be sent to another process.
    """

    lost: tuple[type[BaseException], ...] = (BrokenExecutor,)

    def __init__(self, job: Job, workers: int):
        self.job, self.workers, self.room = job, workers, AHEAD * workers
        self.first = True
        try:
            self.blob = pickle.dumps(job)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            raise SweepError(f"these effects cannot be sent to other processes ({error}); use -j 1") from error
        self.executor = self._start()

    def _start(self) -> ProcessPoolExecutor:
        methods = multiprocessing.get_all_start_methods()
        context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
        if "forkserver" in methods:
            context.set_forkserver_preload([__name__])
        with _environment_of_workers():
            gate = context.Event()
            begin = (plugin_files(self.job), self.blob, gate)
            executor = ProcessPoolExecutor(self.workers, context, _begin, begin)
            for _ in range(self.workers):  # each starts a worker, as none of them is idle before the gate opens
                executor.submit(_ready)
            gate.set()
        return executor

    def submit(self, case: Case) -> Future[Row]:
        """Hand over a case; the first is done at once."""
        if self.first:
            self.first = False
            return ThroughExecutor(self.job).submit(case)
        try:
            return self.executor.submit(_row, case)
        except BrokenExecutor as error:
            future: Future[Row] = Future()
            future.set_exception(error)
            return future

    def restart(self) -> None:
        """Start new workers."""
        self.executor.shutdown(wait=False, cancel_futures=True)
        self.executor = self._start()

    def close(self) -> None:
        """Drop what has not begun; what has is waited for, as it takes no time to speak of."""
        self.executor.shutdown(wait=True, cancel_futures=True)


@contextmanager
def _environment_of_workers() -> Iterator[None]:
    """One thread each, and this very package: the server does not know where this process found it."""
    before = {name: os.environ.get(name) for name in (*ONE_THREAD, "PYTHONPATH")}
    os.environ.update({name: "1" for name in ONE_THREAD if before[name] is None})
    here = str(Path(__file__).resolve().parents[2])
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, (here, before["PYTHONPATH"])))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def plugin_modules(job: Job) -> tuple[str, ...]:
    """The modules of the user's own effects, which a worker must have before it can be sent one."""
    modules = {type(effect).__module__ for effect in job.effects}
    return tuple(sorted(name for name in modules if name.startswith("geomdrap_plugin_")))


def plugin_files(job: Job) -> tuple[str, ...]:
    """The files of these modules."""
    return tuple(str(sys.modules[name].__file__) for name in plugin_modules(job))


_JOB: list[Job] = []  # of a worker process: the one job that it has


def _begin(plugins: tuple[str, ...], blob: bytes, gate: Event) -> None:
    """Make a worker ready once the ``gate`` is open; Ctrl-C is for the parent alone, which lets its workers go."""
    from geomdrap.effects import available, load_plugin

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    gate.wait(PATIENCE)
    for plugin in plugins:
        load_plugin(plugin)
    _JOB[:] = [pickle.loads(blob)]
    own = ("geomdrap.", "geomdrap_plugin_")
    if not all(type(effect).__module__.startswith(own) for effect in _JOB[0].effects):
        available()  # guards those of installed packages


def _ready() -> None:
    """Show that a worker runs."""


def _row(case: Case) -> Row:
    return _JOB[0].row(case)
