"""Parts that close on themselves: the net must stop where it comes back, and leave no gap wider than that."""

import numpy as np
import pytest
from made_parts import cube, square_tube
from scipy.spatial import cKDTree

import geomdrap as gd
from geomdrap.fishnet import Status
from geomdrap.surface import shapes


def nearest_strangers(net, apart=8):
    """Least distance, in pitches, between nodes of the same sheet that are further apart in the fabric."""
    i, j = np.nonzero(np.isfinite(net.points[..., 0]))
    points, normals = net.points[i, j], net.surface.normals[net.face[i, j]]
    pairs = cKDTree(points).query_pairs(net.pitch, output_type="ndarray")
    a, b = pairs.T
    strangers = np.maximum(abs(i[a] - i[b]), abs(j[a] - j[b])) >= apart
    same_sheet = (normals[a] * normals[b]).sum(axis=1) > 0.7
    away = np.linalg.norm(points[a] - points[b], axis=1)[strangers & same_sheet]
    return away.min() / net.pitch if len(away) else np.inf


CLOSED = {
    "sphere": (shapes.icosphere(50.0, 4), 3.0),
    "tube": (shapes.cylinder(40.0, 150.0, 4.0), 4.0),
    "square tube": (square_tube(40.0, 120.0), 3.0),
    "torus": (shapes.torus(80.0, 30.0, 5.0, start=180.0, end=-179.0), 5.0),
    "cube": (cube(60.0, 12), 3.0),
    "cone": (shapes.cone(0.5, 100.0, 4.0), 4.0),
}


@pytest.mark.parametrize("part", CLOSED)
@pytest.mark.parametrize("angle", [0.0, 23.0, 45.0])
def test_no_two_stretches_of_the_net_lie_on_each_other(part, angle):
    surface, pitch = CLOSED[part]
    net = gd.drape(surface, "vertex:17", angle, pitch)
    assert net.cell_valid.sum() > 200
    assert nearest_strangers(net) > 0.5  # nearer in the fabric, nodes of strongly sheared cells come close
    assert np.nanmax(abs(net.cell_shear)) < 90.0


@pytest.mark.parametrize("angle", [0.0, 23.0, 45.0])
def test_beyond_the_corner_of_a_cube_the_net_does_not_lie_on_itself(angle):
    surface, pitch = CLOSED["cube"]
    net = gd.drape(surface, "vertex:17", angle, pitch)
    assert nearest_strangers(net, apart=4) > 0.1


@pytest.mark.parametrize("part", ["sphere", "tube", "square tube", "torus"])
def test_the_net_stops_where_it_meets_itself_and_says_so(part):
    surface, pitch = CLOSED[part]
    net = gd.drape(surface, "vertex:17", 23.0, pitch)
    assert (net.status == Status.MEETS_ITSELF).any()
    fabric = np.cos(np.radians(net.cell_shear[net.cell_valid])).sum() * pitch**2
    assert fabric < 1.05 * surface.area


@pytest.mark.parametrize("angle", [0.0, 10.0, 45.0])
def test_a_tube_is_covered_once(angle):
    surface, pitch = CLOSED["tube"]
    net = gd.drape(surface, "vertex:333", angle, pitch)
    assert net.cell_valid.sum() * pitch**2 > 0.88 * surface.area


def test_a_sphere_is_covered_but_for_its_far_side():
    surface, pitch = CLOSED["sphere"]
    net = gd.drape(surface, "vertex:17", 23.0, pitch)
    fabric = np.cos(np.radians(net.cell_shear[net.cell_valid])).sum() * pitch**2
    assert fabric > 0.6 * surface.area
