"""``geomdrap sweep`` from the command line."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import click
import pytest
from click.testing import CliRunner, Result

from geomdrap.cli import cli

SLOW = """
import geomdrap as gd, time

class Slow(gd.Effect):
    name = "slow"
    def on_net(self, net):
        time.sleep(0.3)
        return net
"""


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Result]:
    """Run a command in a folder that holds a part, saddle.stl."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments: object) -> Result:
        words = [str(a) for a in arguments]
        return CliRunner().invoke(cli, words, prog_name="geomdrap", catch_exceptions=False)

    assert call("sample", "saddle", "--facets", 1500).exit_code == 0
    return call


def _error(result: Result) -> str:
    assert result.exit_code == 2, result.output
    return result.stderr.splitlines()[-1].removeprefix("Error: ")


def test_rows_are_ranked_in_the_json_and_the_table(run: Callable[..., Result], tmp_path: Path) -> None:
    result = run(
        "sweep",
        "saddle.stl",
        "--angles",
        "0:90:45",
        "--origins",
        "grid:1x2",
        "-j",
        1,
        "--pitch",
        12,
        "--json",
        "--objective",
        "p95-shear",
    )
    assert result.exit_code == 0
    document = json.loads(result.stdout)
    assert document["schema"] == "geomdrap.sweep/1"
    rows = document["rows"]
    assert [row["rank"] for row in rows] == [1, 2, 3, 4, 5, 6]
    assert [row["p95_shear"] for row in rows] == sorted(row["p95_shear"] for row in rows)
    assert {"origin", "angle", "max_shear", "p95_shear", "coverage", "fabric_area", "rank"} <= set(rows[0])
    table = list(csv.DictReader((tmp_path / "sweep" / "sweep.csv").open()))
    assert [float(line["p95_shear"]) for line in table] == [row["p95_shear"] for row in rows]
    assert json.loads((tmp_path / "sweep" / "sweep.json").read_text())["rows"] == rows


@pytest.mark.parametrize("command", ["sweep", "optimize"])
def test_the_report_of_the_best_shows_the_command(run: Callable[..., Result], tmp_path: Path, command: str) -> None:
    asked = ("--origins", "centroid", "--angles", "45", "--pitch", 30, "-j", 1, "--outputs", "best")
    run(command, "saddle.stl", *asked, *(("--budget", 0) if command == "optimize" else ()))
    report = (tmp_path / command / "best" / "report.html").read_text()
    assert f"geomdrap {command} saddle.stl --origins centroid --angles 45 --pitch 30" in report


@pytest.mark.parametrize("command", ["sweep", "optimize"])
def test_the_json_says_what_stderr_says_and_how_plies_were_laid(
    run: Callable[..., Result], tmp_path: Path, command: str
) -> None:
    run("sample", "hemisphere", "--facets", 400)
    asked = ("--origins", "grid:5x5", "--angles", "0", "-j", 1, "--pitch", 10, "--outputs", "json", "--json")
    laid = ("--limit-angle", 35, "--reference", "0,1,0", "--blank", "150x100")
    result = run(command, "hemisphere.stl", *asked, *laid, *(("--budget", 0) if command == "optimize" else ()))
    assert result.exit_code == 0, result.output
    for text in (result.stdout, (tmp_path / command / f"{command}.json").read_text()):
        document = json.loads(text)
        assert document["limit_angle"] == 35.0
        assert document["reference"] == [0.0, 1.0, 0.0]
        assert document["blank"] == [150.0, 100.0]
        assert document["warnings"]
        assert "points of grid:5x5 miss the part and are left out" in " ".join(document["notes"])
        said = [f"Warning: {text}" for text in document["warnings"]] + [f"Note: {text}" for text in document["notes"]]
        assert [line for line in result.stderr.splitlines() if line.startswith(("Warning", "Note"))] == said


def test_the_best_case_is_draped_and_written_as_drape_does(run: Callable[..., Result], tmp_path: Path) -> None:
    result = run(
        "sweep", "saddle.stl", "--angles", "10,45", "-j", 1, "--pitch", 12, "--json", "--objective", "max-shear"
    )
    best = json.loads(result.stdout)["rows"][0]
    run("drape", "saddle.stl", "--angle", best["angle"], "--pitch", 12, "-o", "alone")
    names = sorted(path.name for path in (tmp_path / "alone").iterdir())
    assert names == sorted(path.name for path in (tmp_path / "sweep" / "best").iterdir())
    for name in ("drape.json", "nodes.csv", "flat.dxf"):
        assert (tmp_path / "alone" / name).read_bytes() == (tmp_path / "sweep" / "best" / name).read_bytes()


