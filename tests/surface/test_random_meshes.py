"""Whatever triangles come, a Surface is made that keeps its promises, or a SurfaceError says why not."""

import warnings

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from raw_meshes import bumpy

from geomdrap.errors import GeomdrapError
from geomdrap.surface import Surface, check, read_surface

SETTINGS = settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))

coarse = st.integers(-2, 2).map(float)
wild = st.one_of(coarse, st.floats(-100, 100), st.floats(allow_nan=True, allow_infinity=True))


@st.composite
def meshes(draw, numbers):
    n = draw(st.integers(1, 12))
    points = draw(hnp.arrays(np.float64, (n, 3), elements=numbers))
    triangles = draw(hnp.arrays(np.int64, (draw(st.integers(0, 25)), 3), elements=st.integers(0, n - 1)))
    return points, triangles


def assert_promises(surface):
    """What every other package relies on."""
    n, m = len(surface.points), len(surface.triangles)
    assert m > 0
    assert surface.triangles.min() >= 0
    assert surface.triangles.max() < n
    assert len(np.unique(surface.triangles)) == n
    for array in (surface.e1, surface.e2, surface.normals, surface.areas, surface.unfolded):
        assert np.isfinite(array).all()
    assert (surface.areas > 0).all()
    assert (surface.unfolded[:, [0, 2]] > 0).all()
    f, k = np.nonzero(surface.neighbours >= 0)
    g, j = surface.neighbours[f, k], surface.neighbour_edge[f, k].astype(int)
    assert (surface.neighbours[g, j] == f).all()
    assert (surface.neighbour_edge[g, j] == k).all()
    t = surface.triangles
    assert (t[f, k] == t[g, (j + 1) % 3]).all()
    assert (t[f, (k + 1) % 3] == t[g, j]).all()
    assert (surface.component[f] == surface.component[g]).all()
    assert surface.component.max() + 1 == surface.n_components
    # one fan of faces at each vertex: as many boundary edges leave it as come in, at most one
    b, k = np.nonzero(surface.neighbours < 0)
    assert np.bincount(t[b, k], minlength=n).max(initial=0) <= 1


def examine(points, triangles):
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        try:
            surface = Surface(points, triangles)
        except GeomdrapError as error:
            assert "\n" not in str(error)
            return
        assert_promises(surface)
        check.text(surface)
        check.report(surface)
        assert_promises(surface.flipped())
        piece = surface.only_component(len(surface.triangles) - 1)
        assert_promises(piece)
        assert np.isfinite(piece.nearest(np.zeros((1, 3))).distance).all()
        assert np.isfinite(surface.vertex_normals).all()
        loops = surface.boundary_loops
        assert sum(map(len, loops)) == (surface.neighbours < 0).sum()


@SETTINGS
@given(meshes(coarse))
def test_random_triangles_on_a_coarse_lattice(mesh):
    examine(*mesh)


@SETTINGS
@given(meshes(wild))
def test_random_triangles_with_any_numbers(mesh):
    examine(*mesh)


@SETTINGS
@given(st.data())
def test_a_good_mesh_with_faces_spoilt(data):
    points, triangles = bumpy(4)
    for _ in range(data.draw(st.integers(1, 6))):
        i = data.draw(st.integers(0, len(triangles) - 1))
        triangles[i, data.draw(st.integers(0, 2))] = data.draw(st.integers(0, len(points) - 1))
    move = data.draw(st.integers(0, len(points) - 1))
    points[move] = points[data.draw(st.integers(0, len(points) - 1))] + data.draw(
        st.sampled_from([0.0, 1e-9, 1e-5, 1e-3])
    )
    examine(points, triangles)


@SETTINGS
@given(st.binary(max_size=400), st.sampled_from(["stl", "obj", "ply", "off"]), st.booleans())
def test_random_bytes_in_a_file(tmp_path_factory, data, ending, headed):
    start = {"stl": b"solid x\nfacet", "obj": b"v 0 0 0\nf", "ply": b"ply\nformat ascii 1.0\n"}
    path = tmp_path_factory.mktemp("random") / f"part.{ending}"
    path.write_bytes((start.get(ending, b"OFF\n") if headed else b"") + data)
    try:
        assert_promises(read_surface(path))
    except GeomdrapError as error:
        assert "\n" not in str(error)
