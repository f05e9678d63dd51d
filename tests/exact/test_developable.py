"""Parts that unroll: no cell shears, and fabric keeps its area."""

import numpy as np
import pytest
from made_parts import pyramid

import geomdrap as gd
from geomdrap.fishnet import Status
from geomdrap.surface import shapes


@pytest.mark.parametrize("angle", [0.0, 13.0, 45.0, 200.0])
def test_on_a_plane_nodes_lie_where_the_flat_fabric_has_them(angle):
    surface = shapes.plane(300.0, 200.0, 10.0)
    net = gd.drape(surface, (3.1, -7.3, 0.0), angle, 7.0)
    warp = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0.0])
    weft = np.array([-warp[1], warp[0], 0.0])
    flat = net.origin + net.u[:, None, None] * warp + net.v[None, :, None] * weft
    on_part = (abs(flat[..., 0]) <= 150.0) & (abs(flat[..., 1]) <= 100.0)
    present = np.isfinite(net.points[..., 0])
    np.testing.assert_array_equal(present, on_part)
    np.testing.assert_allclose(net.points[present], flat[present], atol=1e-9)
    assert np.nanmax(abs(net.cell_shear)) < 1e-5
    assert np.nanmax(abs(net.shear)) < 1e-5


def test_nodes_just_on_the_rim_are_there():
    net = gd.drape(shapes.plane(300.0, 200.0, 10.0), (0.0, 0.0, 0.0), 0.0, 10.0)
    assert net.points.shape == (31, 21, 3)
    assert np.isfinite(net.points).all()


@pytest.mark.parametrize("angle", [0.0, 10.0, 30.0, 45.0, 75.0, 90.0, 123.0])
def test_a_cylinder_is_draped_without_shear_at_any_heading(angle):
    surface = shapes.cylinder(100.0, 300.0, 5.0, 180.0)
    net = gd.drape(surface, (0.0, 0.0, 100.0), angle, 5.0)
    assert np.nanmax(abs(net.cell_shear)) < 0.1
    assert np.nanmax(abs(net.shear)) < 0.1
    fabric = np.cos(np.radians(net.cell_shear))[net.cell_valid].sum() * 25.0
    assert fabric > 0.9 * surface.area


@pytest.mark.parametrize("angle", [0.0, 20.0, 45.0])
def test_a_tube_is_draped_once_round_without_shear(angle):
    surface = shapes.cylinder(60.0, 200.0, 4.0)
    net = gd.drape(surface, (0.0, 0.0, 60.0), angle, 4.0)
    assert np.nanmax(abs(net.cell_shear)) < 0.1
    assert 0.9 * surface.area < net.cell_valid.sum() * 16.0 < 1.02 * surface.area


@pytest.mark.parametrize("angle", [0.0, 33.0])
def test_nodes_on_a_cylinder_lie_where_it_unrolls_to(angle):
    radius = 100.0
    surface = shapes.cylinder(radius, 300.0, 2.0, 180.0)
    net = gd.drape(surface, (0.0, 0.0, radius), angle, 10.0)
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    x = net.u[:, None] * c - net.v[None, :] * s
    turn = (net.u[:, None] * s + net.v[None, :] * c) / radius
    exact = np.stack([x, radius * np.sin(turn), radius * np.cos(turn)], axis=-1)
    miss = np.linalg.norm(net.points - exact, axis=-1)
    assert np.nanmax(miss) < 0.02


def tip_in_net(net):
    """Fabric coordinates of the cell next to the tip at the origin of a cone."""
    away = np.linalg.norm(net.points, axis=-1)
    i, j = np.unravel_index(np.nanargmin(away), away.shape)
    return net.u[i], net.v[j]


@pytest.mark.parametrize(("slope", "degrees"), [(0.2, 6.991), (0.5, 38.006)])
@pytest.mark.parametrize("part", ["cone", "pyramid"])
def test_beyond_the_tip_of_a_cone_all_cells_have_its_deficit_as_shear(slope, degrees, part):
    assert degrees == pytest.approx(360.0 * (1 - np.cos(np.arctan(slope))), abs=1e-3)
    if part == "cone":
        surface, tolerance = shapes.cone(slope, 150.0, 2.5, sectors=24), 0.35
    else:  # developable to the last digit; chords over its ridges cost a little
        surface, tolerance = pyramid(24, slope, 150.0, 30), 0.2
        side = np.array([[np.cos(a), np.sin(a), -slope] for a in (0.0, 2 * np.pi / 24)]) / np.hypot(1, slope)
        degrees = 360.0 - 24 * np.degrees(np.arccos(side[0] @ side[1]))
    pitch = 3.0
    net = gd.drape(surface, (-30.0, -24.0, 0.0), 0.0, pitch, (85.0, 85.0), project=True)
    tip_u, tip_v = tip_in_net(net)
    u, v = np.meshgrid(net.u, net.v, indexing="ij")
    behind = (u > tip_u + 2 * pitch) & (v > tip_v + 2 * pitch)
    beside = ((u < tip_u - 2 * pitch) | (v < tip_v - 2 * pitch)) & np.isfinite(net.shear)
    known = behind & np.isfinite(net.shear)
    assert known.sum() > 40
    np.testing.assert_allclose(net.shear[known], degrees, atol=tolerance)
    assert abs(net.shear[beside]).max() < tolerance


@pytest.mark.parametrize("seed", [(-50.0, -41.0, 0.0), (-60.0, -33.0, 0.0), (-30.0, -24.0, 0.0)])
def test_a_cone_too_steep_for_a_ply_is_found_as_a_fold(seed):
    surface = shapes.cone(1.0, 150.0, 3.0)
    net = gd.drape(surface, seed, 0.0, 3.0, (100.0, 100.0), project=True)
    assert (net.status == Status.FOLDED).any()


def test_a_cone_too_steep_for_a_ply_is_found_as_a_fold_from_any_seed():
    surface = shapes.cone(1.0, 150.0, 3.0)
    rng = np.random.default_rng(11)
    for _ in range(20):
        turn, away = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(25.0, 90.0)
        seed = away * np.array([np.cos(turn), np.sin(turn), -1.0])
        net = gd.drape(surface, seed, rng.uniform(0.0, 360.0), 3.0, project=True)
        assert np.isin(net.status, [Status.FOLDED, Status.NEEDS_DART]).any()


@pytest.mark.parametrize("seed", [(-50.0, -41.0, 0.0), (-60.0, -33.0, 0.0), (-30.0, -24.0, 0.0)])
def test_on_a_cone_too_steep_for_a_ply_nothing_is_drawn_behind_the_tip(seed):
    surface = shapes.cone(1.0, 150.0, 3.0)
    net = gd.drape(surface, seed, 0.0, 3.0, (100.0, 100.0), project=True)
    assert np.nanmax(abs(net.cell_shear)) < 90.0
    # behind the tip nothing can lie: that is where the shear would have to be 105.4°
    tip_u, tip_v = tip_in_net(net)
    u, v = np.meshgrid(net.u, net.v, indexing="ij")
    behind = (u > tip_u + 6.0) & (v > tip_v + 6.0)
    assert not net.cell_valid[behind[:-1, :-1]].any()


def test_a_hat_section_is_draped_without_shear_where_the_pitch_resolves_its_bends():
    surface = shapes.hat_stringer(200.0, fillet=20.0, height=60.0, edge=1.0)
    net = gd.drape(surface, "centroid", 30.0, 1.5)
    assert np.nanmax(abs(net.cell_shear)) < 0.1
