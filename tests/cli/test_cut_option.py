"""--cut: lines that a ply does not pass."""

import json

import numpy as np
import pytest
from made_parts import open_box, plane_sheet

from geomdrap.surface import Surface

SIZE = (100.0, 80.0, 60.0)


@pytest.fixture
def box(tmp_path):
    """An open box in the folder where commands run, and a line up each of its four upright edges."""
    import trimesh

    part: Surface = open_box(5.0, SIZE)
    trimesh.Trimesh(part.points, part.triangles, process=False).export(tmp_path / "box.stl")
    low, high = part.bounds
    corners = [(x, y) for x in (low[0], high[0]) for y in (low[1], high[1])]
    for n, (x, y) in enumerate(corners):
        (tmp_path / f"corner-{n}.csv").write_text(f"x,y,z\n{x},{y},{low[2]}\n{x},{y},{high[2]}\n")
    return [argument for n in range(4) for argument in ("--cut", f"corner-{n}.csv")]


def test_a_box_cut_at_its_corners_is_covered_without_shear(run, box):
    result = run("drape", "box.stl", "--pitch", "4", "--origin", "12,7,30", "--json", "--outputs", "json", *box)
    assert result.exit_code == 0
    drape = json.loads(result.stdout)
    assert drape["shear"]["max"] < 1e-6
    assert drape["area"]["coverage"] == pytest.approx(1.0, abs=1e-9)
    # At the inner end of a cut, a corner of the box, fabric coordinates are off by up to 0.02 of the pitch.
    assert drape["area"]["fabric"] == pytest.approx(drape["area"]["part"], rel=3e-5)
    assert any("cut along corner-0.csv, corner-1.csv" in note for note in drape["notes"])


def test_sweeps_drape_the_part_as_it_is_cut(run, box):
    options = ("--angles", "0,20", "--pitch", "4", "-j", "1", "--json", "--outputs", "json")
    rows = json.loads(run("sweep", "box.stl", *options, *box).stdout)["rows"]
    assert all(row["max_shear"] < 1e-6 and row["coverage"] > 0.9999 for row in rows)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x,y,z\n0,0,500\n0,10,500\n", "lies"),
        ("x,y,z\n0,0,0\n", "two different points"),
        ("a,b\n1,2\n", "x, y, z"),
        (None, "line.csv"),
    ],
    ids=["off the part", "one point", "other columns", "no file"],
)
def test_a_line_that_is_none_says_so(run, box, tmp_path, text, words):
    if text is not None:
        (tmp_path / "line.csv").write_text(text)
    result = run("drape", "box.stl", "--cut", "line.csv")
    assert result.exit_code == 2
    assert words in result.stderr
    assert "line.csv" in result.stderr
    assert not (tmp_path / "drape").exists()


def test_a_cut_that_stays_shut_is_drawn_in_every_file_that_is_cut_from(run, tmp_path):
    import ezdxf
    import trimesh

    part = plane_sheet(6, 60.0)
    trimesh.Trimesh(part.points, part.triangles, process=False).export(tmp_path / "plate.stl")
    (tmp_path / "slit.csv").write_text("x,y,z\n15,22,0\n42,38,0\n")
    options = ("--pitch", "5", "--origin", "30,50,0", "--outputs", "dxf,svg,cut", "--cut", "slit.csv", "-o", "out")
    assert run("drape", "plate.stl", *options).exit_code == 0
    flat = ezdxf.readfile(tmp_path / "out" / "flat.dxf")
    lines = flat.modelspace().query('*[layer=="CUTS"]')
    assert sum(
        np.linalg.norm(np.diff([p[:2] for p in line.get_points()], axis=0)) for line in lines
    ) == pytest.approx(np.hypot(27.0, 16.0), rel=1e-2)
    assert 'id="cuts"' in (tmp_path / "out" / "flat.svg").read_text()
    (block,) = (b for b in ezdxf.readfile(tmp_path / "out" / "cut.dxf").blocks if b.name == "PLATE")
    assert len(block.query('LINE[layer=="11"]')) == len(lines)
