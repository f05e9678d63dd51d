import subprocess
import sys

import meshio
import numpy as np
import pytest
import trimesh
from cad_files import iges_rectangle, step_rectangle
from raw_meshes import box, bumpy, grid, soup

from geomdrap.errors import SurfaceError
from geomdrap.surface import Surface, read_surface


def corners_of(surface):
    return surface.points[surface.triangles]


def write_with_trimesh(path, points, triangles, kind):
    mesh = trimesh.Trimesh(points, triangles, process=False)
    data = mesh.export(file_type=kind)
    path.write_bytes(data if isinstance(data, bytes) else data.encode())


@pytest.mark.parametrize(
    ("ending", "kind", "digits"),
    [
        ("stl", "stl", 1e-7), ("stl", "stl_ascii", 1e-7), ("STL", "stl", 1e-7), ("obj", "obj", 1e-7),
        ("ply", "ply", 1e-7), ("off", "off", 1e-7), ("glb", "glb", 1e-7),
    ],
)  # fmt: skip
def test_surface_formats_come_back_as_they_were(tmp_path, ending, kind, digits):
    points, triangles = bumpy()
    write_with_trimesh(tmp_path / f"part.{ending}", points, triangles, kind)
    surface = read_surface(tmp_path / f"part.{ending}")
    assert surface.source == f"part.{ending}"
    assert np.allclose(corners_of(surface), points[triangles], rtol=0, atol=digits * 200)
    assert len(surface.points) == len(points)


@pytest.mark.parametrize("ending", ["obj", "ply", "off", "vtu", "vtk", "msh", "inp", "bdf"])
def test_vertex_numbers_are_those_of_the_file(tmp_path, ending):
    points, triangles = bumpy(4)
    points = points.round(6)  # meshio cannot write longer negative numbers to Nastran
    path = tmp_path / f"part.{ending}"
    if ending in ("obj", "ply", "off"):
        write_with_trimesh(path, points, triangles, ending)
    else:
        meshio.Mesh(points, [("triangle", triangles)]).write(path, {"msh": "gmsh"}.get(ending))
    surface = read_surface(path)
    assert len(surface.vertex_of_input) == len(points)
    assert np.allclose(surface.points[surface.vertex_of_input], points, atol=2e-5)


@pytest.mark.parametrize("ending", ["vtu", "vtk", "msh", "inp", "bdf", "nas"])
def test_element_formats_come_back_as_they_were(tmp_path, ending):
    points, triangles = bumpy()
    points = points.round(6)  # meshio cannot write longer negative numbers to Nastran
    before = points.copy()
    meshio.Mesh(points, [("triangle", triangles)]).write(
        tmp_path / f"part.{ending}", {"msh": "gmsh", "nas": "nastran"}.get(ending)
    )
    surface = read_surface(tmp_path / f"part.{ending}")
    assert np.allclose(corners_of(surface), points[triangles], rtol=0, atol=1e-4)
    assert np.array_equal(points, before)


def test_quads_are_split_along_the_shorter_diagonal_and_keep_their_number(tmp_path):
    points = np.array([[0, 0, 0], [10, 0, 0], [14, 10, 0], [4, 10, 0], [20, 0, 0], [24, 10, 0]], float)
    blocks = [("quad", [[0, 1, 2, 3], [1, 4, 5, 2]]), ("line", [[0, 1]])]
    meshio.Mesh(points, blocks).write(tmp_path / "part.vtu")
    surface = read_surface(tmp_path / "part.vtu")
    assert sorted(map(sorted, surface.triangles.tolist())) == [[0, 1, 3], [1, 2, 3], [1, 2, 4], [2, 4, 5]]
    assert surface.source_face.tolist() == [0, 0, 1, 1]
    assert surface.area == pytest.approx(200.0)
    assert surface.findings.notes == ("2 quads split into triangles",)


def test_a_quad_with_a_corner_pushed_in_is_split_from_that_corner(tmp_path):
    points = np.array([[0, 0, 0], [30, 5, 0], [20, 0, 0], [30, -5, 0]], float)  # the inner diagonal is longer
    for i in range(4):
        quad = np.roll([0, 1, 2, 3], i)[None]
        meshio.Mesh(points, [("quad", quad)]).write(tmp_path / "part.vtu")
        assert read_surface(tmp_path / "part.vtu").area == pytest.approx(100.0)


