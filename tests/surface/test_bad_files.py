import os
import struct

import meshio
import numpy as np
import pytest
import trimesh
from raw_meshes import box, bumpy

from geomdrap.errors import SurfaceError
from geomdrap.surface import read_surface
from geomdrap.surface.formats import READERS

JUNK = np.random.default_rng(0).integers(0, 256, 5000, dtype=np.uint8).tobytes()


def refusal(path, **options):
    """The message, which is one line that names the file."""
    with pytest.raises(SurfaceError) as caught:
        read_surface(path, **options)
    message = str(caught.value)
    assert path.name in message
    assert "\n" not in message
    assert len(message) < 300
    return message


def exported(kind, mesh=None):
    data = trimesh.Trimesh(*(mesh or box()), process=False).export(file_type=kind)
    return data if isinstance(data, bytes) else data.encode()


def test_a_missing_file_is_named(tmp_path):
    assert "does not exist" in refusal(tmp_path / "part.stl")


def test_a_folder_is_no_part(tmp_path):
    (tmp_path / "part.stl").mkdir()
    assert "is a folder" in refusal(tmp_path / "part.stl")


def test_a_file_without_permission_is_said(tmp_path, monkeypatch):
    path = tmp_path / "part.stl"
    path.write_bytes(exported("stl"))
    path.chmod(0)
    if os.access(path, os.R_OK):  # root may read everything

        def refuse(*args, **kwargs):
            raise PermissionError(13, "Permission denied")

        monkeypatch.setattr("pathlib.Path.open", refuse)
    assert "may not be read" in refusal(path)


@pytest.mark.parametrize("ending", sorted(READERS))
@pytest.mark.parametrize("content", [b"", JUNK, b"this is no mesh\n" * 40, b"\0" * 500, b"\n"])
def test_files_that_are_no_mesh_are_refused_in_every_format(tmp_path, ending, content):
    path = tmp_path / f"part{ending}"
    path.write_bytes(content)
    message = refusal(path)
    assert ("is empty" in message) == (content == b"")


@pytest.mark.parametrize("ending", [".msh", ".inp", ".bdf", ".vtk"])
def test_bytes_that_are_no_text_are_refused_without_words_of_the_reader(tmp_path, ending):
    (tmp_path / f"part{ending}").write_bytes(b"\xf2" + JUNK)
    message = refusal(tmp_path / f"part{ending}")
    assert "codec" not in message
    assert "neither text nor what its name says" in message


