"""The analytic surfaces against their formulas: areas, volumes, curvature, topology, orientation, quality."""

from __future__ import annotations

import numpy as np
import pytest

from geomdrap.errors import SurfaceError
from geomdrap.surface import shapes

ALL = {
    "plane": (shapes.plane, 1),
    "saddle": (shapes.saddle, 1),
    "ruled saddle": (lambda **size: shapes.saddle(ruled=True, **size), 1),
    "l_shape": (shapes.l_shape, 1),
    "hat_stringer": (shapes.hat_stringer, 1),
    "tube": (shapes.cylinder, 0),
    "half tube": (lambda **size: shapes.cylinder(angle=180.0, **size), 1),
    "cone": (shapes.cone, 1),
    "icosphere": (shapes.icosphere, 2),
    "sphere_cap": (shapes.sphere_cap, 1),
    "hemisphere": (shapes.hemisphere, 1),
    "hemisphere_on_flange": (shapes.hemisphere_on_flange, 1),
    "torus": (shapes.torus, 0),
    "torus part": (lambda **size: shapes.torus(angle=90.0, **size), 1),
    "double_dome": (shapes.double_dome, 1),
    "car_hood": (shapes.car_hood, 1),
    "bracket": (shapes.bracket, -1),  # a disc with a hole and a slot
}


def corner_angles(surface):
    """Angles (m, 3) rad of the facets, by the law of cosines from the points alone."""
    p = surface.points[surface.triangles]
    a, b, c = (np.linalg.norm(p[:, (k + 1) % 3] - p[:, (k + 2) % 3], axis=1) for k in range(3))
    cosines = [(y * y + z * z - x * x) / (2.0 * y * z) for x, y, z in ((a, b, c), (b, c, a), (c, a, b))]
    return np.arccos(np.clip(np.stack(cosines, axis=1), -1.0, 1.0))


def boundary_vertices(surface):
    face, corner = np.nonzero(surface.neighbours < 0)
    return np.unique(surface.triangles[face][np.arange(len(face)), corner])


def interior_deficit(surface):
    """Sum of 2π − angles over the inner vertices: the Gaussian curvature of the polyhedron."""
    sums = np.bincount(surface.triangles.ravel(), corner_angles(surface).ravel(), len(surface.points))
    inner = np.ones(len(sums), bool)
    inner[boundary_vertices(surface)] = False
    return float(np.sum(2.0 * np.pi - sums[inner]))


@pytest.fixture(scope="module", params=list(ALL))
def shape(request):
    make, characteristic = ALL[request.param]
    return make(), characteristic


