"""The file of rows: what is in it comes back to the last bit, and only for the same job."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from made_parts import bumpy_sheet

import geomdrap as gd
from geomdrap.sweep import Case, Job, Row, run
from geomdrap.sweep.record import Record, read_record, set_aside

CASES = [Case("centroid", 0.0), Case((10.0, -20.0, 0.3), 1.0 / 3.0), Case("vertex:-1", 0.0)]


def _job() -> Job:
    return Job(bumpy_sheet(), pitch=10.0)


def _written(path: Path, job: Job) -> tuple[Row, ...]:
    record = Record(path, job)
    rows = run(job, CASES, on_row=record.append).rows
    record.close()
    return rows


def test_rows_come_back_to_the_last_bit_failed_ones_too(tmp_path: Path) -> None:
    rows = _written(tmp_path / "rows.jsonl", _job())
    back = read_record(tmp_path / "rows.jsonl", _job())
    assert rows[2].reason is not None
    assert back[:2] == rows[:2]
    assert repr(back) == repr(rows)  # NaN is not equal to itself


def test_a_row_is_in_the_file_as_soon_as_it_is_appended(tmp_path: Path) -> None:
    record = Record(tmp_path / "rows.jsonl", _job())
    for number, case in enumerate(CASES, 1):
        record.append(_job().row(case))
        assert len(read_record(tmp_path / "rows.jsonl", _job())) == number


@pytest.mark.parametrize("kept", [1, 30, -1])
def test_a_last_line_that_was_cut_off_is_left_out(tmp_path: Path, kept: int) -> None:
    path = tmp_path / "rows.jsonl"
    rows = _written(path, _job())
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join([*lines[:-1], lines[-1][:kept]]))
    assert read_record(path, _job()) == rows[:2]


def test_a_file_with_nothing_in_it_yet_gives_no_rows(tmp_path: Path) -> None:
    assert read_record(tmp_path / "none.jsonl", _job()) == ()
    (tmp_path / "empty.jsonl").write_text('{"schema": "geom')
    assert read_record(tmp_path / "empty.jsonl", _job()) == ()


def test_rows_of_another_part_are_refused(tmp_path: Path) -> None:
    _written(tmp_path / "rows.jsonl", _job())
    with pytest.raises(gd.SweepError, match=r"rows\.jsonl holds rows of another part"):
        read_record(tmp_path / "rows.jsonl", replace(_job(), surface=bumpy_sheet(1)))
    with pytest.raises(gd.SweepError, match="another part"):
        read_record(tmp_path / "rows.jsonl", replace(_job(), surface=bumpy_sheet().flipped()))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"pitch": 5.0}, r"another pitch \(10.0, not 5.0\)"),
        ({"reach": (40.0, 30.0)}, r"another blank \(none given, not \[80.0, 60.0\]\)"),
        ({"limit_angle": 30.0}, "another limit angle"),
        ({"effects": (gd.effects.make("slip", coefficient=0.5),)}, "another effects"),
        ({"reference": (0.0, 1.0, 0.0)}, "another reference direction"),
    ],
)
def test_rows_with_other_settings_are_refused_and_the_setting_is_named(
    tmp_path: Path, change: dict[str, object], words: str
) -> None:
    _written(tmp_path / "rows.jsonl", _job())
    with pytest.raises(gd.SweepError, match=words):
        read_record(tmp_path / "rows.jsonl", replace(_job(), **change))  # type: ignore[arg-type]


@pytest.mark.parametrize("text", ["nonsense\n", "[]\n", '{"schema": "other/1"}\n'])
def test_a_file_that_is_something_else_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "rows.jsonl").write_text(text)
    with pytest.raises(gd.SweepError, match=r"rows\.jsonl"):
        read_record(tmp_path / "rows.jsonl", _job())


@pytest.mark.parametrize("text", ["{}", "1", "x", '{"asked": 3}'])
def test_a_damaged_line_in_the_middle_is_named(tmp_path: Path, text: str) -> None:
    path = tmp_path / "rows.jsonl"
    _written(path, _job())
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join([*lines[:2], text + "\n", *lines[2:]]))
    with pytest.raises(gd.SweepError, match="line 3: not a row of a sweep"):
        read_record(path, _job())


def test_rows_are_set_aside_under_the_first_free_name_and_none_is_lost(tmp_path: Path) -> None:
    path = tmp_path / "rows.jsonl"
    assert set_aside(path) is None
    for number in (1, 2):
        rows = _written(path, _job())
        assert set_aside(path) == tmp_path / f"rows-{number}.jsonl"
        assert not path.exists()
        assert repr(read_record(tmp_path / f"rows-{number}.jsonl", _job())) == repr(rows)


def test_a_file_without_a_row_is_not_worth_keeping_but_one_of_somebody_else_is(tmp_path: Path) -> None:
    path = tmp_path / "rows.jsonl"
    Record(path, _job()).close()
    assert set_aside(path) is None
    path.write_text("mine\n")
    assert set_aside(path) == tmp_path / "rows-1.jsonl"