def test_one_process_and_two_write_the_same_files(run: Callable[..., Result], tmp_path: Path) -> None:
    for jobs in (1, 2):
        asked = ("--angles", "0:90:30", "--pitch", 12, "--outputs", "json,csv", "-q", "-o", f"j{jobs}")
        assert run("sweep", "saddle.stl", "-j", jobs, *asked).exit_code == 0
    for name in ("sweep.json", "sweep.csv"):
        assert (tmp_path / "j1" / name).read_bytes() == (tmp_path / "j2" / name).read_bytes()


def test_resume_drapes_only_what_is_missing(run: Callable[..., Result], tmp_path: Path) -> None:
    asked = ("-j", 1, "--pitch", 12, "--outputs", "json")
    run("sweep", "saddle.stl", "--angles", "0:60:30", *asked)
    rows = (tmp_path / "sweep" / "rows.jsonl").read_text().splitlines()
    made_up = json.loads(rows[1]) | {"max_shear": 0.125}  # a row that no drape would give
    (tmp_path / "sweep" / "rows.jsonl").write_text("\n".join([rows[0], json.dumps(made_up), *rows[2:]]) + "\n")
    result = run("sweep", "saddle.stl", "--angles", "0:90:30", *asked, "--resume", "--json")
    found = json.loads(result.stdout)["rows"]
    assert len(found) == 4
    assert found[0]["max_shear"] == 0.125
    assert len((tmp_path / "sweep" / "rows.jsonl").read_text().splitlines()) == 5


def test_resume_is_refused_for_another_part_and_the_rows_stay(run: Callable[..., Result], tmp_path: Path) -> None:
    run("sweep", "saddle.stl", "--angles", "0", "-j", 1, "--outputs", "json")
    before = (tmp_path / "sweep" / "rows.jsonl").read_bytes()
    run("sample", "cylinder", "--facets", 500)
    error = _error(run("sweep", "cylinder.stl", "--angles", "0", "-j", 1, "--resume"))
    assert "rows.jsonl holds rows of another part: its mesh is not that of cylinder.stl" in error
    assert (tmp_path / "sweep" / "rows.jsonl").read_bytes() == before


def test_without_resume_the_rows_of_an_earlier_run_are_kept_and_it_is_said(
    run: Callable[..., Result], tmp_path: Path
) -> None:
    asked = ("-j", 1, "--pitch", 30, "--outputs", "json", "-q")
    assert run("sweep", "saddle.stl", "--angles", "0,10", *asked).stderr == ""
    rows, kept = (tmp_path / "sweep" / name for name in ("rows.jsonl", "rows-1.jsonl"))
    before = rows.read_bytes()
    result = run("sweep", "saddle.stl", "--angles", "20", *asked)
    name, other = Path("sweep") / "rows.jsonl", Path("sweep") / "rows-1.jsonl"
    assert f"Warning: {name} held rows of an earlier run, which are kept in {other} " in result.stderr
    assert kept.read_bytes() == before
    assert len(rows.read_text().splitlines()) == 1 + 1


@pytest.mark.parametrize("command", ["sweep", "optimize"])
@pytest.mark.parametrize(
    ("asked", "words"),
    [(("-o", "here"), "-o names a folder, but"), (("--resume",), "--resume needs the rows of a folder")],
)
def test_a_folder_or_rows_to_go_on_with_are_refused_where_nothing_is_written(
    run: Callable[..., Result], command: str, asked: tuple[str, ...], words: str
) -> None:
    assert words in _error(run(command, "saddle.stl", "--outputs", "none", *asked))


def test_failed_cases_are_rows_with_a_reason_and_are_counted(run: Callable[..., Result]) -> None:
    part = "solid a\n" + "".join(
        f"facet normal 0 0 1\nouter loop\nvertex {x} 0 {z}\nvertex {x + s} 0 {z}\nvertex {x} {s} {z}\nendloop\nendfacet\n"
        for x, s, z in ((0, 50, 0), (100, 1, 0))
    )
    Path("two.stl").write_text(part + "endsolid a\n")
    asked = ("--origins", "15,15,0", "--origins", "100.2,0.2,0", "--angles", "0", "--pitch", 9, "-j", 1)
    rows = json.loads(run("sweep", "two.stl", *asked, "--json").stdout)["rows"]
    assert [row["rank"] for row in rows] == [1, None]
    assert rows[1]["max_shear"] is None
    assert "a pitch of 9 mm is larger than two.stl" in rows[1]["reason"]
    assert "1 failed" in run("sweep", "two.stl", *asked).stdout


