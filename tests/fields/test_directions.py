"""Yarn directions, shear and thickness per facet of the input mesh."""

import numpy as np
import pytest
from exact_nets import sphere_shear_at
from made_parts import bumpy_sheet
from scipy.spatial import cKDTree

import geomdrap as gd
from geomdrap.fields.evaluate import unit_directions
from geomdrap.fields.strip import BEYOND, BY_NET
from geomdrap.fields.trim import trim
from geomdrap.surface import Surface, shapes


def middles(surface):
    return surface.points[surface.triangles].mean(axis=1)


def degrees_between(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1)))


@pytest.mark.parametrize("angle", [0.0, 33.0, 120.0, -75.0])
def test_on_a_cylinder_both_directions_are_exact_at_all_facets(angle):
    part = shapes.cylinder(100.0, 300.0, 5.0, 180.0)
    result = gd.evaluate(gd.drape(part, (0.0, 0.0, 100.0), angle, 5.0))
    axis = np.array([1.0, 0.0, 0.0])
    around = np.cross(part.normals, axis)
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    assert degrees_between(result.face_warp, c * axis + s * around).max() < 1e-3
    assert degrees_between(result.face_weft, c * around - s * axis).max() < 1e-3
    np.testing.assert_allclose(result.face_shear, 0.0, atol=1e-3)
    np.testing.assert_allclose(result.face_thickness, 1.0, atol=1e-6)


@pytest.mark.parametrize("angle", [0.0, 25.0, 200.0])
def test_on_a_sphere_the_yarns_through_the_seed_follow_great_circles(angle):
    part = shapes.icosphere(100.0, 5)
    net = gd.drape(part, (10.0, 20.0, 95.0), angle, 100.0 / 32, (80.0, 80.0), project=True)
    result = gd.evaluate(net)
    up = net.origin / np.linalg.norm(net.origin)
    middle = middles(part)
    for start, field in ((net.warp0, result.face_warp), (net.weft0, result.face_weft)):
        beside = np.cross(up, start)
        beside /= np.linalg.norm(beside)
        near = (abs(middle @ beside) < 2.0) & (result.face_coverage > 0.99)
        assert near.sum() > 80
        great_circle = np.cross(beside, middle[near])
        assert degrees_between(field[near], great_circle).max() < 0.3


def test_the_shear_of_the_facets_on_a_sphere_is_that_of_the_fabric_there():
    part = shapes.icosphere(100.0, 5)
    net = gd.drape(part, (10.0, 20.0, 95.0), 25.0, 100.0 / 32, (80.0, 80.0), project=True)
    trimmed = trim(net)
    shear = np.degrees(np.arcsin((np.prod(unit_directions(trimmed), axis=0)).sum(axis=1)))
    for kind, rms, most in ((BY_NET, 0.03, 0.15), (BEYOND, 0.08, 0.4)):
        on = (trimmed.kind == kind) & (trimmed.share > 0.0)
        u, v = trimmed.at[on].mean(axis=1).T
        miss = shear[on] - sphere_shear_at(u, v, 100.0)
        assert np.abs(miss).max() < most
        assert np.sqrt(np.mean(miss**2)) < rms


@pytest.mark.parametrize("seed", range(3))
def test_warp_and_weft_lie_in_the_facet_and_turn_counter_clockwise_about_its_normal(seed):
    part = bumpy_sheet(seed)
    result = gd.evaluate(gd.drape(part, "centroid", 40.0 * seed, 3.0))
    on = result.face_coverage > 0.0
    warp, weft, normal = result.face_warp[on], result.face_weft[on], part.normals[on]
    for field in (warp, weft):
        np.testing.assert_allclose(np.linalg.norm(field, axis=1), 1.0, atol=1e-12)
        assert np.abs((field * normal).sum(axis=1)).max() < 1e-6
    assert (np.cross(warp, weft) * normal).sum(axis=1).min() > 0.0
    shear = result.face_shear[on]
    # positive where the directions close
    np.testing.assert_allclose(90.0 - degrees_between(warp, weft), shear, atol=1e-6)
    np.testing.assert_allclose(result.face_thickness[on], 1.0 / np.cos(np.radians(shear)), rtol=1e-9)
    np.testing.assert_allclose(result.face_fibre_volume, result.face_thickness)


def test_turning_the_part_over_turns_the_sign_of_the_shear():
    part = shapes.saddle(300.0, 200.0, 10.0, ruled=True)
    front = gd.evaluate(gd.drape(part, (0.0, 0.0, 0.0), 0.0, 10.0))
    back = gd.evaluate(gd.drape(part.flipped(), (0.0, 0.0, 0.0), 0.0, 10.0))
    assert np.abs(front.face_shear).max() > 3.0

    tree = cKDTree(middles(front.net.surface))
    away, same = tree.query(middles(back.net.surface))
    assert away.max() < 1e-9
    np.testing.assert_allclose(back.face_shear, -front.face_shear[same], atol=0.3)  # ties of the walk differ
    np.testing.assert_allclose(back.area.fabric, front.area.fabric, rtol=1e-4)


def test_bare_facets_have_no_direction_and_no_shear():
    part = Surface([[0, 0, 0], [100, 0, 0], [100, 60, 0], [0, 60, 0]], [[0, 1, 2], [0, 2, 3]])
    fine = shapes.plane(100.0, 60.0, 5.0)
    for surface in (part, fine):
        result = gd.evaluate(gd.drape(surface, "centroid", 0.0, 5.0, reach=(20.0, 10.0)))
        bare = result.face_coverage == 0.0
        assert np.isnan(result.face_shear[bare]).all()
        assert np.isnan(result.face_warp[bare]).all()
        assert np.isnan(result.face_thickness[bare]).all()
        assert np.isfinite(result.face_shear[~bare]).all()
        weight = surface.areas[result.net.surface.source_face] if surface is part else surface.areas
        assert (result.face_coverage * weight).sum() == pytest.approx(800.0, rel=1e-6)
