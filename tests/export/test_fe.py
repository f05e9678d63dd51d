"""The hand-over to finite elements: the ply mapped onto a mesh, and each format read back."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from exact_nets import sphere_shear_at
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

import geomdrap as gd
from geomdrap.errors import GeomdrapError
from geomdrap.export import fe_abaqus, fe_acp, fe_nastran, fe_optistruct, fe_radioss
from geomdrap.export.fe_mesh import mesh_of_part
from geomdrap.export.fe_read import number, read_fe_mesh
from geomdrap.export.map_onto import map_onto
from geomdrap.surface import shapes

RADIUS, HEADING = 100.0, 25.0
WARP = np.array([np.cos(np.radians(HEADING)), np.sin(np.radians(HEADING)), 0.0])


@pytest.fixture(scope="module")
def flat():
    """A plane sheet, 200 × 160 mm, warp at 25°: every number is known."""
    return gd.evaluate(gd.drape(shapes.plane(200.0, 160.0, 8.0), (0, 0, 0), HEADING, 10.0, project=True))


@pytest.fixture(scope="module")
def cap():
    surface = shapes.sphere_cap(RADIUS, 50.0, 4.0)
    return gd.evaluate(gd.drape(surface, (0, 0, RADIUS), HEADING, 4.0, project=True))


def written(tmp_path, name, text):
    path = tmp_path / name
    path.write_text(text)
    return read_fe_mesh(path)


def out(module, ply, tmp_path, thickness=None):
    module.write(ply, tmp_path / "out", thickness)
    return (tmp_path / "out").read_text()


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


def test_on_a_plane_every_element_gets_the_heading(flat, tmp_path):
    points, quads = grid(6, 6, 120.0, turn=33.0)
    ply = map_onto(flat, written(tmp_path, "m.inp", abaqus(points, quads)))
    assert ply.is_draped.all()
    np.testing.assert_allclose(ply.warp, np.tile(WARP, (36, 1)), atol=1e-9)
    np.testing.assert_allclose(ply.shear, 0.0, atol=1e-6)
    np.testing.assert_allclose(ply.thickness, 1.0, atol=1e-9)
    turn = np.radians(-HEADING)
    there = points[quads].mean(axis=1)[:, :2] @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    np.testing.assert_allclose(ply.at, there, atol=1e-6)


def test_on_a_sphere_elements_get_the_exact_shear_and_directions_that_fit_it(cap, tmp_path):
    def height(x, y):
        return np.sqrt(RADIUS**2 - x**2 - y**2)

    points, quads = grid(20, 20, 90.0, turn=15.0, height=height)
    ply = map_onto(cap, written(tmp_path, "m.inp", abaqus(points, quads)))
    assert ply.is_draped.all()
    exact = sphere_shear_at(ply.at[:, 0], ply.at[:, 1], RADIUS)
    assert np.sqrt(np.mean((ply.shear - exact) ** 2)) < 0.06
    assert np.abs(ply.shear - exact).max() < 0.25
    assert np.abs(exact).max() > 10.0
    between = np.degrees(np.arcsin((ply.warp * ply.weft).sum(axis=1)))
    np.testing.assert_allclose(between, ply.shear, atol=0.2)
    there = cap.net.interpolate(*ply.at.T)[0]
    assert np.nanmax(np.linalg.norm(there - ply.mesh.centers, axis=1)) < 0.6  # chords of 4.5 mm quads and 4 mm cells
    np.testing.assert_allclose(np.linalg.norm(ply.warp, axis=1), 1.0)
    np.testing.assert_allclose((ply.warp * ply.mesh.normals).sum(axis=1), 0.0, atol=1e-9)


def test_the_error_falls_at_least_with_the_size_of_the_facets(tmp_path):
    def rms(edge):
        surface = shapes.sphere_cap(RADIUS, 50.0, edge)
        result = gd.evaluate(gd.drape(surface, (0, 0, RADIUS), HEADING, edge, project=True))
        points, quads = grid(20, 20, 90.0, turn=15.0, height=lambda x, y: np.sqrt(RADIUS**2 - x**2 - y**2))
        ply = map_onto(result, written(tmp_path, "m.inp", abaqus(points, quads)))
        return np.sqrt(np.mean((ply.shear - sphere_shear_at(ply.at[:, 0], ply.at[:, 1], RADIUS)) ** 2))

    assert rms(12.0) / rms(4.0) > 2.7


def test_abaqus_axes_are_yarn_and_element_normal_per_element(cap, tmp_path):
    points, quads = grid(8, 8, 90.0, height=lambda x, y: np.sqrt(RADIUS**2 - x**2 - y**2))
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
    ply = map_onto(cap, mesh_of_part(part))
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


def nastran_theta(text):
    """{element: (name, fields)} of the shells in small fields."""
    cards = [fixed_fields(line) for line in text.splitlines() if line.startswith(("CQUAD4", "CTRIA3"))]
    return {int(card[1]): card for card in cards}


def test_nastran_theta_turns_side_12_into_the_warp_about_the_normal(cap, tmp_path):
    points, quads = grid(8, 8, 90.0, turn=40.0, height=lambda x, y: np.sqrt(RADIUS**2 - x**2 - y**2))
    ply = map_onto(cap, written(tmp_path, "m.bdf", nastran(points, quads, theta="12.5")))
    cards = nastran_theta(out(fe_nastran, ply, tmp_path))
    theta = np.array([float(cards[n][7]) for n in ply.mesh.element_ids.tolist()])
    _, normal, _ = corners_normal_side(points, quads)
    side = ply.mesh.sides
    np.testing.assert_allclose(turned(side, normal, theta), ply.warp, atol=2e-5)
    assert theta[::3].mean() != pytest.approx(theta[1::3].mean(), abs=20.0), "turned elements have other angles"


def test_on_a_plane_nastran_theta_is_what_a_protractor_says(flat, tmp_path):
    points, quads = grid(3, 3, 90.0, turn=40.0)
    cards = nastran_theta(out(fe_nastran, map_onto(flat, written(tmp_path, "m.bdf", nastran(points, quads))), tmp_path))
    # as made, side 1-2 lies at 40° and the normal up: the warp at 25° is 15° clockwise
    assert float(cards[502][7]) == pytest.approx(HEADING - 40.0, abs=1e-3)
    # turned over, side 1-2 lies at 40° (from the fourth corner to the third), and clockwise is counter-clockwise
    assert float(cards[501][7]) == pytest.approx(-(HEADING - 40.0), abs=1e-3)


def test_the_nastran_deck_is_the_same_but_for_theta(flat, tmp_path):
    points, quads = grid(3, 3, 90.0)
    before = nastran(points, quads, theta="5.")
    after = out(fe_nastran, map_onto(flat, written(tmp_path, "m.bdf", before)), tmp_path)
    old = [line for line in before.splitlines() if not line.startswith("CQUAD4")]
    new = [line for line in after.splitlines() if not line.startswith(("CQUAD4", "$ "))]
    assert new == [line for line in old if not line.startswith("$ ")]
    for element, card in nastran_theta(after).items():
        was = nastran_theta(before)[element]
        assert card[:7] == was[:7]
        assert float(card[8]) == float(was[8]), "the offset stays"


def test_free_fields_continuations_and_second_order_shells_keep_what_they_had(flat, tmp_path):
    deck = """BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,30.,0.,0.
