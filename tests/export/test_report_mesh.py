"""The mesh of report.html against the exact net on a sphere, and against the drape that it was made of."""

from __future__ import annotations

import numpy as np
import pytest
from exact_nets import sphere_shear_at

import geomdrap as gd
from geomdrap.export.ply_corners import STEPS, barycentric, on_octahedron
from geomdrap.export.report_mesh import BARE, report_mesh
from geomdrap.fishnet import Status
from geomdrap.surface import shapes

RADIUS = 100.0


def cap(cells, **options):
    surface = shapes.sphere_cap(RADIUS, 60.0, RADIUS / cells)
    return gd.evaluate(gd.drape(surface, (0, 0, RADIUS), 20.0, RADIUS / cells, project=True, **options))


def places(mesh):
    """Points (n, 3), fabric coordinates (n, 2) and shear (n,) of the vertices, in mm and degrees."""
    space, fabric = mesh.space, mesh.fabric
    return (
        space.lower + mesh.position / STEPS * space.size,
        fabric.lower + mesh.at / STEPS * fabric.size,
        mesh.shear / 100.0,
    )


@pytest.mark.parametrize(("cells", "inside", "at_rim"), [(32, 0.06, 0.2), (16, 0.15, 0.45)])
def test_the_shear_of_the_vertices_is_that_of_the_sphere_out_to_the_rim(cells, inside, at_rim):
    points, at, shear = places(report_mesh(cap(cells)))
    miss = shear - sphere_shear_at(at[:, 0], at[:, 1], RADIUS)
    rim = points[:, 2] < RADIUS * (np.cos(np.radians(60.0)) + 0.01)
    assert rim.sum() > 50
    assert np.sqrt(np.mean(miss[~rim] ** 2)) < inside
    assert np.sqrt(np.mean(miss[rim] ** 2)) < at_rim


def test_a_vertex_lies_where_the_net_puts_its_fabric_coordinates():
    result = cap(24)
    points, at, _ = places(report_mesh(result))
    there, _ = result.net.interpolate(at[:, 0], at[:, 1])
    known = np.isfinite(there[:, 0])
    assert known.mean() > 0.8
    # between nodes the net is bilinear, a chord below the sphere, and the mesh's edges are chords themselves
    assert np.abs(points - there)[known].max() < 2 * (RADIUS / 24) ** 2 / (8 * RADIUS) * 2


def test_quantised_triangles_are_the_facets():
    result = cap(16)
    mesh, surface = report_mesh(result), result.net.surface
    points, _, _ = places(mesh)
    assert mesh.triangles.dtype == np.uint16
    corners = points[mesh.triangles]
    exact = result.trimmed.mesh.points[result.trimmed.mesh.triangles]
    assert np.abs(corners - exact).max() <= 0.5 * (surface.bounds[1] - surface.bounds[0]).max() / STEPS + 1e-9


def test_bare_triangles_carry_their_reason_and_share_no_vertex_with_draped_ones():
    result = cap(16, reach=(40.0, 30.0))
    mesh = report_mesh(result)
    bare = result.trimmed.kind == 0
    assert 0.2 < bare.mean() < 0.95
    codes = mesh.shear[mesh.triangles].astype(int) - BARE
    assert (codes[bare] == int(Status.BLANK)).all()
    assert (codes[~bare] > 20000).all()


def test_vertices_are_parted_where_the_net_meets_itself():
    result = gd.evaluate(gd.drape(shapes.cylinder(30.0, 80.0, edge=6.0, angle=360.0), "centroid", 0.0, 6.0))
    mesh = report_mesh(result)
    _, at, _ = places(mesh)
    on = result.trimmed.kind > 0
    sides = np.linalg.norm(np.diff(at[mesh.triangles[on]], axis=1), axis=2)
    assert sides.max() < 3 * 6.0, "a triangle reaches across the seam"
    assert len(mesh.shear) > len(result.net.surface.points)


def test_large_meshes_count_their_vertices_with_32_bits():
    surface = shapes.plane(300.0, 200.0, 0.9)
    assert len(surface.points) > STEPS
    assert report_mesh(gd.evaluate(gd.drape(surface, pitch=10.0))).triangles.dtype == np.uint32


def test_normals_come_back_from_the_octahedron():
    rng = np.random.default_rng(5)
    normals = rng.normal(size=(2000, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    coded = on_octahedron(normals) / 32767.0
    z = 1.0 - np.abs(coded).sum(axis=1)
    fold = np.maximum(-z, 0.0)
    back = np.column_stack([coded - np.where(coded >= 0, 1, -1) * fold[:, None], z])
    back /= np.linalg.norm(back, axis=1, keepdims=True)
    assert np.abs(back - normals).max() < 2e-4


def test_shares_in_a_triangle_give_the_point_back():
    rng = np.random.default_rng(1)
    triangle, share = rng.normal(size=(50, 3, 3)), rng.dirichlet((1, 1, 1), (50, 4))
    np.testing.assert_allclose(barycentric(np.einsum("mcp,mpk->mck", share, triangle), triangle), share, atol=1e-9)


def area_of(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()


def test_large_plane_facets_are_not_drawn_in_pieces():
    plane = shapes.plane(300.0, 200.0, 100.0)
    result = gd.evaluate(gd.drape(plane, (0, 0, 0), 20.0, 5.0, project=True))
    assert len(result.trimmed.mesh.triangles) > 1000
    mesh = report_mesh(result)
    assert len(mesh.triangles) == len(plane.triangles)
    points, at, shear = places(mesh)
    assert area_of(points, mesh.triangles) == pytest.approx(60000.0, rel=1e-4)
    assert np.abs(shear).max() < 0.01
    turn = np.radians(20.0)
    flat = points[:, :2] @ np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    np.testing.assert_allclose(at, flat, atol=0.02)


def test_pieces_that_are_put_together_differ_from_the_cut_ones_by_less_than_can_be_seen():
    surface, pitch = shapes.sphere_cap(RADIUS, 60.0, 14.0), 4.0
    result = gd.evaluate(gd.drape(surface, (0, 0, RADIUS), 20.0, pitch, (60.0, 1000.0), project=True))
    mesh, cut = report_mesh(result), result.trimmed
    points, at, shear = places(mesh)
    assert len(mesh.triangles) < 0.8 * len(cut.kind)
    assert area_of(points, mesh.triangles) == pytest.approx(surface.area, rel=1e-4)
    from geomdrap.surface.nearest import NearestTree

    draped = (mesh.shear[mesh.triangles] > -30000).all(axis=1)
    near = NearestTree(points, mesh.triangles[draped].astype(np.int64)).query(
        cut.mesh.points[cut.mesh.triangles[cut.kind > 0]].mean(axis=1)
    )
    assert near.distance.max() < 0.01
    corners = mesh.triangles[draped][near.face]
    share = barycentric(near.point[:, None], points[corners])[:, 0]
    read = np.einsum("mc,mck->mk", share, at[corners])
    assert np.abs(read - cut.at[cut.kind > 0].mean(axis=1)).max() < 0.02 * pitch + 0.02