def test_second_order_and_mixed_elements_are_merged(tmp_path):
    points, triangles = grid(2)
    points = np.vstack([points, points[[0, 3, 4]] + [1.0, 1.0, 0.0], [[200.0, 0, 0], [200.0, 100.0, 0]]])
    six = np.concatenate([triangles[0], [9, 10, 11]])[None]
    blocks = [("triangle6", six), ("triangle", triangles[1:]), ("quad", [[6, 12, 13, 8]])]
    meshio.Mesh(points, blocks).write(tmp_path / "part.vtu")
    surface = read_surface(tmp_path / "part.vtu")
    assert surface.area == pytest.approx(20000.0)
    assert surface.source_face.tolist() == [*range(8), 8, 8]
    assert "1 second-order elements taken by their corners" in surface.findings.notes


def test_shells_beside_volume_elements_are_taken_and_the_rest_is_said(tmp_path):
    points, triangles = box()
    blocks = [("triangle", triangles), ("tetra", [[0, 1, 2, 4]])]
    meshio.Mesh(points, blocks).write(tmp_path / "part.vtu")
    surface = read_surface(tmp_path / "part.vtu")
    assert surface.closed
    assert surface.findings.notes == ("1 volume elements left out: only the shells are the tool",)


def test_polygons_of_an_obj_are_split(tmp_path):
    text = "# été\nv 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 5 15 0\nf 1/1 2/1 \\\n 3/1 4/1\nf 4 3 5\n"
    (tmp_path / "part.obj").write_bytes(text.encode("latin-1"))
    assert read_surface(tmp_path / "part.obj").area == pytest.approx(125.0)


def test_meshes_of_a_scene_are_put_in_their_places(tmp_path):
    scene = trimesh.Scene()
    mesh = trimesh.Trimesh(*bumpy(3), process=False)
    scene.add_geometry(mesh, transform=trimesh.transformations.translation_matrix([0, 0, 500]))
    scene.add_geometry(mesh, transform=np.diag([-1.0, 1.0, 1.0, 1.0]))
    (tmp_path / "part.glb").write_bytes(scene.export(file_type="glb"))
    surface = read_surface(tmp_path / "part.glb")
    assert np.allclose(surface.bounds[:, 0], [-100, 100], atol=1e-4)
    assert surface.bounds[1, 2] > 500
    assert (surface.normals[:, 2] > 0).all()


@pytest.mark.parametrize(("unit", "scale"), [("mm", 1.0), ("cm", 10.0), ("m", 1000.0), ("in", 25.4)])
def test_units_scale_to_mm(tmp_path, unit, scale):
    points, triangles = bumpy(4)
    meshio.Mesh(points / scale, [("triangle", triangles)]).write(tmp_path / "part.vtu")
    surface = read_surface(tmp_path / "part.vtu", unit=unit)
    assert np.allclose(surface.points, points, rtol=1e-14, atol=1e-13)


@pytest.mark.parametrize(("unit", "scale"), [("in", 25.4), ("cm", 100.0)])
@pytest.mark.parametrize("ending", ["vtu", "stl"])
def test_a_part_in_mm_that_is_read_in_another_unit_is_pointed_out(tmp_path, unit, scale, ending):
    points, triangles = bumpy(4)
    path = tmp_path / f"part.{ending}"
    meshio.Mesh(points * scale / 25.4, [("triangle", triangles)]).write(path)
    surface = read_surface(path, unit=unit, flip=True)
    assert f"read with --unit {unit} the part is {surface.diagonal / 1000:.3g} m across" in surface.findings.unit_hint
    assert "is the file in mm already?" in surface.findings.lines()[0]
    assert read_surface(path).findings.unit_hint == ""


def test_a_part_in_metres_is_the_same_as_in_mm(tmp_path):
    points, triangles = soup(*bumpy())
    meshio.Mesh(points, [("triangle", triangles)]).write(tmp_path / "mm.vtu")
    meshio.Mesh(points / 1000, [("triangle", triangles)]).write(tmp_path / "m.vtu")
    in_mm, in_m = read_surface(tmp_path / "mm.vtu"), read_surface(tmp_path / "m.vtu", unit="m")
    assert np.array_equal(in_mm.triangles, in_m.triangles)
    assert np.allclose(in_mm.points, in_m.points, rtol=0, atol=1e-9 * in_mm.diagonal)
    assert np.allclose(in_mm.unfolded, in_m.unfolded, rtol=0, atol=1e-9 * in_mm.diagonal)
    assert in_m.findings.unit_hint == ""


def test_flip_turns_the_normals(tmp_path):
    write_with_trimesh(tmp_path / "part.stl", *bumpy(), "stl")
    assert (read_surface(tmp_path / "part.stl", flip=True).normals[:, 2] < 0).all()


