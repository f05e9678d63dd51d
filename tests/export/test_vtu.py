"""net.vtu and part.vtu, read back."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np
import pytest
from square_ply import square_ply

from geomdrap.export import vtu


def test_the_net_has_a_quad_for_each_valid_cell_in_turning_order(tmp_path: Path) -> None:
    result = square_ply()
    vtu.write_net(result, tmp_path / "net.vtu")
    mesh = meshio.read(tmp_path / "net.vtu")
    (block,) = mesh.cells
    assert (block.type, len(block.data), len(mesh.points)) == ("quad", 15, 24)
    corners = mesh.points[block.data]
    area = 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])[:, 2]
    np.testing.assert_allclose(area, 100.0)  # positive: counter-clockwise about the normal


def test_point_fields_of_the_net_belong_to_their_points(tmp_path: Path) -> None:
    vtu.write_net(square_ply(), tmp_path / "net.vtu")
    mesh = meshio.read(tmp_path / "net.vtu")
    np.testing.assert_array_equal(mesh.point_data["u"], mesh.points[:, 0])
    np.testing.assert_array_equal(mesh.point_data["v"], mesh.points[:, 1])
    np.testing.assert_allclose(mesh.point_data["shear"], mesh.points[:, 0] / 10)


def test_cell_fields_of_the_net_belong_to_their_cells(tmp_path: Path) -> None:
    result = square_ply()
    vtu.write_net(result, tmp_path / "net.vtu")
    mesh = meshio.read(tmp_path / "net.vtu")
    middle = mesh.points[mesh.cells[0].data].mean(axis=1)
    np.testing.assert_allclose(mesh.cell_data["shear"][0], middle[:, 0] / 10)
    for factor in ("thickness", "fibre_volume"):
        np.testing.assert_allclose(mesh.cell_data[factor][0], 1 / np.cos(np.radians(middle[:, 0] / 10)))


def test_a_net_without_a_single_cell_can_be_written(tmp_path: Path) -> None:
    result = square_ply()
    result.net.cell_valid[:] = False
    vtu.write_net(result, tmp_path / "net.vtu")
    assert (tmp_path / "net.vtu").exists()


def test_the_part_keeps_its_triangles_and_every_field_survives(tmp_path: Path) -> None:
    result = square_ply()
    result.face_shear[1] = np.nan
    result.face_warp[1] = np.nan
    vtu.write_part(result, tmp_path / "part.vtu")
    mesh = meshio.read(tmp_path / "part.vtu")
    np.testing.assert_array_equal(mesh.cells_dict["triangle"], result.net.surface.triangles)
    np.testing.assert_array_equal(mesh.points, result.net.surface.points)
    expected = {
        "shear": result.face_shear,
        "thickness": result.face_thickness,
        "fibre_volume": result.face_fibre_volume,
        "warp": result.face_warp,
        "weft": result.face_weft,
        "class": [1, -1],
        "coverage": result.face_coverage,
        "reason": result.face_reason,
        "source_face": [0, 1],
    }
    assert set(mesh.cell_data) == set(expected)
    for name, values in expected.items():
        np.testing.assert_array_equal(mesh.cell_data[name][0], values, err_msg=name)


@pytest.mark.parametrize(
    ("shear", "expected"),
    [(0.0, 0), (24.9, 0), (-25.0, 1), (50.0, 1), (-50.1, 2), (np.nan, -1)],
)
def test_classes_change_at_half_the_limit_and_beyond_the_limit(shear: float, expected: int) -> None:
    assert vtu.shear_class(np.array([shear]), limit=50.0) == expected


def test_opens_in_the_real_reader(tmp_path: Path) -> None:
    vtk = pytest.importorskip("vtk", reason="vtk is not installed: pip install vtk to run this")
    vtu.write_part(square_ply(), tmp_path / "part.vtu")
    vtu.write_net(square_ply(), tmp_path / "net.vtu")
    for name, cells, type_number in (("part.vtu", 2, 5), ("net.vtu", 15, 9)):
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(tmp_path / name))
        reader.Update()
        grid = reader.GetOutput()
        assert grid.GetNumberOfCells() == cells
        assert grid.GetCellType(0) == type_number
        assert grid.GetCellData().GetArray("shear").GetNumberOfTuples() == cells
