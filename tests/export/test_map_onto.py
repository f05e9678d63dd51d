"""The ply mapped onto finite element meshes, where every number is known."""

from __future__ import annotations

import numpy as np
import pytest
from exact_nets import sphere_shear_at
from fe_decks import abaqus, grid, nastran, nastran_theta
from fe_plies import HEADING, RADIUS, WARP, dome, out, written

import geomdrap as gd
from geomdrap.errors import GeomdrapError
from geomdrap.export import fe_nastran
from geomdrap.export.map_onto import map_onto
from geomdrap.surface import shapes


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
    points, quads = grid(20, 20, 90.0, turn=15.0, height=dome)
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
        points, quads = grid(20, 20, 90.0, turn=15.0, height=dome)
        ply = map_onto(result, written(tmp_path, "m.inp", abaqus(points, quads)))
        return np.sqrt(np.mean((ply.shear - sphere_shear_at(ply.at[:, 0], ply.at[:, 1], RADIUS)) ** 2))

    assert rms(12.0) / rms(4.0) > 2.7


def test_elements_beside_above_and_across_the_part_have_no_ply(flat, tmp_path):
    points, quads = grid(10, 10, 300.0)
    mesh = written(tmp_path, "m.bdf", nastran(points, quads, theta="77."))
    ply = map_onto(flat, mesh)
    x, y = np.abs(mesh.centers[:, 0]), np.abs(mesh.centers[:, 1])
    np.testing.assert_array_equal(ply.is_draped, (x < 110.0) & (y < 90.0))  # a pitch beyond the rim, 10 mm, is near
    assert "of 100 elements of m.bdf have no ply" in ply.notes()[0]
    assert "bare there, further away than one pitch, or inclined to them by more than 60°" in ply.notes()[0]
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