def test_a_face_with_a_vertex_that_is_not_there_is_said(tmp_path):
    (tmp_path / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
    assert "a face names a vertex that is not there" in refusal(tmp_path / "part.obj")


def test_a_name_without_an_ending_asks_for_one(tmp_path):
    (tmp_path / "part").write_bytes(exported("stl"))
    assert "must end with the file's format, one of .stl" in refusal(tmp_path / "part")


def test_an_unknown_ending_lists_the_known_ones(tmp_path):
    (tmp_path / "part.docx").write_bytes(JUNK)
    message = refusal(tmp_path / "part.docx")
    assert "'.docx'" in message
    assert all(ending in message for ending in READERS)


def test_an_unknown_unit_lists_the_known_ones(tmp_path):
    (tmp_path / "part.stl").write_bytes(exported("stl"))
    with pytest.raises(SurfaceError, match="use one of mm, cm, m, in"):
        read_surface(tmp_path / "part.stl", unit="furlong")


@pytest.mark.parametrize("kind", ["stl", "stl_ascii", "obj", "ply", "off", "glb", "vtu", "inp", "bdf"])
def test_files_cut_in_the_middle_are_refused(tmp_path, kind):
    path = tmp_path / f"part.{kind.split('_')[0]}"
    if kind in ("vtu", "inp", "bdf"):
        meshio.Mesh(box()[0], [("triangle", box()[1])]).write(path)
        data = path.read_bytes()
    else:
        data = exported(kind)
    cut = data.rindex(b" ") if kind == "obj" else int(0.8 * len(data))
    path.write_bytes(data[:cut])
    refusal(path)


def test_a_binary_stl_cut_off_says_how_much_is_missing(tmp_path):
    path = tmp_path / "part.stl"
    path.write_bytes(exported("stl", bumpy())[:-5000])
    assert "promises 288 facets, it holds 188" in refusal(path)


FACET = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex {} 0 0\nvertex 0 10 0\nendloop\nendfacet\n"


@pytest.mark.parametrize(
    ("broken", "words"),
    [
        (FACET.replace("vertex {} 0 0\n", ""), "facet 3 is broken"),
        (FACET.replace("vertex {} 0 0\n", "vertex 10 0\n"), "facet 3 is broken"),
        (FACET.replace("{}", "1O"), "facet 3 has '1o' where a number belongs"),
        (FACET.replace("{}", "nan"), "vertex 7 is not a point"),
        (FACET.replace("{}", "9" * 500), "facet 3 is broken"),
        (FACET.replace("endloop\n", ""), "facet 3 is broken"),
        (FACET.replace("vertex {} 0 0\n", "vertex 1 0 0\nvertex 2 0 0\n"), "facet 3 is broken"),
    ],
)
def test_a_broken_facet_of_an_ascii_stl_is_named(tmp_path, broken, words):
    path = tmp_path / "part.stl"
    path.write_text(f"solid x\n{FACET.format(10) * 2}{broken}{FACET.format(10)}endsolid x\n")
    assert words in refusal(path)


def test_an_ascii_stl_without_its_end_is_cut_off(tmp_path):
    path = tmp_path / "part.stl"
    path.write_text(f"solid x\n{FACET.format(10)}")
    assert "cut off" in refusal(path)


@pytest.mark.parametrize("text", ["solid x\nendsolid x\n", "solid\nendsolid\n"])
def test_an_stl_without_facets_is_refused(tmp_path, text):
    (tmp_path / "part.stl").write_text(text)
    assert "no triangles" in refusal(tmp_path / "part.stl")


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_points_that_are_not_finite_are_refused(tmp_path, value):
    data = bytearray(exported("stl"))
    data[84 + 50 + 12 : 84 + 50 + 16] = struct.pack("<f", value)
    (tmp_path / "part.stl").write_bytes(data)
    assert "vertex 3 is not a point" in refusal(tmp_path / "part.stl")


@pytest.mark.parametrize("ending", ["ply", "obj", "off", "glb"])
def test_points_alone_are_no_surface(tmp_path, ending):
    points = np.random.default_rng(0).random((20, 3))
    path = tmp_path / f"cloud.{ending}"
    if ending == "obj":
        path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in points))
    elif ending == "off":
        path.write_text("OFF\n20 0 0\n" + "".join(f"{x} {y} {z}\n" for x, y, z in points))
    else:
        cloud = trimesh.Scene(trimesh.PointCloud(points)) if ending == "glb" else trimesh.PointCloud(points)
        path.write_bytes(cloud.export(file_type=ending))
    assert "triangulated surface" in refusal(path) or ending == "off"


@pytest.mark.parametrize(
    ("cells", "words"),
    [
        ([("vertex", [[0], [1]])], "only points or lines"),
        ([("line", [[0, 1], [1, 2]])], "only points or lines"),
        ([("tetra", [[0, 1, 2, 4]])], r"only volume elements (tetra)"),
    ],
)
def test_meshes_without_shells_are_refused(tmp_path, cells, words):
    meshio.Mesh(box()[0], cells).write(tmp_path / "part.vtu")
    assert words in refusal(tmp_path / "part.vtu")


def test_an_obj_that_names_vertices_that_are_not_there_is_refused(tmp_path):
    (tmp_path / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
    refusal(tmp_path / "part.obj")


def test_a_part_without_area_is_refused(tmp_path):
    points = np.outer(np.arange(9.0), [1.0, 2.0, 3.0])
    (tmp_path / "part.stl").write_bytes(exported("stl", (points, np.arange(9).reshape(3, 3))))
    assert "no face has an area" in refusal(tmp_path / "part.stl")


def test_a_name_that_cannot_be_a_file_is_refused():
    with pytest.raises(SurfaceError):
        read_surface("part\0.stl")
    with pytest.raises(SurfaceError):
        read_surface("x" * 5000 + ".stl")
