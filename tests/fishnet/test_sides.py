"""The promise of every net: each side is as long as the pitch, each node lies on the part."""

import numpy as np
import pytest
from made_parts import bumpy_sheet, plate_with_holes
from retraced import side_misses

import geomdrap as gd
from geomdrap.surface import shapes

PARTS = {
    "sphere cap": (shapes.sphere_cap(80.0, 70.0, 4.0), 6.0),
    "bumps": (bumpy_sheet(5, n=40, height=25.0), 3.0),
    "saddle": (shapes.saddle(120.0, 200.0, 6.0), 6.0),
    "bracket": (shapes.bracket(edge=6.0), 6.0),
    "torus": (shapes.torus(120.0, 40.0, 5.0, angle=200.0), 6.0),
    "l-shape": (shapes.l_shape(), 10.0),
    "plate with a hole": (plate_with_holes(), 7.0),
    "double dome": (shapes.double_dome(), 6.0),
}


@pytest.mark.parametrize("part", PARTS)
def test_every_side_of_every_cell_is_as_long_as_the_pitch(part):
    surface, pitch = PARTS[part]
    net = gd.drape(surface, "centroid", 27.0, pitch)
    assert net.cell_valid.sum() > 50
    misses = side_misses(net)
    assert len(misses) > 100
    assert misses.max() < 1e-6 * pitch


@pytest.mark.parametrize("part", PARTS)
def test_every_node_lies_on_the_face_it_names(part):
    surface, pitch = PARTS[part]
    net = gd.drape(surface, "centroid", 27.0, pitch)
    present = np.isfinite(net.points[..., 0])
    np.testing.assert_array_equal(net.face >= 0, present)
    points, faces = net.points[present], net.face[present]
    off = ((points - net.surface.origin[faces]) * net.surface.normals[faces]).sum(axis=1)
    assert abs(off).max() < 1e-9 * net.surface.diagonal
    assert net.surface.nearest(points).distance.max() < 1e-9 * net.surface.diagonal


@pytest.mark.parametrize("part", PARTS)
def test_arrays_of_a_net_agree_with_each_other(part):
    surface, pitch = PARTS[part]
    net = gd.drape(surface, "centroid", 27.0, pitch)
    present = np.isfinite(net.points[..., 0])
    nu, nv = len(net.u), len(net.v)
    assert net.points.shape == (nu, nv, 3)
    assert net.status.shape == net.face.shape == net.shear.shape == (nu, nv)
    assert net.cell_shear.shape == net.cell_valid.shape == (nu - 1, nv - 1)
    np.testing.assert_array_equal(net.status == 1, present)
    corners = present[:-1, :-1] & present[1:, :-1] & present[1:, 1:] & present[:-1, 1:]
    assert not (net.cell_valid & ~corners).any()
    np.testing.assert_array_equal(np.isfinite(net.cell_shear), net.cell_valid)
    np.testing.assert_allclose(np.diff(net.u), pitch, atol=1e-9)
    np.testing.assert_allclose(np.diff(net.v), pitch, atol=1e-9)
    i, j = int(np.argmin(abs(net.u))), int(np.argmin(abs(net.v)))
    assert net.u[i] == net.v[j] == 0.0
    np.testing.assert_allclose(net.points[i, j], net.origin, atol=1e-9)


def test_node_shear_is_the_mean_of_the_corners_around_a_node():
    net = gd.drape(shapes.sphere_cap(80.0, 60.0, 3.0), "centroid", 10.0, 6.0)
    valid = net.cell_valid
    inner = valid[:-1, :-1] & valid[1:, :-1] & valid[1:, 1:] & valid[:-1, 1:]
    for i, j in np.argwhere(inner)[::17] + 1:
        here = net.points[i, j]
        ways = [net.points[i + 1, j], net.points[i, j + 1], net.points[i - 1, j], net.points[i, j - 1]]
        ways = [(w - here) / np.linalg.norm(w - here) for w in ways]
        angles = [np.degrees(np.arccos(ways[k] @ ways[(k + 1) % 4])) for k in range(4)]
        exact = np.mean([90 - angles[0], angles[1] - 90, 90 - angles[2], angles[3] - 90])
        assert net.shear[i, j] == pytest.approx(exact, abs=0.15)  # chords lie across the surface


def test_shear_is_positive_where_warp_and_weft_close():
    # on a dome the +u +v quadrant closes: a net on a sphere is drawn in there
    net = gd.drape(shapes.sphere_cap(80.0, 60.0, 3.0), "centroid", 0.0, 6.0)
    u, v = 0.5 * (net.u[1:] + net.u[:-1]), 0.5 * (net.v[1:] + net.v[:-1])
    sign = np.sign(np.outer(u, v))
    known = np.isfinite(net.cell_shear)
    assert (sign * net.cell_shear)[known].min() > -0.05
    assert (sign * net.cell_shear)[known].max() > 20.0
    i, j = np.argwhere(net.cell_valid & (sign > 0) & (net.cell_shear > 15.0))[0]
    warp, weft = net.points[i + 1, j] - net.points[i, j], net.points[i, j + 1] - net.points[i, j]
    assert warp @ weft > 0
