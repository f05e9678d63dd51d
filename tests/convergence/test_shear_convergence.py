"""Refine mesh and pitch together: shear converges to the smooth surface's at second order, nodes with it."""

import numpy as np
import pytest
from exact_nets import anywhere_on_a_sphere, sphere_errors

import geomdrap as gd
from geomdrap.surface import shapes

RADIUS = 100.0


def fitted_order(sizes, errors):
    """Slope of log(error) over log(size)."""
    return np.polyfit(np.log(sizes), np.log(errors), 1)[0]


def test_shear_on_a_sphere_converges_with_mesh_and_pitch():
    rng = np.random.default_rng(12)
    starts = [anywhere_on_a_sphere(rng, RADIUS) for _ in range(6)]
    sizes, errors = [], []
    for level, cells in ((3, 8), (4, 16), (5, 32), (6, 64)):
        surface = shapes.icosphere(RADIUS, level)
        found = [
            sphere_errors(
                gd.drape(surface, seed, angle, RADIUS / cells, (RADIUS, RADIUS), project=True), RADIUS
            )[0]
            for seed, angle in starts
        ]
        sizes.append(1.0 / cells)
        errors.append(np.sqrt(np.mean(np.square(found))))
    assert fitted_order(sizes, errors) > 1.5
    assert errors[-1] < 0.02


def test_shear_on_a_sphere_converges_at_second_order_in_the_pitch_alone():
    surface = shapes.icosphere(RADIUS, 7)
    sizes = np.array([1 / 2, 1 / 4, 1 / 8])
    errors = [
        sphere_errors(gd.drape(surface, "vertex:77", 12.0, RADIUS * h, (RADIUS, RADIUS)), RADIUS)[0]
        for h in sizes
    ]
    assert fitted_order(sizes, errors) > 1.8
    assert errors[-1] < 0.1


def at_common_nodes(net, step):
    """Points and shear at the nodes whose fabric coordinates are multiples of a step."""
    every = round(step / net.pitch)
    i = np.flatnonzero(np.rint(net.u / net.pitch).astype(int) % every == 0)
    j = np.flatnonzero(np.rint(net.v / net.pitch).astype(int) % every == 0)
    return net.points[np.ix_(i, j)], net.shear[np.ix_(i, j)]


SURFACES = {
    "saddle": (lambda edge: shapes.saddle(120.0, 200.0, edge), (3.0, 2.0, 0.02), (60.0, 60.0)),
    "torus": (lambda edge: shapes.torus(120.0, 50.0, edge, angle=150.0), (119.0, 13.0, 50.0), (40.0, 40.0)),
}


@pytest.mark.parametrize("name", SURFACES)
def test_nets_converge_to_that_of_the_finest_mesh(name):
    make, seed, reach = SURFACES[name]
    sizes, place, shear = [8.0, 4.0, 2.0, 1.0], np.zeros(4), np.zeros(4)
    finest = make(0.5)
    meshes = [make(size) for size in sizes]
    for shift in ((0.0, 0.0, 0.0), (-1.3, 2.1, 0.0), (2.2, 1.7, 0.0)):  # where the seed lies in its facet is chance
        start = finest.nearest(np.array([np.add(seed, shift)])).point[0]

        def net(surface, size, start=start):
            drawn = gd.drape(surface, start, 20.0, size, reach, reference=(1.0, 0.0, 0.0), project=True)
            return at_common_nodes(drawn, 8.0)

        points, angles = net(finest, 0.5)
        for n, size in enumerate(sizes):
            p, s = net(meshes[n], size)
            place[n] += np.nanmean(((p - points) ** 2).sum(axis=-1)) / 3
            shear[n] += np.nanmean((s - angles)[1:-1, 1:-1] ** 2) / 3
    # the heading is laid off in the facet at the seed, whose normal is only first order
    assert fitted_order(sizes, np.sqrt(place)) > 1.0
    assert fitted_order(sizes, np.sqrt(shear)) > 1.5
    assert np.sqrt(place[-1]) < 0.01
    assert np.sqrt(shear[-1]) < 0.01
