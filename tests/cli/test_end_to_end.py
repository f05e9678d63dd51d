"""The whole way with the real program: a sample, its drape, all files, and the comparison of two runs."""

from __future__ import annotations

import json
import math
import subprocess
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest
from click.testing import Result

Run = Callable[..., Result]
Shell = Callable[..., subprocess.CompletedProcess[str]]
ALL_FILES = ["drape.json", "flat.dxf", "flat.svg", "net.vtu", "nodes.csv", "part.vtu", "report.html", "shear.png"]
GOLDEN = ["drape.json", "flat.dxf", "flat.svg", "nodes.csv"]


def _sample(run: Run, name: str, facets: int = 3000) -> str:
    assert run("sample", name, "--facets", facets).exit_code == 0
    return f"{name}.stl"


def test_a_cylinder_is_draped_without_shear_and_covered(run: Run) -> None:
    part = _sample(run, "cylinder", 6000)
    result = run("drape", part, "--angle", "30", "--pitch", "5", "--json", "--outputs", "none", "--strict")
    assert result.exit_code == 0, result.output
    report = json.loads(result.stdout)
    assert report["part"] == "cylinder.stl"
    assert report["shear"]["max"] < 0.1
    assert report["area"]["fabric"] == pytest.approx(report["area"]["part"], rel=0.002)
    assert report["area"]["coverage"] > 0.995


def test_all_files_are_written_and_can_be_read(run: Run) -> None:
    part = _sample(run, "hemisphere")
    report = json.loads(run("drape", part, "--angle", "45", "-o", "out", "--json").stdout)
    assert sorted(file.name for file in Path("out").iterdir()) == ALL_FILES
    assert sorted(Path(name).name for name in report["files"].values()) == ALL_FILES
    mesh = meshio.read("out/part.vtu")
    bare = np.isnan(mesh.cell_data["shear"][0])
    assert len(bare) == report["facets"]
    np.testing.assert_allclose(np.linalg.norm(mesh.cell_data["warp"][0][~bare], axis=1), 1.0)
    assert len(meshio.read("out/net.vtu").cells_dict["quad"]) == report["cells"]
    assert len(Path("out/nodes.csv").read_text().splitlines()) > report["nodes"]
    assert Path("out/shear.png").read_bytes().startswith(b"\x89PNG")
    assert ElementTree.parse("out/flat.svg").getroot().tag.endswith("svg")


def test_the_same_run_gives_the_same_bytes_and_no_trace_of_where_or_when(
    shell: Shell, run: Run, tmp_path: Path
) -> None:
    part = _sample(run, "saddle", 1500)
    for folder in ("one", "two/deeper"):
        done = shell("drape", part, "-o", folder, "--outputs", "json,csv,dxf,svg")
        assert done.returncode == 0, done.stderr
    for name in GOLDEN:
        first = Path("one", name).read_bytes()
        assert first == Path("two/deeper", name).read_bytes(), name
        assert str(tmp_path).encode() not in first
    result = run("diff", "one", "two/deeper")
    assert (result.exit_code, result.stdout) == (0, f"no change in {', '.join(c for c in _compared())}\n")


def _compared() -> list[str]:
    from geomdrap.export.diff import COMPARED

    return list(COMPARED)


def test_diff_finds_another_heading_in_every_file(run: Run) -> None:
    part = _sample(run, "hemisphere", 1500)
    for angle in ("0", "1"):
        run("drape", part, "--angle", angle, "-o", angle, "--outputs", "json,csv,dxf,svg")
    result = run("diff", "0", "1", "--json")
    assert result.exit_code == 1
    changes = json.loads(result.stdout)["changes"]
    assert {change["file"] for change in changes} == set(GOLDEN)
    (angle,) = [c for c in changes if c["where"] == "angle"]
    assert (angle["amount"], angle["unit"]) == (1.0, "deg")


def test_a_part_in_metres_read_as_such_is_the_part_in_mm(run: Run) -> None:
    part = _sample(run, "saddle", 1500)
    mesh = meshio.read(part)
    for name, scale in (("mm.obj", 1.0), ("m.obj", 1e-3)):
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (mesh.points.astype(float) * scale).tolist()]
        faces = [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in mesh.cells_dict["triangle"].tolist()]
        Path(name).write_text("\n".join([*lines, *faces]) + "\n")
    options = "--pitch", "7", "--outputs", "json,csv,dxf,svg"
    assert run("drape", "mm.obj", *options, "-o", "a").exit_code == 0
    assert run("drape", "m.obj", "--unit", "m", *options, "-o", "b").exit_code == 0
    changes = json.loads(run("diff", "a", "b", "--json").stdout)["changes"]
    assert [change for change in changes if "mm.obj" not in change["what"]] == []


def test_the_origin_is_where_it_was_put_also_with_negative_coordinates(run: Run) -> None:
    part = _sample(run, "saddle", 1500)
    x, y = -40.0, 25.0
    z = (x * x - y * y) / 600
    result = run("drape", part, "--origin", f"{x},{y},{z}", "--json", "--outputs", "none")
    assert json.loads(result.stdout)["origin"] == pytest.approx([x, y, z], abs=0.3)


def test_a_blank_limits_the_fabric(run: Run) -> None:
    part = _sample(run, "saddle", 1500)
    options = "--pitch", "5", "--json", "--outputs", "none"
    report = json.loads(run("drape", part, "--blank", "100x60", *options).stdout)
    assert report["area"]["fabric"] == pytest.approx(6000, rel=0.02)
    assert report["incomplete"] is True
    assert run("drape", part, "--blank", "100x60", *options, "--strict").exit_code == 1


def test_the_heading_turns_counter_clockwise_about_the_normal(run: Run) -> None:
    Path("square.obj").write_text("v -50 -50 0\nv 50 -50 0\nv 50 50 0\nv -50 50 0\nf 1 2 3\nf 1 3 4\n")
    run("drape", "square.obj", "--angle", "30", "--pitch", "10", "--outputs", "csv")
    rows = [line.split(",") for line in Path("drape/nodes.csv").read_text().splitlines()[1:]]
    place = {(row[0], row[1]): row[4:7] for row in rows}
    angle = math.radians(30)
    for node, direction in ((("1", "0"), angle), (("0", "1"), angle + math.pi / 2)):
        x, y, _ = (float(value) for value in place[node])
        assert (x, y) == pytest.approx((10 * math.cos(direction), 10 * math.sin(direction)), abs=1e-5)
    flipped = run("drape", "square.obj", "--angle", "30", "--flip", "--pitch", "10", "--outputs", "csv")
    assert flipped.exit_code == 0
    rows = [line.split(",") for line in Path("drape/nodes.csv").read_text().splitlines()[1:]]
    (first,) = [row for row in rows if row[:2] == ["1", "0"]]
    assert float(first[5]) == pytest.approx(-10 * math.sin(angle), abs=1e-5)
