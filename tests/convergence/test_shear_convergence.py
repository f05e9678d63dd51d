"""Refine mesh and pitch together: shear and positions converge to the smooth surface's at second order."""

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
    sizes = np.array([1 / 4, 1 / 8, 1 / 16])
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
    seed = make(1.0).nearest(np.array([seed])).point[0]
    step, nets = 8.0, {}
    for size in (8.0, 4.0, 2.0, 0.5):
        nets[size] = at_common_nodes(
            gd.drape(make(size), seed, 20.0, size, reach, reference=(1.0, 0.0, 0.0), project=True), step
        )
    fine = nets.pop(0.5)
    place = [np.sqrt(np.nanmean(((p - fine[0]) ** 2).sum(axis=-1))) for p, _ in nets.values()]
    shear = [np.sqrt(np.nanmean((s[1:-1, 1:-1] - fine[1][1:-1, 1:-1]) ** 2)) for _, s in nets.values()]
    assert fitted_order(list(nets), place) > 1.5
    assert fitted_order(list(nets), shear) > 1.3
    assert place[-1] < 0.1
    assert shear[-1] < 0.1
