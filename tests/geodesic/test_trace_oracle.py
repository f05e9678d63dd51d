"""The tracer against geometry-central's (through potpourri3d), on meshes without symmetry."""

import numpy as np
import pytest
from made_parts import bumpy_sheet, cube, face_point, random_starts

from geomdrap.geodesic import Stop, trace
from geomdrap.surface import shapes

potpourri3d = pytest.importorskip("potpourri3d")

SURFACES = {
    "bumpy sheet": bumpy_sheet(1),
    "steep bumps": bumpy_sheet(2, n=16, height=50.0),
    "sphere": shapes.icosphere(50.0, 3),
    "torus": shapes.torus(60.0, 20.0, 6.0, start=180.0, end=-100.0),
    "bracket": shapes.bracket(edge=9.0),
    "cube": cube(),
}


def theirs(tracer, surface, face, weights, way, length):
    return np.asarray(tracer.trace_geodesic_from_face(face, np.asarray(weights), length * way))


@pytest.mark.parametrize("name", SURFACES)
def test_lines_end_where_another_tracer_ends_them(name):
    surface = SURFACES[name]
    tracer = potpourri3d.GeodesicTracer(surface.points, surface.triangles)
    rng = np.random.default_rng(4)
    for face, start, way in zip(*random_starts(surface, rng, 60), strict=True):
        corners = surface.points[surface.triangles[face]]
        basis = np.column_stack([corners[1] - corners[0], corners[2] - corners[0]])
        share = np.linalg.lstsq(basis, start - corners[0], rcond=None)[0]
        weights = [1 - share.sum(), *share]
        length = rng.uniform(0.05, 1.0) * surface.diagonal
        ours = trace(surface, start, way, length, face=int(face))
        path = theirs(tracer, surface, int(face), weights, way, length)
        np.testing.assert_allclose(ours.point, path[-1], atol=1e-6 * surface.diagonal)
        assert ours.length == pytest.approx(
            np.linalg.norm(np.diff(path, axis=0), axis=1).sum(), abs=1e-6 * surface.diagonal
        )


@pytest.mark.parametrize("share", [0.5, 0.2])
def test_lines_that_start_on_an_edge_agree(share):
    surface = SURFACES["bumpy sheet"]
    tracer = potpourri3d.GeodesicTracer(surface.points, surface.triangles)
    rng = np.random.default_rng(6)
    for face in rng.integers(0, len(surface.triangles), 20):
        weights = np.array([share, 1 - share, 0.0])
        start = face_point(surface, face, weights)
        way = np.cos(0.7) * surface.e2[face] + np.sin(0.7) * surface.e1[face]  # into the face
        ours = trace(surface, start, way, 40.0, face=int(face))
        path = theirs(tracer, surface, int(face), weights, way, 40.0)
        np.testing.assert_allclose(ours.point, path[-1], atol=1e-6)


def test_the_path_is_made_of_pieces_that_lie_on_their_faces():
    surface = SURFACES["steep bumps"]
    rng = np.random.default_rng(7)
    for face, start, way in zip(*random_starts(surface, rng, 30), strict=True):
        line = trace(surface, start, way, 60.0, face=int(face))
        assert line.path_faces[0] == face
        assert line.path_faces[-1] == line.face
        assert len(line.path) == len(line.path_faces) + 1
        for k, on in enumerate(line.path_faces):
            ends = line.path[k : k + 2] - surface.origin[on]
            assert abs(ends @ surface.normals[on]).max() < 1e-9
        pieces = np.linalg.norm(np.diff(line.path, axis=0), axis=1)
        assert pieces.sum() == pytest.approx(line.length, abs=1e-9)
        if line.stopped is Stop.LENGTH:
            assert line.length == pytest.approx(60.0, abs=1e-9)
        assert line.direction @ surface.normals[line.face] == pytest.approx(0.0, abs=1e-12)
        assert np.linalg.norm(line.direction) == pytest.approx(1.0, abs=1e-12)
