"""What the commands that drape many times share: options, the job that these name, and counting its rows."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import click

from geomdrap.cli.values import Direction
from geomdrap.errors import interrupt_within

if TYPE_CHECKING:
    from geomdrap.cli.progress import Progress
    from geomdrap.sweep import Job, Row
    from geomdrap.sweep.case import Case
    from geomdrap.sweep.pool import Pool
    from geomdrap.sweep.record import Record

F = TypeVar("F", bound=Callable[..., Any])

RESUME = "Go on with the rows that the folder holds already; without it they are set aside as rows-1.jsonl."

SWEEP_OUTPUTS = ("json", "csv", "png", "best")  # the keys of export.sweep_outputs.SWEEP_OUTPUTS; a test compares


def lay_options(function: F) -> F:
    """Add how a ply is laid, but for where: --reference, --project."""
    for option in (
        click.option(
            "--project",
            is_flag=True,
            help="Let origins lie further from the part than one pitch: the nearest points are taken.",
        ),
        click.option(
            "--reference",
            type=Direction(),
            metavar="x,y,z",
            help="Direction from which angles count.  [default: +x, or +y where x is along the normal]",
        ),
    ):
        function = option(function)
    return function


def objective_option(function: F) -> F:
    """Add --objective, what makes a drape good."""
    return click.option(
        "--objective",
        metavar="NAME|NAME=WEIGHT,...",
        default="max-shear",
        show_default=True,
        help="What is to be small: max-shear, p95-shear, mean-shear [°], over-limit, waste [%], fabric-area, "
        "blank-area [mm²], coverage (the bare per cent of the part), or a weighted sum.",
    )(function)


def resume_option(function: F) -> F:
    """Add --resume."""
    return click.option("--resume", is_flag=True, help=RESUME)(function)


def place_options(function: F) -> F:
    """Add where cases run: -j/--jobs, --scheduler."""
    for option in (
        click.option(
            "--scheduler",
            metavar="tcp://HOST:PORT",
            help="Drape on the workers of a dask.distributed scheduler (needs the dask extra).",
        ),
        click.option(
            "-j",
            "--jobs",
            type=click.IntRange(min=1),
            metavar="N",
            help="Processes of this machine that drape.  [default: one per core]",
        ),
    ):
        function = option(function)
    return function


class Prepared(NamedTuple):
    """A job with how it is to be ranked and where it is to run."""

    job: Job
    project: bool
    objective: str
    jobs: int
    scheduler: str | None

    def pool(self, cases: int) -> Pool:
        """The place where so many cases run; what runs them closes it."""
        from geomdrap.sweep.pool import LocalPool, ThroughExecutor

        if self.scheduler:
            from geomdrap.sweep.cluster import ClusterPool

            return ClusterPool(self.job, self.scheduler)
        jobs = min(self.jobs, cases)
        return LocalPool(self.job, jobs) if jobs > 1 else ThroughExecutor(self.job)


def prepare(
    progress: Progress,
    quiet: bool,
    *,
    part: Path,
    unit: str,
    tolerance: float | None,
    flip: bool,
    cuts: tuple[Path, ...],
    pitch: float | None,
    blank: tuple[float, float] | None,
    limit_angle: float | None,
    reference: tuple[float, float, float] | None,
    project: bool,
    effect_texts: tuple[str, ...],
    model: Path | None,
    plugins: tuple[Path, ...],
    objective: str,
    jobs: int | None,
    scheduler: str | None,
) -> Prepared:
    """Read what the options name, and refuse what of them is wrong before anything is draped."""
    from geomdrap.cli.acting import effects_of
    from geomdrap.cli.part import read_part
    from geomdrap.cli.pitch import require_room
    from geomdrap.cli.progress import announce_compilation
    from geomdrap.sweep import Job, Objective

    Objective.parse(objective)
    effects = tuple(effects_of(effect_texts, model, plugins))
    progress.step("Reading")
    surface = read_part(part, unit, tolerance, flip, cuts)
    surface.require_drapable()
    if pitch is not None:
        require_room(surface, pitch)
    announce_compilation(quiet)
    reach = (blank[0] / 2, blank[1] / 2) if blank else None
    job = Job(surface, pitch, reach, limit_angle, effects, reference)
    return Prepared(job, project, objective, jobs or cores(), scheduler)


class Running(NamedTuple):
    """A run: where its cases are draped, the rows that there are, and what takes new ones."""

    pool: Pool
    earlier: tuple[Row, ...]
    take: Counter


@contextmanager
def recorded(
    progress: Progress, ready: Prepared, cases: Sequence[Case], folder: Path | None, resume: bool, more: int = 0
) -> Iterator[Running]:
    """Rows of the cases, and of up to ``more``, go to a file as they come; Ctrl-C says what it holds."""
    from geomdrap.sweep.record import FILE, Record, read_record

    earlier = read_record(folder / FILE, ready.job) if folder and resume else ()
    known = {row.key for row in earlier}
    done = sum((case.origin, case.angle) in known for case in cases)
    pool = ready.pool(len(cases) - done + more)
    try:
        if folder and not resume:
            _set_aside(folder / FILE)
        record = Record(folder / FILE, ready.job, earlier) if folder else None
    except BaseException:
        pool.close()  # nothing will run on it
        raise
    count = Counter(progress, len(cases) + more, done, record, "at most " if more else "")
    try:
        yield Running(pool, earlier, count)
    except (KeyboardInterrupt, SystemError) as error:
        if interrupt_within(error) is None:
            raise
        raise KeyboardInterrupt(count.interrupted()) from None
    finally:
        if record:
            record.close()


def _set_aside(path: Path) -> None:
    """Keep rows that may have taken hours under another name, and say so."""
    from geomdrap.cli.messages import say
    from geomdrap.sweep.record import set_aside

    kept = set_aside(path)
    if kept is not None:
        what = "(to go on with them use --resume; remove them if nobody needs them)"
        say([f"{path} held rows of an earlier run, which are kept in {kept} {what}"], (), quiet=True)


class Counter:
    """Writes rows down as they come, counts them, and says how long the rest will take."""

    def __init__(self, progress: Progress, total: int, done: int, record: Record | None, at_most: str = ""):
        self.progress, self.total, self.done, self.record, self.at_most = progress, total, done, record, at_most
        self.before, self.start = done, time.monotonic()
        self.finished = False

    def __call__(self, row: Row) -> None:
        """Take a row."""
        if self.record:
            self.record.append(row)
        self.done += 1
        each = (time.monotonic() - self.start) / (self.done - self.before)
        left = duration(each * (self.total - self.done))
        self.progress.share(self.done / self.total, f"{self.done} of {self.total} cases, {self.at_most}{left} left")

    def finish(self) -> None:
        """All rows are there; what is left is to drape the best again and to write."""
        self.finished = True

    def interrupted(self) -> str:
        """What there is after Ctrl-C."""
        of = f"all {self.done}" if self.finished else f"{self.done} of {self.at_most}{self.total}"
        if self.record is None:
            return f"interrupted after {of} cases; nothing was written"
        there = f"{of} rows are in {self.record.path}"
        if self.finished:
            there = f"{there}, but not all other files are written"
        return f"interrupted; {there}; the same command with --resume goes on from there"


def duration(seconds: float) -> str:
    """A time to wait, as people say it."""
    if seconds < 100.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 6000.0 else f"{seconds / 3600.0:.1f} h"


def cores() -> int:
    """Cores that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity else os.cpu_count() or 1
