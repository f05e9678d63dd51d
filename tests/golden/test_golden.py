"""The same input gives the same result: as in the golden files, and byte for byte when repeated."""

from __future__ import annotations

import importlib.util
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from geomdrap.cli import cli

GOLDEN = Path(__file__).parent
FILES = ["drape.json", "flat.dxf", "flat.svg", "nodes.csv"]

_spec = importlib.util.spec_from_file_location("regenerate", GOLDEN / "regenerate.py")
golden = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(golden)


def run(*arguments):
    return CliRunner().invoke(cli, [str(a) for a in arguments], prog_name="geomdrap", catch_exceptions=False)


def diff(old, new, *more):
    result = run("diff", old, new, "--json", *more)
    return result.exit_code, json.loads(result.stdout)["changes"]


@pytest.fixture(scope="module")
def anew(tmp_path_factory):
    """The cases draped now."""
    folder = tmp_path_factory.mktemp("golden")
    for case in golden.CASES:
        result = run(*golden.command(case, folder / case))
        assert result.exit_code == 0, result.output
    return folder


@pytest.mark.parametrize("case", golden.CASES)
def test_a_drape_is_what_it_was(anew, case):
    code, changes = diff(GOLDEN / case, anew / case, "--tol-mm", "1e-6", "--tol-deg", "1e-6")
    assert changes == []
    assert code == 0


@pytest.mark.parametrize("case", golden.CASES)
def test_a_golden_folder_holds_all_files_and_no_other(case):
    assert sorted(file.name for file in (GOLDEN / case).iterdir()) == FILES


@pytest.mark.parametrize("case", golden.CASES)
def test_a_golden_result_is_a_sound_one(case):
    report = json.loads((GOLDEN / case / "drape.json").read_text())
    area, checks = report["area"], report["checks"]
    assert checks["edge_error"] <= 1e-6
    assert checks["off_surface"] <= 1e-6
    assert checks["curvature_residual"] < 0.3
    if case == "blank-on-saddle":
        assert area["fabric"] == pytest.approx(90.0 * 63.0, abs=1e-4)
    else:
        assert area["coverage"] == 1.0
        assert area["fabric"] > area["part"]


@pytest.mark.parametrize("hash_seed", ["0", "1", "7"])
def test_a_run_in_a_process_of_its_own_gives_the_same_bytes(anew, tmp_path, hash_seed):
    case = "l-with-hole"
    command = [sys.executable, "-m", "geomdrap", *golden.command(case, tmp_path / "again")]
    environment = {**os.environ, "PYTHONHASHSEED": hash_seed}  # the order of sets differs with it
    subprocess.run(command, check=True, cwd=GOLDEN.parents[1], env=environment, capture_output=True, timeout=600)
    for name in FILES:
        assert (tmp_path / "again" / name).read_bytes() == (anew / case / name).read_bytes(), name


def test_a_node_moved_by_a_hundredth_of_a_millimetre_is_found(tmp_path):
    shutil.copytree(GOLDEN / "hemisphere", tmp_path / "moved")
    table = tmp_path / "moved" / "nodes.csv"
    head, *rows = table.read_text().splitlines()
    x = head.split(",").index("x")
    row = rows[100].split(",")
    row[x] = f"{float(row[x]) + 0.01:.6f}"
    table.write_text("\n".join([head, *rows[:100], ",".join(row), *rows[101:]]) + "\n")
    code, changes = diff(GOLDEN / "hemisphere", tmp_path / "moved")
    assert code == 1
    (change,) = changes
    assert change["file"] == "nodes.csv"
    assert (change["amount"], change["unit"]) == (pytest.approx(0.01, abs=1e-6), "mm")
    assert diff(GOLDEN / "hemisphere", tmp_path / "moved", "--tol-mm", "0.02") == (0, [])


@pytest.mark.parametrize(("option", "value"), [("--angle", "20.01"), ("--origin", "3.01,-2,45")])
def test_another_heading_or_seed_is_found_in_every_file(tmp_path, option, value):
    result = run(*golden.command("hemisphere", tmp_path / "other", option, value))
    assert result.exit_code == 0, result.output
    code, changes = diff(GOLDEN / "hemisphere", tmp_path / "other")
    assert code == 1
    assert {change["file"] for change in changes} == set(FILES)