def test_bytes_after_the_last_facet_of_an_stl_are_said(tmp_path):
    write_with_trimesh(tmp_path / "part.stl", *bumpy(), "stl")
    with (tmp_path / "part.stl").open("ab") as file:
        file.write(b"colours")
    surface = read_surface(tmp_path / "part.stl")
    assert len(surface.triangles) == 288
    assert surface.findings.notes == ("7 bytes after the last facet were ignored",)


def test_a_binary_stl_whose_header_begins_with_solid_is_read_as_binary(tmp_path):
    write_with_trimesh(tmp_path / "part.stl", *bumpy(), "stl")
    data = (tmp_path / "part.stl").read_bytes()
    (tmp_path / "part.stl").write_bytes(b"solid facet".ljust(80) + data[80:])
    assert len(read_surface(tmp_path / "part.stl").triangles) == 288


def test_ascii_stl_with_many_solids_capitals_and_any_line_ends(tmp_path):
    facet = "FACET NORMAL 0 0 1\r\nOUTER LOOP\r\nVERTEX {0} 0 0\r\nVERTEX {1} 0 0\r\nVERTEX {0} 1.E+1 0\r\n"
    facet += "ENDLOOP\r\nENDFACET\r\n"
    text = f"solid facet of vertex\r\n{facet.format(0, 10)}endsolid facet\r\n\r\n"
    text += f"SOLID\r\n{facet.format(20, 30)}ENDSOLID\r\n"
    (tmp_path / "part.stl").write_bytes(text.encode())
    surface = read_surface(tmp_path / "part.stl")
    assert surface.area == pytest.approx(100.0)
    assert surface.n_components == 2


cascadio = pytest.mark.skipif(
    __import__("importlib.util").util.find_spec("cascadio") is None, reason="needs the cad extra"
)


@cascadio
@pytest.mark.parametrize("unit", ["mm", "m"])
def test_step_files_come_in_mm_whatever_their_unit(tmp_path, unit):
    scale = {"mm": 1.0, "m": 1000.0}[unit]
    (tmp_path / "part.step").write_text(step_rectangle(300 / scale, 200 / scale, unit))
    surface = read_surface(tmp_path / "part.step")
    assert np.allclose(surface.bounds, [[0, 0, 0], [300, 200, 0]], atol=1e-4)


@cascadio
@pytest.mark.parametrize(("unit", "scale"), [("mm", 1.0), ("in", 25.4), ("m", 1000.0)])
def test_iges_files_come_in_mm_whatever_their_unit(tmp_path, unit, scale):
    (tmp_path / "part.igs").write_text(iges_rectangle(300 / scale, 200 / scale, unit))
    surface = read_surface(tmp_path / "part.igs")
    assert np.allclose(surface.bounds, [[0, 0, 0], [300, 200, 0]], atol=1e-4)


@cascadio
def test_cad_files_know_their_own_unit(tmp_path):
    (tmp_path / "part.igs").write_text(iges_rectangle(300, 200))
    with pytest.raises(SurfaceError, match="knows its own unit"):
        read_surface(tmp_path / "part.igs", unit="m")
    with pytest.raises(SurfaceError, match="tolerance must be above 0"):
        read_surface(tmp_path / "part.igs", tolerance=-1.0)


@cascadio
def test_the_cad_kernel_writes_nothing_to_the_standard_output(tmp_path):
    (tmp_path / "part.igs").write_text(iges_rectangle(300, 200))
    code = "import sys; import geomdrap as gd; print(len(gd.read_surface(sys.argv[1]).points))"
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "part.igs")], capture_output=True, check=True
    )
    assert (done.stdout.strip(), done.stderr) == (b"4", b"")


def test_without_cascadio_the_error_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "cascadio", None)
    (tmp_path / "part.step").write_text(step_rectangle(300, 200))
    with pytest.raises(SurfaceError, match=r"pip install 'geomdrap\[cad\]'"):
        read_surface(tmp_path / "part.step")


def test_reading_a_binary_stl_loads_neither_trimesh_nor_scipy(tmp_path):
    write_with_trimesh(tmp_path / "part.stl", *bumpy(), "stl")
    code = (
        "import sys; import geomdrap as gd; gd.read_surface(sys.argv[1]).findings; "
        "print([m for m in ('trimesh', 'scipy.spatial', 'meshio', 'igl') if m in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "part.stl")], capture_output=True, check=True
    )
    assert done.stdout.strip() == b"[]"


def test_a_surface_is_drawn_by_its_file_and_size(tmp_path):
    write_with_trimesh(tmp_path / "part.stl", *grid(2), "stl")
    assert repr(read_surface(tmp_path / "part.stl")) == "<Surface part.stl: 8 faces, 10000 mm²>"
    assert isinstance(read_surface(str(tmp_path / "part.stl")), Surface)
