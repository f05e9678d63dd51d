"""`geomdrap check`, `sample` and `diff` on real files."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

Run = Callable[..., Result]
ErrorOf = Callable[..., str]

TRIANGLES = "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\n"
FIN = TRIANGLES + "v 50 50 80\nf 1 2 3\nf 1 3 4\nf 1 3 5\n"


def test_samples_are_listed_with_what_they_are(run: Run) -> None:
    lines = run("sample", "--list").stdout.splitlines()
    assert {"hemisphere", "double-dome", "hood", "bracket"} <= {line.split()[0] for line in lines}
    table = json.loads(run("sample", "--list", "--json").stdout)
    assert [row["name"] for row in table["samples"]] == [line.split()[0] for line in lines]
    assert all(len(row["description"]) > 20 for row in table["samples"])


def test_a_sample_is_written_where_asked_and_is_fit(run: Run) -> None:
    result = run("sample", "hemisphere", "-o", "parts", "--facets", "1000")
    assert result.stdout == f"wrote {Path('parts/hemisphere.stl')}\n"
    checked = run("check", "parts/hemisphere.stl", "--json")
    assert checked.exit_code == 0
    report = json.loads(checked.stdout)
    assert report["drapable"] is True
    assert report["faces"] == pytest.approx(1000, rel=0.05)


def test_a_sample_says_its_files_as_json(run: Run) -> None:
    document = json.loads(run("sample", "cone", "--json").stdout)
    assert document["files"] == ["cone.stl"]
    assert Path("cone.stl").exists()


def test_an_unknown_sample_names_those_there_are_and_leaves_no_folder(error_of: ErrorOf) -> None:
    assert "the samples are hemisphere" in error_of("sample", "spoon", "-o", "parts")
    assert not Path("parts").exists()


def test_check_says_what_stands_in_the_way_and_where(run: Run) -> None:
    Path("fin.obj").write_text(FIN)
    result = run("check", "fin.obj")
    assert result.exit_code == 2
    assert "not fit to be draped" in result.stdout
    assert "(50, 50, 0)" in result.stdout
    assert json.loads(run("check", "fin.obj", "--json").stdout)["drapable"] is False


def test_check_reads_the_unit(run: Run) -> None:
    Path("square.obj").write_text(TRIANGLES + "f 1 2 3\nf 1 3 4\n")
    assert json.loads(run("check", "square.obj", "--unit", "cm", "--json").stdout)["area"] == pytest.approx(
        1e6
    )


def test_check_of_a_missing_file_is_one_line(error_of: ErrorOf) -> None:
    assert "missing.stl" in error_of("check", "missing.stl")


def _report(folder: str, pitch: float) -> None:
    Path(folder).mkdir()
    Path(folder, "drape.json").write_text(json.dumps({"pitch": pitch, "files": {}}))


def test_diff_of_equal_results_says_so_with_exit_code_0(run: Run) -> None:
    _report("old", 5.0)
    shutil.copytree("old", "new")
    result = run("diff", "old", "new")
    assert (result.exit_code, result.stdout) == (0, "no change in drape.json\n")


def test_diff_says_where_and_by_how_much_with_exit_code_1(run: Run) -> None:
    _report("old", 5.0)
    _report("new", 5.5)
    result = run("diff", "old", "new")
    assert (result.exit_code, result.stdout) == (1, "drape.json: pitch: 5.0 -> 5.5 by 0.5 mm\n")
    document = json.loads(run("diff", "old", "new", "--json").stdout)
    assert document["changes"][0]["amount"] == 0.5
    assert run("diff", "old", "new", "--tol-mm", "0.6").exit_code == 0


def test_diff_of_what_is_no_result_is_one_line(error_of: ErrorOf) -> None:
    _report("old", 5.0)
    Path("empty").mkdir()
    assert "does not exist" in error_of("diff", "old", "missing")
    assert "holds no result" in error_of("diff", "empty", "old")


def test_diff_finds_the_files_of_an_empty_folder_missing(run: Run) -> None:
    _report("old", 5.0)
    Path("empty").mkdir()
    assert run("diff", "old", "empty").exit_code == 1


def test_json_of_diff_is_all_of_stdout_also_where_there_are_notes(run: Run) -> None:
    _report("old", 5.0)
    shutil.copytree("old", "new")
    Path("new/nodes.csv").write_text("u,v,x,y,z,shear\n")
    result = run("diff", "old", "new", "--json")
    assert json.loads(result.stdout)["notes"]
    assert result.exit_code == 0
