"""Parts whose outline is in the way: the front goes round it, and what stays bare has a reason."""

import numpy as np
import pytest
from made_parts import plate_with_holes

import geomdrap as gd
from geomdrap.fishnet import Status
from geomdrap.surface import shapes


def covered(net):
    """Share of the part's area under the valid cells, counted on the flat fabric."""
    return (np.cos(np.radians(net.cell_shear[net.cell_valid]))).sum() * net.pitch**2 / net.surface.area


def test_statuses_have_reasons_and_say_why_a_node_is_absent():
    assert len({status.reason for status in Status}) == len(Status)
    assert all(status.reason for status in Status)
    net = gd.drape(shapes.plane(200.0, 100.0, 10.0), (1.0, 2.0, 0.0), 20.0, 5.0)
    present = np.isfinite(net.points[..., 0])
    assert set(np.unique(net.status[~present])) <= {Status.UNREACHED, Status.OFF_PART}
    # every node just beyond one that is there was tried
    beyond = np.zeros_like(present)
    beyond[:-1, :-1] |= net.cell_valid
    assert (net.status == Status.OFF_PART).sum() > 50


@pytest.mark.parametrize("angle", [0.0, 20.0, 45.0])
@pytest.mark.parametrize("seed", [(-120.0, 120.0, 0.0), (120.0, -120.0, 0.0), (-110.0, -110.0, 0.0)])
def test_a_flat_l_is_draped_round_its_corner_without_shear(angle, seed):
    surface = shapes.l_shape(400.0, 160.0, np.inf, 7.0)
    net = gd.drape(surface, seed, angle, 5.0)
    assert covered(net) > 0.93
    assert np.nanmax(abs(net.cell_shear)) < 1e-3
    warp = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0.0])
    weft = np.array([-warp[1], warp[0], 0.0])
    flat = net.origin + net.u[:, None, None] * warp + net.v[None, :, None] * weft
    present = np.isfinite(net.points[..., 0])
    np.testing.assert_allclose(net.points[present], flat[present], atol=1e-6)


def test_a_crowned_l_is_draped_round_its_corner():
    surface = shapes.l_shape()
    for seed in ((-120.0, 120.0, -20.0), (120.0, -120.0, -20.0)):
        net = gd.drape(surface, seed, 15.0, 5.0, project=True)
        assert covered(net) > 0.93
        assert np.nanmax(abs(net.cell_shear)) < 25.0


def notched(width=30.0):
    """A plate with a round notch cut into its right side."""
    lines = np.linspace(-100.0, 100.0, 81)
    return shapes.grid_surface(
        lambda x, y: 0.0 * x, lines, lines, keep=lambda x, y: np.hypot(x - 100.0, y) > 2 * width
    )


@pytest.mark.parametrize("seed", [(-60.0, 3.0, 0.0), (80.0, 80.0, 0.0), (80.0, -80.0, 0.0)])
def test_the_front_goes_round_a_notch(seed):
    surface = notched()
    for angle in (0.0, 33.0):
        net = gd.drape(surface, seed, angle, 4.0)
        assert covered(net) > 0.9
        assert np.nanmax(abs(net.cell_shear)) < 1e-3


@pytest.mark.parametrize("seed", [(-60.0, 3.0, 0.0), (70.0, 70.0, 0.0)])
def test_a_hole_is_crossed_and_its_nodes_are_absent(seed):
    surface = plate_with_holes(((0.0, 0.0, 30.0), (60.0, -60.0, 15.0)))
    net = gd.drape(surface, seed, 10.0, 4.0)
    assert covered(net) > 0.9
    assert np.nanmax(abs(net.cell_shear)) < 1e-3
    inside = np.maximum(abs(net.lattice[..., 0]), abs(net.lattice[..., 1])) < 30.0 - 1e-9
    assert inside.sum() > 150
    assert (net.status[inside] == Status.IN_HOLE).all()
    assert not np.isfinite(net.points[inside]).any()
    assert (net.face[inside] == -1).all()
    present = np.isfinite(net.points[..., 0])
    x, y = net.points[present][:, 0], net.points[present][:, 1]
    assert (np.maximum(abs(x), abs(y)) >= 30.0 - 1e-9).all()


def test_a_curved_part_with_a_hole_is_the_same_beside_it_as_one_without():
    lines = np.linspace(-100.0, 100.0, 81)

    def crown(x, y):
        return -(x * x + y * y) / 500.0

    whole = shapes.grid_surface(crown, lines, lines)
    holed = shapes.grid_surface(crown, lines, lines, keep=lambda x, y: np.hypot(x - 40, y - 40) > 12.0)
    a = gd.drape(whole, (0.5, 0.7, 0.0), 0.0, 4.0)
    b = gd.drape(holed, (0.5, 0.7, 0.0), 0.0, 4.0)
    before = np.s_[: np.searchsorted(b.u, 20.0), :]
    np.testing.assert_allclose(a.points[before], b.points[before], atol=1e-9)
    # behind it the lid is flat where the crown is not: nearly the same
    miss = np.linalg.norm(a.points - b.points, axis=-1)
    assert np.nanmax(miss) < 4.0
    assert covered(b) > 0.9


def test_walls_and_undercuts_are_draped():
    surface = shapes.hat_stringer(200.0, wall=100.0, edge=3.0, fillet=10.0)
    net = gd.drape(surface, (0.0, 0.0, 45.0), 0.0, 3.0)
    assert covered(net) > 0.93
    assert np.nanmax(abs(net.cell_shear)) < 0.1
    faces = net.face[net.face >= 0]
    assert (surface.normals[faces][:, 2] < -0.1).any()


def test_a_bracket_with_walls_a_lip_and_holes_is_draped():
    surface = shapes.bracket()
    for angle in (0.0, 45.0):
        net = gd.drape(surface, "centroid", angle, 5.0)
        assert covered(net) > 0.85
        assert (net.status == Status.IN_HOLE).any()


@pytest.mark.parametrize("reach", [(30.0, 50.0), (12.5, 41.0), (1000.0, 20.0)])
def test_the_net_ends_where_the_blank_does(reach):
    surface = shapes.plane(200.0, 120.0, 10.0)
    net = gd.drape(surface, (1.0, 2.0, 0.0), 0.0, 5.0, reach)
    for axis, r, low, high in ((net.u, reach[0], 100.0, 95.0), (net.v, reach[1], 60.0, 55.0)):
        assert -axis[0] == min(5.0 * np.floor(r / 5.0), low)
        assert axis[-1] == min(5.0 * np.floor(r / 5.0), high)
    assert np.isfinite(net.points).all()
    around = net.status_around
    limited = [r <= half for r, half in zip(reach, (95.0, 55.0), strict=True)]
    if limited[0]:
        assert (around[[0, -1], 1:-1] == Status.BLANK).all()
    if limited[1]:
        assert (around[1:-1, [0, -1]] == Status.BLANK).all()


@pytest.mark.parametrize("reach", [(0.0, 10.0), (-5.0, 10.0), (np.nan, 10.0), (np.inf, 10.0), (10.0,)])
def test_a_blank_without_a_size_is_refused(reach):
    with pytest.raises(gd.DrapeError, match="blank"):
        gd.drape(shapes.plane(), "centroid", 0.0, 5.0, reach)


def test_a_blank_smaller_than_the_pitch_gives_a_net_without_cells_or_an_error():
    try:
        net = gd.drape(shapes.plane(), "centroid", 0.0, 5.0, (3.0, 3.0))
    except gd.DrapeError:
        return
    assert net.points.shape == (1, 1, 3)
    assert net.cell_shear.shape == (0, 0)
