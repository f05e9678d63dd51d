"""Finite element meshes read from decks of each solver, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from fe_decks import abaqus, corners_normal_side, grid, nastran, radioss
from fe_plies import written

from geomdrap.errors import GeomdrapError
from geomdrap.export.fe_read import read_fe_mesh
from geomdrap.export.map_onto import map_onto

POINTS, QUADS = grid(2, 2, 60.0)
GOOD_INP, GOOD_BDF = abaqus(POINTS, QUADS), nastran(POINTS, QUADS)


@pytest.mark.parametrize(("name", "deck"), [("m.inp", abaqus), ("m.bdf", nastran), ("m.fem", nastran), ("m.rad", radioss)])
def test_a_mesh_is_read_with_the_numbers_of_its_file(tmp_path, name, deck):
    points, quads = grid(5, 4, 120.0, turn=10.0)
    mesh = written(tmp_path, name, deck(points, quads))
    np.testing.assert_allclose(mesh.points, points, atol=1e-6)
    np.testing.assert_array_equal(mesh.corners, quads)
    np.testing.assert_array_equal(mesh.element_ids, 501 + np.arange(20))
    np.testing.assert_array_equal(mesh.node_ids, 1001 + np.arange(30))
    assert mesh.is_quad.all()
    center, normal, side = corners_normal_side(points, quads)
    np.testing.assert_allclose(mesh.centers, center, atol=1e-6)
    np.testing.assert_allclose(mesh.normals, normal, atol=1e-9)
    np.testing.assert_allclose(mesh.sides, side, atol=1e-7)


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("m.stl", "solid", "not '.stl'"),
        ("m.inp", "", "m.inp holds no shell elements"),
        ("m.inp", GOOD_INP.replace("S4R", "C3D8"), "holds no shell elements"),
        ("m.inp", GOOD_INP.replace("1001, ", "9999, ", 1), "an element has node 1001, which is not there"),
        ("m.inp", GOOD_INP.replace("502, ", "501, ", 1), "element 501 is there twice"),
        ("m.inp", GOOD_INP + "*INCLUDE, INPUT=x.inp\n", "includes another file"),
        ("m.inp", GOOD_INP.replace("*NODE,", "*NODE, SYSTEM=C,"), "rectangular"),
        ("m.inp", GOOD_INP.replace("1001, -30", "1001, -3x"), "line 5: '-3x' is not a number"),
        ("m.inp", GOOD_INP + "*INSTANCE, NAME=I-1, PART=P\n10., 0., 0.\n", "instance I-1 is moved"),
        ("m.inp", GOOD_INP + "*PART, NAME=B\n" + GOOD_INP, "2 parts with shells"),
        ("m.bdf", GOOD_BDF.replace("ENDDATA", "INCLUDE 'x.bdf'\nENDDATA"), "includes another file"),
        ("m.bdf", "GRID,1,4,0.,0.,0.\n", "GRID in coordinate system 4"),
        ("m.bdf", nastran(POINTS, QUADS, theta="4"), "system 4, which is no CORD2R"),
        ("m.bdf", nastran(POINTS, QUADS, "4").replace("ENDDATA", "CORD2R,4\nENDDATA"), "has no x axis"),
        ("m.bdf", "GRID,1,,0.,0.,0.,,,,,5\n", "line 1 has more than 8 fields"),
        ("m.rad", "#include x.rad\n", "includes another file"),
    ],
)
def test_a_bad_mesh_is_refused_in_one_sentence(tmp_path, name, text, words):
    with pytest.raises(GeomdrapError) as error:
        written(tmp_path, name, text)
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_a_missing_mesh_is_named(tmp_path):
    with pytest.raises(GeomdrapError, match=r"nowhere\.inp cannot be read"):
        read_fe_mesh(tmp_path / "nowhere.inp")


def test_parts_without_shells_may_use_the_same_numbers(tmp_path):
    block = abaqus(POINTS + [0, 0, 500.0], QUADS).replace("S4R", "C3D4")
    mesh = written(tmp_path, "m.inp", f"*PART, NAME=SHELL\n{GOOD_INP}*END PART\n*PART, NAME=BLOCK\n{block}*END PART\n")
    np.testing.assert_allclose(mesh.points, POINTS, atol=1e-6)


@pytest.mark.parametrize("opening", ["*END PART\n", "*ASSEMBLY, NAME=A\n", "*END INSTANCE\n"])
def test_the_reference_points_of_an_assembly_move_no_node_of_the_part_before_it(tmp_path, opening):
    assembly = f"{opening}*NODE\n1001, 9., 9., 900.\n*END ASSEMBLY\n"
    mesh = written(tmp_path, "m.inp", f"*PART, NAME=SHELL\n{GOOD_INP}{assembly}")
    np.testing.assert_allclose(mesh.points, POINTS, atol=1e-6)


@pytest.mark.parametrize(
    ("name", "text", "kinds"),
    [
        ("m.inp", GOOD_INP + "*ELEMENT, TYPE=C3D4\n9, 1001, 1002, 1003, 1004\n", ("C3D4",)),
        ("m.bdf", GOOD_BDF.replace("ENDDATA", "CTETRA,9,1,1001,1002,1003,1004\nENDDATA"), ("CTETRA",)),
        ("m.rad", radioss(POINTS, QUADS).replace("/END", "/BRICK/1\n/TETRA4/2\n/END"), ("BRICK", "TETRA4")),
        ("m.rad", radioss(POINTS, QUADS), ()),
    ],
)
def test_elements_that_are_no_shells_are_left_out_and_named(flat, tmp_path, name, text, kinds):
    mesh = written(tmp_path, name, text)
    assert mesh.others == kinds
    assert len(mesh.element_ids) == len(QUADS)
    notes = map_onto(flat, mesh).notes()
    assert [note for note in notes if "no shells" in note] == [
        f"{name} has elements that are no shells ({', '.join(kinds)}), which carry no ply" for _ in kinds[:1]
    ]
