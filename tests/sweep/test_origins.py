"""Origins as they are written."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from made_parts import bumpy_sheet, square_tube

import geomdrap as gd
from geomdrap.surface import shapes
from geomdrap.sweep import locate_origins
from geomdrap.sweep.origins import read_points


def test_a_grid_lies_in_the_middles_of_equal_fields_and_on_the_part() -> None:
    part = bumpy_sheet()
    points, notes = locate_origins(part, ["grid:4x2"])
    low, high = part.bounds
    x = low[0] + (np.arange(4) + 0.5) / 4 * (high - low)[0]
    y = low[1] + (np.arange(2) + 0.5) / 2 * (high - low)[1]
    assert notes == ()
    assert len(points) == 8
    up = part.areas @ part.normals
    assert up[2] / np.linalg.norm(up) > 0.99  # seen nearly along z, so that the plan is nearly that of x and y
    assert np.abs(np.array(points)[:, :2] - np.array([(a, b) for a in x for b in y])).max() < 0.05 * 100.0
    assert part.nearest(np.array(points)).distance.max() < 1e-9


def test_points_of_a_grid_over_a_flat_part_are_exact() -> None:
    part = gd.Surface([[0, 0, 3], [8, 0, 3], [8, 4, 3], [0, 4, 3]], [[0, 1, 2], [0, 2, 3]])
    points, _ = locate_origins(part, ["grid:2x2"])
    assert np.array(points) == pytest.approx(np.array([[2, 1, 3], [2, 3, 3], [6, 1, 3], [6, 3, 3]]))


def test_points_of_a_grid_that_miss_the_part_are_left_out_and_counted() -> None:
    part = gd.Surface([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 1, 2]])
    points, notes = locate_origins(part, ["grid:3x3"])
    assert len(points) == 6
    assert notes == ("3 of 9 points of grid:3x3 miss the part and are left out",)


def test_a_grid_takes_the_uppermost_of_what_lies_over_each_other() -> None:
    part = shapes.icosphere(50.0, 3)
    points, _ = locate_origins(part, ["grid:3x3"])
    up = int(np.abs(np.array(points).mean(axis=0)).argmax())
    assert (np.array(points)[:, up] > 0.0).all()


def test_a_closed_tube_without_an_upper_side_has_a_grid_too() -> None:
    points, _ = locate_origins(square_tube(), ["grid:3x1"])
    assert len(points) == 3


def test_a_grid_whose_points_all_miss_is_refused() -> None:
    frame = shapes.icosphere(50.0, 3)
    keep = np.linalg.norm(frame.points[frame.triangles].mean(axis=1)[:, :2], axis=1) > 30.0
    part = gd.Surface(frame.points, frame.triangles[keep & (frame.normals[:, 2] > 0.0)])
    with pytest.raises(gd.SweepError, match="no point of the grid meets"):
        locate_origins(part, ["grid:1x1"])


@pytest.mark.parametrize("text", ["grid:0x3", "grid:5", "grid:axb", "grid:-1x3", "grid:99999x99999"])
def test_what_is_no_grid_is_refused(text: str) -> None:
    with pytest.raises(gd.SweepError, match="a grid is grid:NxM, as in grid:5x5"):
        locate_origins(bumpy_sheet(), [text])


def test_centroid_points_vertices_and_a_table_may_be_mixed_and_come_once(tmp_path: Path) -> None:
    part = bumpy_sheet()
    x, y, z = (float(c) for c in part.points[30])
    table = tmp_path / "seeds.csv"
    table.write_text(f"# two seeds\nname, x, Y ,z\n\none,{x},{y},{z}\ntwo,0,0,0\n", encoding="utf-8")
    points, _ = locate_origins(part, ["centroid", f"{x},{y},{z}", "vertex:30", str(table)], pitch=20.0)
    assert points[0] == "centroid"
    assert points[1] == pytest.approx((x, y, z))
    assert len(points) == 3
    assert points[2][:2] == pytest.approx((0.0, 0.0), abs=6.0)


def test_a_table_may_have_semicolons_and_decimal_commas_as_measured_ones_do(tmp_path: Path) -> None:
    table = tmp_path / "seeds.csv"
    table.write_bytes("\ufeffx;y;z\r\n1,5;-2,25;0\r\n".encode("utf-16-le"))
    assert read_points(table).tolist() == [[1.5, -2.25, 0.0]]


def test_an_origin_off_the_part_is_refused_with_its_line_unless_projected(tmp_path: Path) -> None:
    part = bumpy_sheet()
    table = tmp_path / "seeds.csv"
    table.write_text("x,y,z\n0,0,0\n0,0,500\n", encoding="utf-8")
    with pytest.raises(gd.SweepError, match=r"seeds.csv, line 3: lies 49\d.* more than the pitch of 20 mm; move it"):
        locate_origins(part, [str(table)], pitch=20.0)
    points, _ = locate_origins(part, [str(table)], pitch=20.0, project=True)
    assert part.nearest(np.array(points)).distance.max() < 1e-9


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "seeds.csv is empty: it needs a header line"),
        ("a,b\n1,2\n", "no column x, y, z"),
        ("x,y\n1,2\n", "no column z"),
        ("0,0,0\n1,2,3\n", "line 1: the header is missing"),
        ("x,y,z\n", "seeds.csv has a header but no rows"),
        ("x,y,z\n1,2\n", "line 2: the row has 2 cells, but the header names 3 columns"),
        ("x,y,z\n1,2,\n", "line 2: '1,2,' is not three finite numbers"),
        ("x,y,z\n1,2,3_0\n", "line 2: '1,2,3_0' is not three finite numbers"),
        ("x,y,z\n1,2,nan\n", "line 2: '1,2,nan' is not three finite numbers"),
    ],
)
def test_a_table_that_cannot_be_read_is_refused(tmp_path: Path, text: str, why: str) -> None:
    table = tmp_path / "seeds.csv"
    table.write_text(text, encoding="utf-8")
    with pytest.raises(gd.SweepError, match=why):
        locate_origins(bumpy_sheet(), [str(table)])


def test_a_text_that_is_nothing_known_lists_what_there_is() -> None:
    with pytest.raises(gd.SweepError, match=r"centroid, x,y,z, vertex:N, grid:NxM"):
        locate_origins(bumpy_sheet(), ["middle"])
