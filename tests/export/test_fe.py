"""The hand-over to finite elements: what is written for each solver, read back."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from fe_decks import (
    abaqus,
    abaqus_axes,
    abaqus_blocks,
    corners_normal_side,
    fixed_fields,
    grid,
    nastran,
    radioss,
    turned,
)
from fe_plies import HEADING, dome, out, written

import geomdrap as gd
from geomdrap.errors import GeomdrapError
from geomdrap.export import fe_abaqus, fe_acp, fe_nastran, fe_optistruct, fe_radioss
from geomdrap.export.fe_read import read_fe_mesh
from geomdrap.export.map_onto import map_onto


def test_abaqus_axes_are_yarn_and_element_normal_per_element(cap, tmp_path):
    points, quads = grid(8, 8, 90.0, height=dome)
    ply = map_onto(cap, written(tmp_path, "m.inp", abaqus(points, quads)))
    text = out(fe_abaqus, ply, tmp_path, thickness=0.4)
    _, normal, _ = corners_normal_side(points, quads)
    for name, direction in (("GEOMDRAP_WARP_AXES", ply.warp), ("GEOMDRAP_WEFT_AXES", ply.weft)):
        found = abaqus_axes(text, name)
        assert sorted(found) == ply.mesh.element_ids.tolist()
        a, b = (np.array([found[n][k] for n in ply.mesh.element_ids.tolist()]) for k in (0, 1))
        np.testing.assert_allclose(a, direction, atol=1e-6)
        np.testing.assert_allclose(np.cross(a, b), normal, atol=1e-6)
    blocks = dict(abaqus_blocks(text))
    thickness = next(rows for head, rows in blocks.items() if "NAME=GEOMDRAP_THICKNESS," in head)
    values = [float(row.split(",")[1]) for row in thickness[1:]]
    np.testing.assert_allclose(values, 0.4 / np.cos(np.radians(ply.shear)), atol=2e-6)
    members = [int(n) for row in blocks["*ELSET, ELSET=GEOMDRAP_PLY"] for n in row.split(",")]
    assert members == ply.mesh.element_ids.tolist()
    assert all(len(row.split(",")) <= 16 for row in blocks["*ELSET, ELSET=GEOMDRAP_PLY"])


def test_without_a_mesh_the_decks_hold_the_part_itself(cap, tmp_path):
    part = cap.net.surface
    ply = map_onto(cap)
    for module, name in ((fe_abaqus, "a.inp"), (fe_nastran, "a.bdf")):
        module.write(ply, tmp_path / name)
        mesh = read_fe_mesh(tmp_path / name)
        np.testing.assert_allclose(mesh.points, part.points, atol=6e-4)
        np.testing.assert_array_equal(mesh.corners[:, :3], part.triangles)
        cut = [line[:48] if line.startswith("CTRIA3") else line for line in (tmp_path / name).read_text().splitlines()]
        (tmp_path / name).write_text("\n".join(cut))  # meshio takes THETA for a node
        again = gd.read_surface(tmp_path / name)  # meshio's reader, which shares nothing with ours
        assert len(again.triangles) == len(part.triangles)
        assert again.area == pytest.approx(part.area, rel=1e-5)


@pytest.mark.parametrize(
    ("theta", "system", "axis", "expected"),
    [
        ("", "", None, HEADING),
        ("10.", "", None, HEADING - 10.0),
        ("0", "", None, HEADING),  # MCID 0: the basic x
        ("9", "CORD2R,9,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.", None, HEADING - 90.0),
        ("10.", "", (0.0, -3.0, 0.0), HEADING + 90.0),
    ],
)
def test_the_angle_of_the_optistruct_drape_counts_from_the_axis_of_the_element(
    flat, tmp_path, theta, system, axis, expected
):
    points, quads = grid(3, 3, 90.0)
    quads[::3] = quads[::3, ::-1]  # all upright
    deck = nastran(points, quads, theta=theta).replace("ENDDATA", f"{system}\nENDDATA")
    ply = map_onto(flat, written(tmp_path, "m.fem", deck), axis)
    lines = [line for line in out(fe_optistruct, ply, tmp_path).splitlines() if not line.startswith("$")]
    assert fixed_fields(lines[0]) == ["DRAPE", "1"]
    for line, of_mesh in zip(lines[1:], ply.mesh.element_ids.tolist(), strict=True):
        plus, kind, element, factor, angle = fixed_fields(line)
        assert (plus, kind, element) == ("+", "ELEM", str(of_mesh))
        assert float(factor) == pytest.approx(1.0)
        assert float(angle) == pytest.approx(expected, abs=1e-3)


def test_radioss_drape_has_the_columns_that_the_starter_reads(cap, tmp_path):
    points, quads = grid(8, 8, 90.0, height=dome)
    ply = map_onto(cap, written(tmp_path, "m.rad", radioss(points, quads)))
    lines = [line for line in out(fe_radioss, ply, tmp_path).splitlines() if not line.startswith("#")]
    assert lines[0] == "/DRAPE/1"
    assert 0 < len(lines[1]) <= 100
    table = [(line[:10], int(line[10:20]), float(line[20:40]), float(line[40:60]), line[60:]) for line in lines[2:]]
    assert {row[0] for row in table} == {"SHELL     "}
    assert [row[1] for row in table] == ply.mesh.element_ids.tolist()
    np.testing.assert_allclose([row[2] for row in table], 1 / np.cos(np.radians(ply.shear)), atol=2e-6)
    _, normal, _ = corners_normal_side(points, quads)
    back = turned(ply.mesh.sides, normal, np.array([row[3] for row in table]))
    np.testing.assert_allclose(back, ply.warp, atol=1e-6)


@pytest.mark.parametrize(
    ("axis", "words"),
    [(None, "the element's own material axis (its side 1-2"), ((0.0, -3.0, 0.5), "(0, -3, 0.5) laid into the element")],
)
def test_files_with_angles_say_what_these_count_from(flat, tmp_path, axis, words):
    ply = map_onto(flat, axis=axis)
    for module in (fe_optistruct, fe_radioss):
        (line,) = [line for line in out(module, ply, tmp_path).splitlines() if words in line]
        assert line.startswith(("$", "#"))


def test_triangles_are_sh3n_in_radioss(flat, tmp_path):
    lines = out(fe_radioss, map_onto(flat), tmp_path).splitlines()
    rows = [line for line in lines if not line.startswith(("#", "/", "Ply"))]
    assert {line[:10] for line in rows} == {"SH3N      "}
    assert len(rows) == len(flat.net.surface.triangles)


def test_the_acp_table_has_place_directions_and_scalars(cap, tmp_path):
    points, quads = grid(6, 6, 90.0, height=dome)
    ply = map_onto(cap, written(tmp_path, "m.inp", abaqus(points, quads)))
    table = list(csv.DictReader(out(fe_acp, ply, tmp_path, thickness=0.3).splitlines()))
    assert [int(row["Element"]) for row in table] == ply.mesh.element_ids.tolist()

    def columns(*names):
        return np.array([[float(row[name]) for name in names] for row in table])

    center, normal, _ = corners_normal_side(points, quads)
    np.testing.assert_allclose(columns("Location_x", "Location_y", "Location_z"), center, atol=1e-5)
    np.testing.assert_allclose(columns("Warp_x", "Warp_y", "Warp_z"), ply.warp, atol=1e-6)
    for name, direction in (("WarpAngle", ply.warp), ("WeftAngle", ply.weft)):
        np.testing.assert_allclose(turned(ply.mesh.sides, normal, columns(name)[:, 0]), direction, atol=1e-6)
    np.testing.assert_allclose(columns("Thickness")[:, 0], 0.3 / np.cos(np.radians(columns("Shear")[:, 0])), atol=1e-5)


def test_numbers_too_long_for_a_field_are_refused(flat, tmp_path):
    ply = map_onto(flat, written(tmp_path, "m.inp", abaqus(*grid(2, 2, 60.0), first_element=100_000_000)))
    for module in (fe_nastran, fe_optistruct):
        with pytest.raises(GeomdrapError, match="100000003 does not fit into the 8 columns"):
            module.write(ply, tmp_path / "out")