def test_a_sweep_of_which_every_case_fails_says_why(run: Callable[..., Result]) -> None:
    error = _error(
        run(
            "sweep",
            "saddle.stl",
            "--origins",
            "vertex:0",
            "--angles",
            "0,1",
            "--blank",
            "1x1",
            "--pitch",
            20,
            "-j",
            1,
        )
    )
    assert "none of the 2 cases could be draped; most often: no cell of 20 mm closes" in error


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (("--angles", "90:0:5"), "the range 90:0:5 is empty"),
        (("--angles", "up"), "'up' is not a finite number of degrees"),
        (("--origins", "0,0,900"), "lies 8"),
        (("--origins", "seeds.csv"), "a CSV file with columns x, y, z (No such file"),
        (("--origins", "grid:5"), "a grid is grid:NxM"),
        (("--objective", "beauty"), "there is no criterion 'beauty'; they are max-shear, p95-shear"),
        (("--pareto", "p95-shear,beauty"), "there is no criterion 'beauty'"),
        (("-j", "0"), "0 is not in the range x>=1"),
    ],
)
def test_bad_input_is_said_in_one_line_and_nothing_is_written(
    run: Callable[..., Result], tmp_path: Path, asked: tuple[str, ...], words: str
) -> None:
    assert words in _error(run("sweep", "saddle.stl", *asked))
    assert not (tmp_path / "sweep").exists()


def test_a_missing_part_is_said_before_anything_else(run: Callable[..., Result]) -> None:
    assert "gone.stl" in _error(run("sweep", "gone.stl"))


@pytest.mark.parametrize("jobs", [1, 2])
def test_ctrl_c_leaves_a_good_file_from_which_resume_goes_on(
    run: Callable[..., Result], tmp_path: Path, jobs: int
) -> None:
    (tmp_path / "slow.py").write_text(SLOW)
    asked = ["--angles", "0:90:2", "--pitch", "30", "--plugin", "slow.py", "--effect", "slow", "--outputs", "json"]
    command = [sys.executable, "-m", "geomdrap", "sweep", "saddle.stl", *asked, "-j", str(jobs)]
    process = subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    rows = tmp_path / "sweep" / "rows.jsonl"
    while not rows.exists() or len(rows.read_text().splitlines()) < 4:
        assert process.poll() is None, process.stderr
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to the workers too
    output, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert output == ""
    lines = [line for line in errors.splitlines() if line and not line.startswith("Note:")]
    there = len(rows.read_text().splitlines()) - 1
    assert 3 <= there < 46
    assert rows.read_text().endswith("\n")
    path = Path("sweep") / "rows.jsonl"
    goes_on = (
        f"Error: interrupted; {there} of 46 rows are in {path}; the same command with --resume goes on from there"
    )
    assert lines == [goes_on]
    kept = rows.read_text()
    asked[1] = "0:4:2"  # rows that are there already, and the last one maybe not
    assert run("sweep", "saddle.stl", *asked, "-j", 1, "--resume").exit_code == 0
    assert rows.read_text().startswith(kept)


@pytest.mark.parametrize("command", ["sweep", "optimize"])
@pytest.mark.parametrize("step", ["draped_best", "whole_folder"])
def test_ctrl_c_after_the_last_row_says_that_the_rows_are_there(
    run: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str, step: str
) -> None:
    from geomdrap.export import sweep_outputs
    from geomdrap.sweep import Sweep

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Sweep if step == "draped_best" else sweep_outputs, step, interrupt)
    asked = ("--origins", "centroid", "--angles", "0,45", "--pitch", 30, "-j", 1, "--outputs", "json")
    result = run(command, "saddle.stl", *asked, *(("--budget", 0) if command == "optimize" else ()))
    assert result.exit_code == 130
    rows = Path(command) / "rows.jsonl"
    assert len((tmp_path / rows).read_text().splitlines()) == 1 + 2
    assert result.stderr.splitlines()[-1] == (
        f"Error: interrupted; all 2 rows are in {rows}, but not all other files are written; the same command with "
        "--resume goes on from there"
    )


def test_the_outputs_offered_are_those_that_can_be_written() -> None:
    from geomdrap.cli.sweeping import SWEEP_OUTPUTS as OFFERED
    from geomdrap.export.sweep_outputs import OPTIMIZE_OUTPUTS, SWEEP_OUTPUTS

    assert tuple(SWEEP_OUTPUTS) == tuple(OPTIMIZE_OUTPUTS) == OFFERED


def test_the_defaults_of_the_commands_are_those_of_the_library() -> None:
    from geomdrap.sweep import objective
    from geomdrap.sweep.optimize import BUDGET

    def default(command: str, name: str) -> object:
        context = click.Context(cli, info_name="geomdrap")
        return next(p.default for p in cli.get_command(context, command).params if p.name == name)

    for command in ("sweep", "optimize"):
        assert default(command, "objective") == objective.DEFAULT
    assert objective.parse_criteria(default("sweep", "pareto")) == objective.PARETO
    assert default("optimize", "budget") == BUDGET


def test_without_outputs_nothing_is_written(run: Callable[..., Result], tmp_path: Path) -> None:
    assert run("sweep", "saddle.stl", "--angles", "0", "-j", 1, "--outputs", "none").exit_code == 0
    assert [path.name for path in tmp_path.iterdir()] == ["saddle.stl"]