GRID,3,,30.,30.,0.
GRID,4,0,0.,3.+1,0.
GRID,5,,15.,0.,0.
GRID,6,,30.,15.,0.
GRID,7,,15.,30.,0.
GRID,8,,0.,15.,0.
GRID,9,,-3.0E1,0.,0.
CQUAD8,11,7,1,2,3,4,5,6
,7,8,1.1,1.2,1.3,1.4,90.,0.5
CTRIA3*               12               7               1               4
*                      9
ENDDATA
"""
    ply = map_onto(flat, written(tmp_path, "m.bdf", deck))
    text = out(fe_nastran, ply, tmp_path)
    lines = text.splitlines()
    quad = next(k for k, line in enumerate(lines) if line.startswith("CQUAD8"))
    fields = fixed_fields(lines[quad])[1:] + fixed_fields(lines[quad + 1])[1:]
    assert fields[:14] == ["11", "7", *"12345678", "1.1", "1.2", "1.3", "1.4"]
    assert float(fields[14]) == pytest.approx(HEADING, abs=1e-3)
    assert fields[15] == "0.5"
    triangle = fixed_fields(next(line for line in lines if line.startswith("CTRIA3")))
    assert triangle[:6] == ["CTRIA3", "12", "7", "1", "4", "9"]
    assert float(triangle[6]) == pytest.approx(HEADING - 90.0, abs=1e-3)  # side 1-2 is +y, the normal up
    assert read_fe_mesh_of(tmp_path, text).material_angle == pytest.approx([HEADING, HEADING - 90.0], abs=1e-3)


def read_fe_mesh_of(tmp_path, text):
    (tmp_path / "again.bdf").write_text(text)
    return read_fe_mesh(tmp_path / "again.bdf")


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
    points, quads = grid(8, 8, 90.0, height=lambda x, y: np.sqrt(RADIUS**2 - x**2 - y**2))
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


def test_triangles_are_sh3n_in_radioss(flat, tmp_path):
    lines = out(fe_radioss, map_onto(flat, mesh_of_part(flat.net.surface)), tmp_path).splitlines()
    rows = [line for line in lines if not line.startswith(("#", "/", "Ply"))]
    assert {line[:10] for line in rows} == {"SH3N      "}
    assert len(rows) == len(flat.net.surface.triangles)


def test_the_acp_table_has_place_directions_and_scalars(cap, tmp_path):
    points, quads = grid(6, 6, 90.0, height=lambda x, y: np.sqrt(RADIUS**2 - x**2 - y**2))
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


def test_elements_beside_above_and_across_the_part_have_no_ply(flat, tmp_path):
    points, quads = grid(10, 10, 300.0)
    mesh = written(tmp_path, "m.bdf", nastran(points, quads, theta="77."))
    ply = map_onto(flat, mesh)
    x, y = np.abs(mesh.centers[:, 0]), np.abs(mesh.centers[:, 1])
    np.testing.assert_array_equal(ply.is_draped, (x < 110.0) & (y < 90.0))  # a pitch beyond the rim, 10 mm, is near
    assert "of 100 elements of m.bdf have no ply" in ply.notes()[0]
    cards = nastran_theta(out(fe_nastran, ply, tmp_path))
    kept = [n for n, card in cards.items() if card[7] == "77."]
    assert kept == mesh.element_ids[~ply.is_draped].tolist(), "theirs stays as it was"
    above = written(tmp_path, "m.inp", abaqus(points + [0, 0, 11.0], quads))
    with pytest.raises(GeomdrapError, match=r"no element of m\.inp lies on the draped part"):
        map_onto(flat, above)
    upright = written(tmp_path, "m.inp", abaqus(points[:, [0, 2, 1]], quads))
    with pytest.raises(GeomdrapError, match="same part, in mm and in the same place"):
        map_onto(flat, upright)


def test_a_mesh_much_smaller_than_the_part_is_doubted_and_a_tiny_one_refused(flat, tmp_path):
    for size, words in ((30.0, "is it in mm?"), (8.0, "write the mesh in mm")):
        mesh = written(tmp_path, "m.inp", abaqus(*grid(2, 2, size)))
        if size > 20.0:
            assert words in map_onto(flat, mesh).notes()[0]
        else:
            with pytest.raises(GeomdrapError, match=words):
                map_onto(flat, mesh)


def test_beyond_the_blank_there_is_no_ply(tmp_path):
    net = gd.drape(shapes.plane(200.0, 160.0, 8.0), (0, 0, 0), 0.0, 10.0, (50.0, 30.0), project=True)
    points, quads = grid(10, 10, 150.0)
    ply = map_onto(gd.evaluate(net), written(tmp_path, "m.inp", abaqus(points, quads)))
    inside = (np.abs(ply.mesh.centers[:, 0]) <= 50.0) & (np.abs(ply.mesh.centers[:, 1]) <= 30.0)
    np.testing.assert_array_equal(ply.is_draped, inside)


POINTS, QUADS = grid(2, 2, 60.0)
GOOD_INP, GOOD_BDF = abaqus(POINTS, QUADS), nastran(POINTS, QUADS)


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


def test_numbers_too_long_for_a_field_are_refused(flat, tmp_path):
    ply = map_onto(flat, written(tmp_path, "m.inp", abaqus(POINTS, QUADS, first_element=100_000_000)))
    for module in (fe_nastran, fe_optistruct):
        with pytest.raises(GeomdrapError, match="100000003 does not fit into the 8 columns"):
            module.write(ply, tmp_path / "out")


def large_field_triangle(part="7", zoffset="0.5"):
    """A deck with one triangle in large fields, which hold sixteen characters."""
    nodes = "GRID,1,,0.,0.,0.\nGRID,2,,30.,0.,0.\nGRID,3,,30.,30.,0.\n"
    return f"{nodes}{'CTRIA3*':<8}{11:>16}{part:>16}{1:>16}{2:>16}\n{'*':<8}{3:>16}{'':>16}{zoffset:>16}\n"


def test_a_long_real_without_an_e_is_shortened_as_the_number_that_it_is(flat, tmp_path):
    ply = map_onto(flat, written(tmp_path, "m.bdf", large_field_triangle(zoffset="1.2345678-3")))
    (fields,) = nastran_theta(out(fe_nastran, ply, tmp_path)).values()
    assert number(fields[7], "", 0) == pytest.approx(1.2345678e-3, abs=5e-8)  # five digits


def test_a_property_too_long_for_a_field_is_refused(flat, tmp_path):
    ply = map_onto(flat, written(tmp_path, "m.bdf", large_field_triangle(part="123456789")))
    with pytest.raises(GeomdrapError, match=r"m\.bdf: number 123456789 does not fit into the 8 columns"):
        fe_nastran.write(ply, tmp_path / "out")


def test_a_long_word_that_is_no_number_is_refused_with_its_line(flat, tmp_path):
    ply = map_onto(flat, written(tmp_path, "m.bdf", large_field_triangle(zoffset="1.2345678x")))
    with pytest.raises(GeomdrapError, match=r"m\.bdf, line 4: '1\.2345678x' is not a number"):
        fe_nastran.write(ply, tmp_path / "out")


@pytest.mark.parametrize("value", [0.0, 1.0, -474.892456, 0.000123456, -0.5, 12345678.9, -1.5e-7, 3e10, 99999.5])
def test_reals_fit_into_eight_columns_and_come_back(value):
    from geomdrap.export.fe_nastran import real

    text = real(value)
    assert len(text) <= 8
    assert "." in text
    assert number(text, "", 0) == pytest.approx(value, rel=6e-4)
