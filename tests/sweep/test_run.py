"""Rows: each case once, the same bits wherever they are made, whatever happens to workers."""

from __future__ import annotations

import multiprocessing
import os
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import pytest
from deadly import ANGLE, Deadly, Interrupted, Wrong
from made_parts import bumpy_sheet

import geomdrap as gd
from geomdrap.sweep import Case, Job, Row, cases_of, run
from geomdrap.sweep.pool import LocalPool
from geomdrap.sweep.run import DIED

CASES = cases_of(["centroid", (10.0, -20.0, 0.0)], [0.0, ANGLE, 60.0])


def _job(*effects: gd.Effect) -> Job:
    return Job(bumpy_sheet(), pitch=8.0, effects=effects)


def _keys(rows: list[Row]) -> list[tuple[object, float]]:
    return sorted(((row.asked, row.angle) for row in rows), key=str)


def test_rows_are_the_same_bits_in_this_process_in_threads_and_in_two_processes() -> None:
    job, seen = _job(), []
    here = run(job, CASES)
    with ThreadPoolExecutor(2) as executor:
        threads = run(job, CASES, executor=executor)
    processes = run(job, CASES, jobs=2, on_row=seen.append)
    assert here.rows == threads.rows == processes.rows
    assert [(row.asked, row.angle) for row in here.rows] == [(c.origin, c.angle) for c in CASES]
    assert _keys(seen) == _keys(list(here.rows))


def test_a_row_is_what_drape_and_evaluate_give() -> None:
    job = _job(gd.effects.make("slip", coefficient=0.5))
    row = run(job, [Case("centroid", 30.0)]).rows[0]
    full = gd.evaluate(gd.drape(job.surface, angle=30.0, pitch=8.0, effects=job.effects))
    assert (row.max_shear, row.p95_shear) == (full.statistics.max, full.statistics.p95)
    assert (row.coverage, row.fabric_area) == (full.area.coverage, full.area.fabric)
    assert row.origin == tuple(full.net.origin)
    assert row.blank_area == row.blank_length * row.blank_width > row.fabric_area
    assert row.waste == 1.0 - row.fabric_area / row.blank_area


def test_a_case_that_cannot_be_draped_is_a_row_with_the_reason() -> None:
    surface = gd.Surface(
        [[0, 0, 0], [50, 0, 0], [0, 50, 0], [0, 0, 90], [1, 0, 90], [0, 1, 90]], [[0, 1, 2], [3, 4, 5]]
    )
    rows = run(Job(surface, pitch=9.0), [Case((15.0, 15.0, 0.0), 0.0), Case((0.2, 0.2, 90.0), 0.0)]).rows
    assert rows[0].reason is None
    assert rows[1].reason is not None
    assert "smaller" in rows[1].reason


def test_a_bug_in_one_case_is_a_row_that_says_so_and_others_go_on() -> None:
    rows = run(_job(Wrong()), CASES).rows
    bad = [row for row in rows if row.reason is not None]
    assert {row.angle for row in bad} == {ANGLE}
    assert all("this is a bug in geomdrap (ZeroDivisionError: one by nought)" in (row.reason or "") for row in bad)


def test_an_interrupt_within_a_kernel_ends_the_run_and_is_no_row() -> None:
    seen: list[Row] = []
    with pytest.raises(KeyboardInterrupt):
        run(_job(Interrupted()), CASES, on_row=seen.append)
    assert [row.angle for row in seen] == [0.0]


def test_where_a_worker_dies_once_no_row_is_lost_and_none_comes_twice(tmp_path: Path) -> None:
    seen: list[Row] = []
    job = _job(Deadly(os.getpid(), tmp_path / "died"))
    rows = run(job, CASES, jobs=2, on_row=seen.append).rows
    assert (tmp_path / "died").exists()
    assert _keys(seen) == _keys(list(rows))
    assert all(row.reason is None for row in rows)
    assert rows == run(_job(), CASES).rows


def test_a_case_that_kills_every_worker_fails_and_no_other_does() -> None:
    rows = run(_job(Deadly(os.getpid())), CASES, jobs=2).rows
    assert {row.angle: row.reason for row in rows} == {0.0: None, ANGLE: DIED, 60.0: None}


def test_an_effect_that_no_process_can_be_sent_is_refused_with_the_way_out() -> None:
    class Local(gd.Effect):
        pass

    with pytest.raises(gd.SweepError, match="use -j 1"):
        LocalPool(_job(Local()), 2)


def test_all_workers_of_a_pool_start_at_once() -> None:
    before = set(multiprocessing.active_children())
    with closing(LocalPool(_job(), 3)):
        assert len(set(multiprocessing.active_children()) - before) == 3


def test_cases_that_are_done_are_not_draped_again() -> None:
    job, seen = _job(), []
    first = run(job, CASES[:4])
    second = run(job, CASES, done=first.rows, on_row=seen.append)
    assert _keys(seen) == _keys(list(run(job, CASES[4:]).rows))
    assert second.rows == run(job, CASES).rows


def test_a_sweep_without_cases_is_refused() -> None:
    with pytest.raises(gd.SweepError, match="at least one origin and one angle"):
        run(_job(), [])
