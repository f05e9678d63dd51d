"""Measured tables as people and instruments write them."""

from __future__ import annotations

import numpy as np
import pytest

import geomdrap as gd


@pytest.fixture
def table(tmp_path):
    def write(content, name="points.csv"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


def test_a_plain_table_is_read_with_its_line_numbers(table):
    m = gd.read_measurement(table("# photogrammetry\nx,y,z,u,v,shear\n1,2,3,4,5,6\n\n-1,-2,-3,-4,-5,\n"))
    np.testing.assert_array_equal(m.points, [[1, 2, 3], [-1, -2, -3]])
    np.testing.assert_array_equal(m.u, [4, -4])
    np.testing.assert_array_equal(m.shear, [6, np.nan])
    np.testing.assert_array_equal(m.row, [3, 5])
    assert m.source == "points.csv"
    assert m.warp is None
    assert m.replicate is None


@pytest.mark.parametrize(
    "content",
    [
        "x,y,z\n1.5,2,-3\n",
        "x;y;z\n1,5;2;-3\n",
        "x\ty\tz\n1,5\t2\t-3\n",
        "\ufeffX, Y ,Z\r\n1.5, 2,-3\r\n",
        "x [mm];y [mm];z (mm)\n1.5;2;−3\n",
        "x,y,z,\n1.5,2,-3,\n",
        '"x","y","z"\n"1.5","2","-3"\n',
        "x,y,z\r1.5,2,-3\r",
        "x,y,z\n1.5,2,-3\n".encode("utf-16"),
        "# Gerät: Kamera\nx,y,z\n1.5,2,-3\n".encode("latin-1"),
    ],
)
def test_separators_decimal_commas_case_quotes_and_encodings_make_no_difference(table, content):
    np.testing.assert_array_equal(gd.read_measurement(table(content)).points, [[1.5, 2.0, -3.0]])


def test_what_people_write_where_nothing_was_measured_is_an_open_cell_and_degrees_may_have_their_sign(table):
    rows = ["1,2,3,25°", "1,2,3,-", "1,2,3,n/a", "1,2,3,–", "1,2,3,N/A", "-,-,-,5", "1,2,3,-7.5 °"]
    m = gd.read_measurement(table("x,y,z,shear [deg]\n" + "\n".join(rows) + "\n"))
    np.testing.assert_array_equal(m.shear, [25.0, *4 * [np.nan], -7.5])
    assert any("1 rows have no position" in note for note in m.notes)


def test_a_spacing_that_is_not_used_as_there_are_labels_is_said(table):
    path = table("x,y,z,u,v\n1,2,3,4,5\n")
    assert gd.read_measurement(path).notes == ()
    assert "--mark-spacing) is not used, as the table has u and v" in gd.read_measurement(path, mark_spacing=(16.0, 16.0)).notes[0]


@pytest.mark.parametrize(("unit", "factor"), [("mm", 1.0), ("cm", 10.0), ("m", 1000.0), ("in", 25.4)])
def test_all_lengths_are_in_the_unit_given(table, unit, factor):
    m = gd.read_measurement(table("x,y,z,u,v,sigma_xyz,shear,sigma_shear\n1,2,3,4,5,6,7,8\n"), unit=unit)
    np.testing.assert_allclose([*m.points[0], m.u[0], m.v[0], m.sigma_xyz[0]], factor * np.arange(1.0, 7.0))
    assert (m.shear[0], m.sigma_shear[0]) == (7.0, 8.0)


def test_columns_are_mapped_by_name_and_what_is_not_used_is_said(table):
    path = table("Id;PX;PY;PZ;Gamma\n1;1;2;3;4\n")
    m = gd.read_measurement(path, columns={"x": "px", "y": "PY", "z": "PZ", "shear": "Gamma"})
    np.testing.assert_array_equal([*m.points[0], m.shear[0]], [1, 2, 3, 4])
    assert any("Id" in note for note in m.notes)


def test_numbers_of_marks_become_fabric_coordinates(table):
    path = table("index_x,index_y,x,y,z\n3,1,0,0,0\n4,3,1,1,0\n")
    m = gd.read_measurement(
        path, columns={"i": "index_x", "j": "index_y"}, mark_spacing=(10.0, 5.0), mark_origin=(3.0, 1.0)
    )
    np.testing.assert_array_equal(np.stack([m.u, m.v]), [[0, 10], [0, 10]])


def test_fibre_directions_become_unit_vectors_and_may_be_open(table):
    m = gd.read_measurement(table("x,y,z,warp_x,warp_y,warp_z\n0,0,0,3,0,4\n1,0,0,,,\n"))
    np.testing.assert_allclose(m.warp, [[0.6, 0, 0.8], [np.nan] * 3])


def test_marks_that_were_lost_are_left_out_and_counted(table):
    m = gd.read_measurement(table("u,v,x,y,z\n0,0,1,2,3\n1,0,,,\n2,0,,,\n"))
    assert len(m) == 1
    assert "2 rows have no position" in " ".join(m.notes)
    assert "line 3" in " ".join(m.notes)


def test_the_nodes_of_a_drape_can_be_read_as_a_measurement(tmp_path):
    from geomdrap.export import table as nodes
    from geomdrap.surface import shapes

    net = gd.drape(shapes.plane(100.0, 80.0, 10.0), "centroid", 30.0, 10.0)
    nodes.write(gd.evaluate(net), tmp_path / "nodes.csv")
    m = gd.read_measurement(tmp_path / "nodes.csv")
    assert len(m) == np.isfinite(net.points[..., 0]).sum()


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", ["points.csv", "empty"]),
        ("# nothing\n\n", ["points.csv", "empty"]),
        ("x,y,z\n", ["points.csv", "no rows"]),
        ("x,y,z\n,,\n", ["points.csv", "no rows"]),
        ("1,2,3\n4,5,6\n", ["line 1", "header is missing"]),
        ("x y z\n1 2 3\n", ["line 1", "commas, semicolons or tabs"]),
        ("x,y\n1,2\n", ["no column z", "x, y", "--columns"]),
        ("a,b,c\n1,2,3\n", ["no column x", "a, b, c"]),
        ("x,y,z,u\n1,2,3,4\n", ["no column v"]),
        ("x,y,z,warp_x,warp_y\n1,2,3,4,5\n", ["no column warp_z"]),
        ("x,y,z\n1,2,3\n1,two,3\n", ["line 3", "'y'", "'two' is not a number"]),
        ("x,y,z\n1,2,nan\n", ["line 2", "'z'"]),
        ("x,y,z\n1,2,\n", ["line 2", "'z'"]),
        ("x,y,z\n1,inf,3\n", ["line 2", "'y'", "not finite"]),
        ("x,y,z\n1,1_000,3\n", ["line 2", "'y'", "not a number"]),
        ("x,y,z,shear\n1,2,3,inf\n", ["line 2", "'shear'", "not finite"]),
        ("x,y,z,shear\n1,2,3,145\n", ["line 2", "'shear'", "-90 and 90 degrees"]),
        ("x,y,z,shear\n1,2,3,84\n1,2,3,91\n", ["line 3", "the angle between warp and weft, give 90 less it"]),
        ("x,y,z\n1,2,3\n1,2\n", ["line 3", "2 cells", "3 columns"]),
        ("x,y,z\n1,2,3,4\n", ["line 2", "4 cells"]),
        ("x,y,z,X\n1,2,3,4\n", None),
        ("x,y,z,z\n1,2,3,4\n", ["twice", "'z'", "columns 3 and 4"]),
        ("X,Y,Z,z [mm],Z (mm)\n1,2,3,4,5\n", ["twice"]),
        ("x,y,z,sigma_xyz\n1,2,3,0\n", ["line 2", "'sigma_xyz'", "above 0"]),
        ("x,y,z,sigma_shear\n1,2,3,-1\n", ["line 2", "'sigma_shear'", "above 0"]),
        ("x,y,z,replicate\n1,2,3,1.5\n", ["line 2", "'replicate'", "whole number"]),
        ("x,y,z,warp_x,warp_y,warp_z\n1,2,3,0,0,0\n", ["line 2", "warp_x", "no direction"]),
        ("x,y,z,weft_x,weft_y,weft_z\n1,2,3,1,,0\n", ["line 2", "weft_x", "all three"]),
        ("x [m],y [m],z [m]\n1,2,3\n", ["'x [m]'", "--unit-measured m"]),
        ("x,y,z,shear [rad]\n1,2,3,0.5\n", ["'shear [rad]'", "says rad", "degrees"]),
        ("x,y,z,shear,sigma_shear (rad)\n1,2,3,5,0.1\n", ["'sigma_shear (rad)'", "degrees"]),
        ("x,y,z\n1,-,3\n", ["line 2", "'y'", "there is no number"]),
        ("x,y,z\n1,25°,3\n", ["line 2", "'y'", "'25°' is not a number"]),
        (b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", ["points.csv", "not a text table"]),
        (b"\x00" * 100, ["points.csv", "not a text table"]),
    ],
)
def test_what_is_wrong_is_said_in_one_sentence_with_file_line_and_column(table, content, words):
    path = table(content)
    if words is None:  # an exact name goes before the same in capitals
        assert gd.read_measurement(path).points[0, 0] == 1
        return
    with pytest.raises(gd.MeasurementError) as error:
        gd.read_measurement(path)
    text = str(error.value)
    assert "\n" not in text
    assert "points.csv" in text
    for word in words:
        assert word in text


@pytest.mark.parametrize(
    ("options", "word"),
    [
        ({"columns": {"gamma": "shear"}}, "'gamma' is not a quantity"),
        ({"columns": {"shear": "Gamma"}}, "no column 'Gamma'"),
        ({"unit": "km"}, "'km' is not a unit"),
        ({"mark_spacing": (10.0, 10.0)}, "no columns i and j"),
    ],
)
def test_options_that_do_not_fit_are_refused_by_name(table, options, word):
    with pytest.raises(gd.MeasurementError, match=word):
        gd.read_measurement(table("x,y,z,shear\n1,2,3,4\n"), **options)


def test_folders_and_missing_files_are_named(tmp_path):
    with pytest.raises(gd.MeasurementError, match="is a folder"):
        gd.read_measurement(tmp_path)
    with pytest.raises(gd.MeasurementError, match="no file"):
        gd.read_measurement(tmp_path / "missing.csv")
