"""``geomdrap compare`` from files to files."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from analytic_tools import DATA, saddle

from geomdrap.cli.compare import COMPARE_OUTPUTS as OFFERED
from geomdrap.export.compare_outputs import COMPARE_OUTPUTS

CASE = DATA / "springback"


@pytest.fixture
def files(tmp_path):
    """A part, a measurement and a set-up in the folder where commands run."""
    import meshio

    surface = saddle()
    meshio.Mesh(surface.points, [("triangle", surface.triangles)]).write(tmp_path / "part.obj")
    for name in ("measured.csv", "setup.toml"):
        (tmp_path / name).write_bytes((CASE / name).read_bytes())
    return tmp_path


def _json(result):
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def test_all_files_are_written_and_the_json_is_that_of_the_design(run, files):
    document = _json(run("compare", "part.obj", "measured.csv", "--setup", "setup.toml", "-o", "out", "--json"))
    assert document["schema"] == "geomdrap.compare/1"
    assert document["points"] == 319
    assert document["used"] + document["unmatched"] == document["points"]
    assert document["position"]["noise"] == pytest.approx(0.2 * np.sqrt(3.0), abs=1e-6)
    assert document["position"]["rms"] == pytest.approx(0.346, abs=0.02)
    assert document["shear"]["noise"] == pytest.approx(0.6)
    assert document["shear"]["rms"] > 1.5
    assert document["chi2_per_dof"] > 2.0
    assert document["worst"]
    assert {Path(name).name for name in document["files"].values()} == {"compare.json", "residuals.csv", "residuals.vtu", "compare.png"}
    stored = json.loads((files / "out" / "compare.json").read_text())
    assert {k: v for k, v in stored.items() if k != "files"} == {k: v for k, v in document.items() if k != "files"}


def test_files_of_an_earlier_comparison_are_warned_of(run, files):
    command = "compare", "part.obj", "measured.csv", "--setup", "setup.toml", "-o", "out", "--outputs"
    assert "earlier run" not in run(*command, "csv").stderr
    assert "residuals.csv in out is of an earlier run: remove it" in run(*command, "json").stderr
    assert "earlier run" not in run(*command, "none").stderr


def test_the_table_has_a_row_for_each_point(run, files):
    run("compare", "part.obj", "measured.csv", "--setup", "setup.toml", "-o", "out", "--outputs", "csv")
    rows = list(csv.DictReader((files / "out" / "residuals.csv").open()))
    assert [int(row["line"]) for row in rows] == list(range(2, 321))
    first = rows[0]
    for axis in "xyz":
        assert float(first[axis]) - float(first[f"predicted_{axis}"]) == pytest.approx(float(first[f"residual_{axis}"]), abs=2e-6)
    assert float(first["shear"]) - float(first["predicted_shear"]) == pytest.approx(float(first["residual_shear"]), abs=2e-6)


def test_the_points_and_vectors_can_be_read_back(run, files):
    import meshio

    run("compare", "part.obj", "measured.csv", "--setup", "setup.toml", "-o", "out", "--outputs", "vtu,csv")
    mesh = meshio.read(files / "out" / "residuals.vtu")
    assert mesh.point_data["residual"].shape == (319, 3)
    rows = list(csv.DictReader((files / "out" / "residuals.csv").open()))
    np.testing.assert_allclose(mesh.point_data["residual"][:, 2], [float(r["residual_z"]) for r in rows], atol=1e-6)


def test_options_go_before_the_setup(run, files):
    plain = ("compare", "part.obj", "measured.csv", "--setup", "setup.toml", "--outputs", "none", "--json")
    document = _json(run(*plain, "--angle", "31", "--sigma-xyz", "0.4", "--pitch", "8", "--origin", "1,0,0"))
    assert document["angle"] == 31.0
    assert document["pitch"] == 8.0
    assert document["origin"][0] == pytest.approx(1.0, abs=0.01)
    assert document["position"]["sigma"] == pytest.approx(0.4)
    assert document["shear"]["sigma"] == pytest.approx(0.6)  # still that of the set-up


def test_a_noise_that_the_data_contradict_is_questioned_in_text_and_json(run, files):
    plain = ("compare", "part.obj", "measured.csv", "--setup", "setup.toml", "--outputs", "none", "--json")
    assert _json(run(*plain))["warnings"] == []
    result = run(*plain, "--sigma-xyz", "20", "--sigma-shear", "60")
    xyz, shear = _json(result)["warnings"]
    assert "the noise of 20 mm that is given (--sigma-xyz" in xyz
    assert "the noise of 60° that is given (--sigma-shear" in shear
    assert f"Warning: {xyz}" in result.stderr


def test_what_was_not_given_is_said(run, files):
    result = run("compare", "part.obj", "measured.csv", "--outputs", "none")
    assert "origin not given" in result.stderr
    assert "angle not given" in result.stderr
    assert "neighbour differences" in result.stdout


def test_headings_numbers_of_marks_and_units_come_by_options(run, files):
    with (files / "measured.csv").open() as file:
        rows = list(csv.DictReader(file))
    lines = ["IX;IY;PX [m];PY [m];PZ [m];Gamma"]
    for row in rows:
        numbers = (float(row["u"]) / 16 + 20, float(row["v"]) / 16 + 5, *(float(row[k]) / 1000 for k in "xyz"))
        lines.append(";".join(f"{x:.9g}".replace(".", ",") for x in (*numbers, float(row["shear"]))))
    (files / "dic.txt").write_text("\n".join(lines))
    plain = ("--setup", "setup.toml", "--outputs", "none", "--json")
    columns = "i=IX,j=IY,x=PX [m],y=PY [m],z=PZ [m],shear=Gamma"
    options = ("--columns", columns, "--unit-measured", "m", "--mark-spacing", "16", "--mark-origin", "20,5")
    document = _json(run("compare", "part.obj", "dic.txt", *options, *plain))
    assert document["chi2_per_dof"] == pytest.approx(_json(run("compare", "part.obj", "measured.csv", *plain))["chi2_per_dof"], abs=1e-4)


def test_a_table_without_labels_is_held_against_the_nearest_points(run, files):
    lines = [line.split(",") for line in (files / "measured.csv").read_text().splitlines()]
    (files / "points.csv").write_text("\n".join(",".join(cells[2:5]) for cells in lines))
    document = _json(run("compare", "part.obj", "points.csv", "--setup", "setup.toml", "--outputs", "png", "--json"))
    assert document["matched_by"] == "nearest point"
    assert document["shear"] is None
    assert document["position"]["kind"] == "normal distance"
    assert document["position"]["noise"] == pytest.approx(0.2)
    assert document["position"]["rms"] == pytest.approx(0.2, rel=0.1)


def test_the_summary_says_the_same_in_words(run, files):
    result = run("compare", "part.obj", "measured.csv", "--setup", "setup.toml", "--outputs", "none")
    assert "319 of 319 points compared" in result.stdout
    assert "shear grows with predicted shear" in result.stdout
    assert "(given)" in result.stdout
    assert "neighbours are alike, which noise is not: shear (Moran's I" in result.stdout


BAD = {
    "a missing table": ("compare part.obj none.csv", "none.csv"),
    "a missing part": ("compare none.obj measured.csv", "none.obj"),
    "a folder": ("compare part.obj .", "is a folder"),
    "a picture for a table": ("compare part.obj picture.csv", "not a text table"),
    "a set-up with another key": ("compare part.obj measured.csv --setup bad.toml", "'sigma'"),
    "columns that are not there": ("compare part.obj measured.csv --columns x=X1", "no column 'X1'"),
    "columns without a sign": ("compare part.obj measured.csv --columns x", "quantity=heading"),
    "an unknown quantity": ("compare part.obj measured.csv --columns gamma=shear", "'gamma'"),
    "a noise of nothing": ("compare part.obj measured.csv --sigma-xyz 0", "above 0"),
    "a spacing without numbers": ("compare part.obj points.csv --mark-spacing 16", "no columns i and j"),
    "three spacings": ("compare part.obj measured.csv --mark-spacing 1,2,3", "one number, or two"),
    "metres": ("compare part.obj metres.csv", "--unit-measured m"),
    "an origin off the part": ("compare part.obj measured.csv --origin 0,0,90", "origin"),
    "another format": ("compare part.obj measured.csv --outputs dxf", "'dxf'"),
}


@pytest.mark.parametrize(("command", "word"), BAD.values(), ids=BAD)
def test_bad_input_is_refused_in_one_line_and_nothing_is_written(error_of, files, command, word):
    (files / "picture.csv").write_bytes(b"\x89PNG\r\n\x00\x01\x02")
    (files / "bad.toml").write_text("sigma = 1\n")
    rows = [line.split(",") for line in (files / "measured.csv").read_text().splitlines()]
    (files / "points.csv").write_text("\n".join(",".join(cells[2:5]) for cells in rows))
    scaled = [[f"{float(x) / 1000}" for x in cells] for cells in rows[1:]]
    (files / "metres.csv").write_text("\n".join([",".join(rows[0][:5]), *(",".join(cells[:5]) for cells in scaled)]))
    assert word in error_of(*command.split())
    assert not (files / "compare").exists()


def test_the_outputs_on_the_command_line_are_those_there_are():
    assert tuple(COMPARE_OUTPUTS) == OFFERED