def test_each_shape_is_one_clean_sheet_of_the_expected_topology(shape):
    surface, characteristic = shape
    t = surface.triangles
    edges = np.unique(np.sort(t[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    assert len(np.unique(t)) == len(surface.points)
    assert len(surface.points) - len(edges) + len(t) == characteristic
    assert surface.n_components == 1
    assert surface.findings.n_non_manifold == 0
    assert surface.findings.degenerate_faces == 0
    assert surface.findings.turned_faces == 0  # oriented as built, not by repair
    surface.require_drapable()


def test_no_shape_has_slivers(shape):
    smallest = np.degrees(corner_angles(shape[0]).min())
    assert smallest > 24.0


def test_edges_are_as_long_as_asked(shape):
    surface, _ = shape
    p = surface.points[surface.triangles]
    lengths = np.linalg.norm(p - np.roll(p, -1, axis=1), axis=2)
    assert lengths.max() < 2.0 * np.median(lengths)
    assert lengths.min() > 0.45 * np.median(lengths)


@pytest.mark.parametrize(
    ("name", "edges"),
    [
        ("bracket", (3.1, 3.9, 6.3, 8.0)),
        ("double_dome", (3.3, 4.1, 7.7, 9.0)),
        ("car_hood", (11.0, 13.7, 24.0, 31.0)),
        ("hemisphere_on_flange", (2.1, 3.3, 7.0, 9.0)),
        ("torus part", (3.3, 7.1, 12.0)),
    ],
)
def test_meshes_are_as_good_at_other_edge_lengths(name, edges):
    make, characteristic = ALL[name]
    for edge in edges:
        surface = make(edge=edge)
        t = surface.triangles
        assert np.degrees(corner_angles(surface).min()) > 18.0
        boundary_edges = int((surface.neighbours < 0).sum())
        assert len(surface.points) - (3 * len(t) + boundary_edges) // 2 + len(t) == characteristic
        assert surface.findings.n_non_manifold == 0


@pytest.mark.parametrize("name", ["cone", "sphere_cap", "hemisphere", "double_dome", "saddle", "l_shape"])
def test_normals_of_panels_point_up(name):
    assert ALL[name][0]().normals[:, 2].min() > -1e-9


def test_normals_of_round_parts_point_outward():
    for surface, axis in (
        (shapes.icosphere(), ()),
        (shapes.cylinder(), (0,)),
        (shapes.cylinder(angle=120.0), (0,)),
    ):
        middle = surface.points[surface.triangles].mean(axis=1)
        middle[:, list(axis)] = 0.0
        assert np.einsum("ij,ij->i", middle, surface.normals).min() > 0.0


def test_normals_of_a_torus_point_away_from_its_ring():
    surface = shapes.torus(150.0, 50.0, 6.0, angle=120.0, start=200.0, end=-100.0)
    middle = surface.points[surface.triangles].mean(axis=1)
    on_ring = middle * [1.0, 1.0, 0.0]
    on_ring *= 150.0 / np.linalg.norm(on_ring, axis=1, keepdims=True)
    assert np.einsum("ij,ij->i", middle - on_ring, surface.normals).min() > 0.0


def test_the_bracket_looks_up_on_its_base_and_inward_on_its_walls():
    surface = shapes.bracket()
    x, y, z = surface.points[surface.triangles].mean(axis=1).T
    base = (z < 1e-9) & (np.abs(x) < 100.0)
    back = (np.abs(y - 98.0) < 1e-6) & (z > 20.0) & (z < 76.0)
    front = (y < -100.0) & (z > 20.0) & (np.abs(x) < 50.0)
    assert min(base.sum(), back.sum(), front.sum()) > 50
    assert np.allclose(surface.normals[base], [0.0, 0.0, 1.0])
    assert np.allclose(surface.normals[back], [0.0, -1.0, 0.0])
    assert surface.normals[front][:, 1].min() > 0.9


def test_the_icosphere_has_all_vertices_on_the_sphere_and_converges_to_its_area_and_volume():
    radius, exact = 80.0, np.array([4.0 * np.pi, 4.0 / 3.0 * np.pi]) * [80.0**2, 80.0**3]
    errors = []
    for s in (2, 3, 4, 5):
        surface = shapes.icosphere(radius, s)
        assert len(surface.triangles) == 20 * 4**s
        assert np.allclose(np.linalg.norm(surface.points, axis=1), radius, rtol=1e-14, atol=0.0)
        a, b, c = np.moveaxis(surface.points[surface.triangles], 1, 0)
        volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0
        errors.append(1.0 - np.array([surface.area, volume]) / exact)
    rates = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert np.all(np.abs(rates[-1] - 2.0) < 0.02)  # second order in the edge
    assert np.all(np.array(errors[-1]) > 0.0)  # from within
    assert np.all(np.array(errors[-1]) < 1.5e-3)


def test_a_sphere_cap_has_the_curvature_and_area_of_its_solid_angle():
    opening, radius = 50.0, 120.0
    solid = 2.0 * np.pi * (1.0 - np.cos(np.radians(opening)))
    surface = shapes.sphere_cap(radius, opening, 2.5)
    assert surface.area == pytest.approx(solid * radius**2, rel=5e-4)
    # the inner vertices see the cap up to half an edge from its rim
    assert interior_deficit(surface) == pytest.approx(solid, rel=0.03)
    finer = shapes.sphere_cap(radius, opening, 1.25)
    assert abs(interior_deficit(finer) - solid) < 0.6 * abs(interior_deficit(surface) - solid)


@pytest.mark.parametrize("angle", [360.0, 180.0, 75.0])
def test_the_cylinder_lies_on_its_radius_and_has_no_curvature(angle):
    surface = shapes.cylinder(60.0, 200.0, 4.0, angle)
    assert np.allclose(np.hypot(*surface.points[:, 1:].T), 60.0, rtol=1e-14, atol=0.0)
    assert np.array_equal(surface.bounds[:, 0], [-100.0, 100.0])
    assert surface.area == pytest.approx(np.radians(angle) * 60.0 * 200.0, rel=1e-3)
    assert surface.points[:, 2].max() == pytest.approx(60.0, rel=1e-3)  # about the top line
    assert interior_deficit(surface) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("slope", [0.2, 0.5, 1.0])
def test_the_cone_has_its_deficit_at_the_apex_and_none_elsewhere(slope):
    exact = 360.0 * (1.0 - np.cos(np.arctan(slope)))
    surface = shapes.cone(slope, 100.0, 2.5)
    apex = np.flatnonzero(np.all(surface.points == 0.0, axis=1))
    assert len(apex) == 1
    assert np.allclose(surface.points[:, 2], -slope * np.hypot(*surface.points[:, :2].T), atol=1e-12)
    assert np.degrees(interior_deficit(surface)) == pytest.approx(exact, abs=0.02)
    fan = shapes.cone(slope, 100.0, 10.0, sectors=90)
    at_apex = (fan.triangles == np.flatnonzero(np.all(fan.points == 0.0, axis=1))[0]).nonzero()
    assert len(at_apex[0]) == 90
    assert 360.0 - np.degrees(corner_angles(fan)[at_apex].sum()) == pytest.approx(exact, abs=0.05)


def test_the_apex_of_the_cone_has_the_deficit_of_a_pyramid_with_as_many_sides_as_sectors():
    surface = shapes.cone(0.5, 100.0, 5.0, sectors=6)
    apex = (surface.triangles == np.flatnonzero(np.all(surface.points == 0.0, axis=1))[0]).nonzero()
    half = np.arcsin(np.sin(np.pi / 6.0) / np.hypot(1.0, 0.5))
    assert corner_angles(surface)[apex].sum() == pytest.approx(12.0 * half, abs=1e-12)


def test_both_saddles_have_the_total_curvature_of_their_formula():
    middles = (np.arange(400) + 0.5) / 400.0 * 300.0 - 150.0
    x, y = np.meshgrid(middles, middles)
    exact = -np.sum((1.0 + (x * x + y * y) / 300.0**2) ** -1.5) * (300.0 / 400.0) ** 2 / 300.0**2  # K dA
    for ruled in (False, True):
        coarse, fine = (
            interior_deficit(shapes.saddle(300.0, 300.0, edge, ruled=ruled)) for edge in (4.0, 2.0)
        )
        assert fine < 0.0
        assert 2.0 * fine - coarse == pytest.approx(exact, rel=2e-3)  # the rim's share goes with the edge


def test_a_torus_part_has_the_area_of_pappus_and_the_radii_of_its_formula():
    surface = shapes.torus(150.0, 50.0, 3.0)  # the upper half
    away = np.hypot(np.hypot(*surface.points[:, :2].T) - 150.0, surface.points[:, 2])
    assert np.allclose(away, 50.0, rtol=1e-13)
    assert surface.area == pytest.approx(2.0 * np.pi * 150.0 * np.pi * 50.0, rel=1e-3)


def test_a_flat_flange_all_round_makes_the_curvature_inside_vanish():
    for surface in (shapes.hemisphere_on_flange(), shapes.double_dome()):
        assert interior_deficit(surface) == pytest.approx(0.0, abs=1e-9)
        rim = surface.points[boundary_vertices(surface)]
        assert np.array_equal(rim[:, 2], np.zeros(len(rim)))


def test_the_hemisphere_on_a_flange_has_the_area_of_its_three_parts():
    radius, fillet, flange = 75.0, 10.0, 60.0
    foot = radius + fillet
    # the quarter torus by Pappus: its centroid lies 2·fillet/π nearer the axis than its centre
    bend = 2.0 * np.pi * (foot - 2.0 * fillet / np.pi) * (np.pi / 2.0 * fillet)
    exact = 2.0 * np.pi * radius**2 + bend + np.pi * ((foot + flange) ** 2 - foot**2)
    errors = [shapes.hemisphere_on_flange(radius, fillet, flange, e).area / exact - 1.0 for e in (4.0, 2.0)]
    assert abs(errors[1]) < 3e-4
    assert abs(errors[1]) < 0.4 * abs(errors[0])


def test_the_hat_stringer_has_the_area_of_its_unbent_strip():
    crown, flange, height, fillet, wall = 40.0, 40.0, 45.0, 8.0, np.radians(75.0)
    straight = (height - 2.0 * fillet * (1.0 - np.cos(wall))) / np.sin(wall)
    strip = crown + 2.0 * flange + 2.0 * straight + 4.0 * fillet * wall
    surface = shapes.hat_stringer()
    assert surface.area == pytest.approx(400.0 * strip, rel=3e-3)
    assert interior_deficit(surface) == pytest.approx(0.0, abs=1e-9)
    assert surface.bounds[:, 2] == pytest.approx([0.0, height], abs=1e-12)


def test_a_hat_with_walls_past_upright_has_an_undercut():
    assert shapes.hat_stringer(wall=105.0, crown=80.0).normals[:, 2].min() < -0.2


def test_the_back_of_the_bracket_is_bent_without_stretch():
    surface = shapes.bracket(pad=1e-12, edge=3.0)
    half_turn = np.arcsin(150.0 / 330.0)
    segment = 330.0**2 * (half_turn - np.sin(half_turn) * np.cos(half_turn))  # between arc and chord
    chord = -100.0 + 330.0 * (1.0 - np.cos(half_turn))
    flat = 300.0 * (80.0 - chord) + segment + 300.0 * (np.pi * 18.0 + 60.0 + 25.0)
    holes = np.pi * 22.0**2 + np.pi * 10.0**2 + 40.0 * 20.0 + 2.0 * (1.0 - np.pi / 4.0) * 12.0**2
    bend = 2.0 * half_turn * (330.0 + 18.0 * 2.0 / np.pi) * (np.pi / 2.0 * 18.0)
    wall = 348.0 * 2.0 * half_turn * 40.0 * (1.0 - 0.4 / 3.0)
    assert surface.area == pytest.approx(flat - holes + bend + wall, rel=1e-3)


def test_the_curved_front_fillet_of_the_bracket_holds_the_curvature_of_its_turn():
    surface = shapes.bracket(pad=1e-12, edge=2.5)
    turn = 2.0 * np.arcsin(150.0 / 330.0)
    assert interior_deficit(surface) == pytest.approx(turn, rel=0.03)


def test_the_car_hood_turns_its_edge_down_all_round_and_is_symmetric():
    surface = shapes.car_hood()
    rim = boundary_vertices(surface)
    slope = np.degrees(np.arccos(surface.vertex_normals[rim][:, 2]))
    assert slope.min() > 40.0
    assert surface.bounds[0, 1] == pytest.approx(-surface.bounds[1, 1], abs=1e-9)
    assert surface.centroid[1] == pytest.approx(0.0, abs=0.5)


def test_the_l_shape_lacks_its_quarter_and_is_flat_at_infinite_radius():
    surface = shapes.l_shape(400.0, 160.0, np.inf, 8.0)
    assert surface.area == pytest.approx(400.0**2 - 240.0**2, rel=1e-12)
    assert np.any(np.all(surface.points == [-40.0, -40.0, 0.0], axis=1))  # the re-entrant corner


def test_a_grid_surface_takes_any_formula_and_uneven_lines():
    surface = shapes.grid_surface(lambda x, y: x * y / 50.0, [0.0, 1.0, 3.0], [-2.0, 0.0, 5.0, 6.0])
    assert np.array_equal(surface.points[:, 2], surface.points[:, 0] * surface.points[:, 1] / 50.0)
    assert len(surface.triangles) == 2 * 2 * 3


@pytest.mark.parametrize("name", ["icosphere", "tube", "double_dome", "car_hood", "bracket"])
def test_the_same_call_gives_the_same_bytes(name):
    make, _ = ALL[name]
    first, second = make(), make()
    assert first.points.tobytes() == second.points.tobytes()
    assert first.triangles.tobytes() == second.triangles.tobytes()


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: shapes.plane(width=0.0), "width"),
        (lambda: shapes.cylinder(angle=400.0), "angle"),
        (lambda: shapes.cone(slope=-1.0), "slope"),
        (lambda: shapes.cone(sectors=2), "sectors"),
        (lambda: shapes.icosphere(subdivisions=11), "subdivisions"),
        (lambda: shapes.sphere_cap(opening=180.0), "opening"),
        (lambda: shapes.torus(50.0, 60.0), "tube_radius"),
        (lambda: shapes.l_shape(arm=500.0), "arm"),
        (lambda: shapes.hat_stringer(fillet=40.0), "fillet"),
        (lambda: shapes.double_dome(width=150.0), "flange"),
        (lambda: shapes.car_hood(corner=600.0), "corner"),
        (lambda: shapes.bracket(length=900.0), "length"),
        (lambda: shapes.grid_surface(lambda x, y: x, [0.0, 0.0], [0.0, 1.0]), "xs"),
        (lambda: shapes.saddle(edge=float("nan")), "edge"),
    ],
)
def test_impossible_sizes_are_refused_by_name(make, word):
    with pytest.raises(SurfaceError, match=word):
        make()
