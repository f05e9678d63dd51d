"""``run``: cases in, rows out as they come, each exactly once whatever happens to workers."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import closing
from dataclasses import dataclass
from typing import TYPE_CHECKING

from geomdrap.errors import SweepError
from geomdrap.sweep.case import Case, Job
from geomdrap.sweep.objective import DEFAULT, PARETO, Objective, parse_criteria
from geomdrap.sweep.pool import LocalPool, Pool, ThroughExecutor
from geomdrap.sweep.ranking import pareto_front, ranked
from geomdrap.sweep.row import Row, failed

if TYPE_CHECKING:
    from geomdrap.fields import Drape

DIED = "the process that drapes this case died, twice: maybe of too little memory, of which a larger pitch needs less"
MOST_CASES = 10_000_000


@dataclass(frozen=True, eq=False)
class Sweep:
    """Rows of a sweep in the order of its cases, ranked by ``objective``, with the front over ``criteria``."""

    job: Job
    rows: tuple[Row, ...]
    objective: Objective
    criteria: tuple[str, ...] = PARETO

    @property
    def ranked(self) -> tuple[Row, ...]:
        """The rows, the best first, those that failed at the end."""
        return ranked(self.rows, self.objective)

    @property
    def front(self) -> tuple[Row, ...]:
        """The rows that no other one beats in one of the ``criteria`` and equals in all others."""
        return pareto_front(self.rows, self.criteria)

    @property
    def best(self) -> Row:
        """The best row. Raises SweepError where all failed."""
        return require_best(self.ranked)

    def draped_best(self) -> Drape:
        """Everything about the drape of the best row. Raises SweepError where all failed."""
        return self.job.evaluate(Case(*self.best.key))


def run(
    job: Job,
    cases: Sequence[Case],
    objective: str = DEFAULT,
    *,
    criteria: Sequence[str] = PARETO,
    jobs: int = 1,
    executor: Executor | None = None,
    pool: Pool | None = None,
    done: Iterable[Row] = (),
    on_row: Callable[[Row], None] = lambda row: None,
) -> Sweep:
    """Drape all cases of a job and rank them.

    ``jobs`` processes of this machine, or through any ``executor``, or on a ``pool``, which is closed at the end.
    A script with ``jobs`` above 1 calls this under ``if __name__ == "__main__":``, as its processes import it.
    ``done`` are rows of an earlier run: their cases are not draped again. ``on_row`` gets each new row as it comes.
    Raises SweepError where there is no case, or an objective or criterion is unknown.
    """
    wanted, names = Objective.parse(objective), parse_criteria(",".join(criteria))
    cases = list(dict.fromkeys(cases))
    if not cases:
        raise SweepError("there is no case: give at least one origin and one angle")
    found = {row.key: row for row in done}
    left = [case for case in cases if (case.origin, case.angle) not in found]
    with closing(pool or _pool(job, min(jobs, len(left)), executor)) as place:
        for row in rows_of(place, left):
            on_row(row)
            found[row.key] = row
    return Sweep(job, tuple(found[case.origin, case.angle] for case in cases), wanted, names)


def cases_of(origins: Sequence[str | tuple[float, float, float]], angles: Sequence[float]) -> list[Case]:
    """Every origin with every angle. Raises SweepError where these are too many to be meant."""
    if len(origins) * len(angles) > MOST_CASES:
        raise SweepError(f"{len(origins)} origins with {len(angles)} angles are too many cases; use fewer")
    return [Case(origin, angle) for origin in origins for angle in angles]


def _pool(job: Job, jobs: int, executor: Executor | None) -> Pool:
    if executor is None and jobs > 1:
        return LocalPool(job, jobs)
    return ThroughExecutor(job, executor, 1 if executor is None else 64)


def rows_of(pool: Pool, cases: Sequence[Case]) -> Iterator[Row]:
    """Rows of cases as they come; a case whose worker died is tried again alone, and fails if it dies again."""
    waiting, running = deque(cases), dict[Future[Row], Case]()
    while waiting or running:
        while waiting and len(running) < pool.room:
            case = waiting.popleft()
            running[pool.submit(case)] = case
        ready = wait(running, return_when=FIRST_COMPLETED).done
        suspects = yield from _take(pool, running, ready)
        if suspects:
            suspects += yield from _take(pool, running, wait(running).done)
            pool.restart()
            yield from (_alone(pool, case) for case in suspects)


def _take(pool: Pool, running: dict[Future[Row], Case], ready: set[Future[Row]]) -> Generator[Row, None, list[Case]]:
    """Rows of the futures that are ready, which leave ``running``; returns the cases whose worker died."""
    suspects = []
    for future in [future for future in running if future in ready]:
        case = running.pop(future)
        if future.cancelled():
            raise SweepError(
                "the place where the cases run dropped them: its scheduler is gone; begin again with --resume"
            )
        if isinstance(future.exception(), pool.lost):
            suspects.append(case)
        else:
            yield future.result()
    return suspects


def _alone(pool: Pool, case: Case) -> Row:
    """A case with nothing beside it, so that if its worker dies it was the one."""
    try:
        return pool.submit(case).result()
    except pool.lost:
        pool.restart()
        return failed(case.origin, case.angle, DIED)


def require_best(rows: Sequence[Row]) -> Row:
    """The first of ranked rows. Raises SweepError, with the commonest reason, where all failed."""
    if rows[0].reason is None:
        return rows[0]
    reasons = [row.reason or "" for row in rows]
    commonest = max(set(reasons), key=reasons.count)
    raise SweepError(f"none of the {len(rows)} cases could be draped; most often: {commonest}")
