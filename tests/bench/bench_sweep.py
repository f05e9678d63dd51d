"""What a case of a sweep costs: ``python tests/bench/bench_sweep.py [--small] [--workers]``.

The hood with 55,000 facets, 19 headings from 25 origins, pitch 1/100 of its diagonal. CPU time of one core, warm. The
aims: 20 cases a second on one core; with ``--workers``, two processes 1.8 times as fast as one (wall-clock time, which
needs two cores with nothing else to do). Beside it what a full ``gd.evaluate`` costs, measured in the same run.
"""

from __future__ import annotations

import sys
import time

import geomdrap as gd
from geomdrap.surface import samples


def main() -> None:
    """Print the table."""
    small = "--small" in sys.argv
    part = samples.build("hood", facets=5_000 if small else 55_000)
    job = gd.sweep.Job(part, pitch=part.diagonal / (30.0 if small else 100.0))
    origins, _ = gd.sweep.locate_origins(part, ["grid:2x2" if small else "grid:5x5"])
    cases = gd.sweep.cases_of(origins, gd.sweep.parse_angles("0:90:30" if small else "0:90:5"))
    job.row(cases[0])  # compiled, and the part prepared
    start = time.process_time()
    swept = gd.sweep.run(job, cases)
    spent = time.process_time() - start
    failures = sum(row.reason is not None for row in swept.rows)
    print(f"{len(part.triangles):,} facets, pitch {job.pitch:.4g} mm, {len(cases)} cases, {failures} failed")
    print(f"one core              {len(cases) / spent:6.1f} cases/s of CPU time (aim 20)")
    full = _full(job, cases[:: max(1, len(cases) // 20)])
    print(f"drape and evaluate    {full:6.1f} cases/s of CPU time, with fields, pattern and checks")
    if "--workers" in sys.argv:
        _workers(job, cases, swept)


def _full(job: gd.sweep.Job, cases: list[gd.sweep.Case]) -> float:
    """Cases a second with the full evaluation."""
    start = time.process_time()
    for case in cases:
        job.evaluate(case)
    return len(cases) / (time.process_time() - start)


def _workers(job: gd.sweep.Job, cases: list[gd.sweep.Case], swept: gd.sweep.Sweep) -> None:
    """Wall-clock time with one process and two, start of the processes included."""
    times = []
    for jobs in (1, 2):
        start = time.perf_counter()
        again = gd.sweep.run(job, cases, jobs=jobs)
        times.append(time.perf_counter() - start)
        assert again.rows == swept.rows, "rows differ"
        print(
            f"{jobs} process{'es' if jobs > 1 else '  '}           {len(cases) / times[-1]:6.1f} cases/s, wall clock"
        )
    print(f"two against one       {times[0] / times[1]:6.2f} times as fast (aim 1.8); the rows are the same bits")


if __name__ == "__main__":
    main()
