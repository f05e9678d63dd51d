"""Yarns that resist bending: derivatives, rest from any start, finer meshes, and what bending does."""

from dataclasses import replace

import numpy as np
import pytest
from shared import assert_the_same_from_another_start, drape

import geomdrap as gd
from geomdrap.fishnet.dissection import FURTHER
from geomdrap.fishnet.relax import relax
from geomdrap.fishnet.relax_bending import add_bending, bending_energy
from geomdrap.fishnet.relax_problem import BENT_RATIO, problem_of
from geomdrap.surface import shapes

RADIUS = 9.0
BEND = 3.0


def uneven_net(seed=3):
    """Nodes (5, 4, 3) on a sphere about the origin, tangent vectors there, and rest lengths; one piece is missing."""
    rng = np.random.default_rng(seed)
    x = np.stack([*np.meshgrid(np.arange(5.0), np.arange(4.0), indexing="ij"), np.full((5, 4), RADIUS)], axis=-1)
    x = on_sphere(x + 0.15 * rng.normal(size=x.shape))
    basis = np.linalg.qr(np.concatenate([x[..., None], rng.normal(size=(5, 4, 3, 2))], axis=-1))[0][..., 1:].copy()
    rests = rng.uniform(0.9, 1.2, (4, 4)), rng.uniform(0.9, 1.2, (5, 3))
    rests[0][2, 1] = 0.0
    return x, basis, rests, rng


def on_sphere(x):
    return RADIUS * x / np.linalg.norm(x, axis=2, keepdims=True)


EVERYWHERE = np.ones((2, 5, 4), bool)


def energy_of(x, rest_u, rest_v):
    return bending_energy(x, x / RADIUS, EVERYWHERE, rest_u, rest_v, BEND)


def derivatives(x, basis, rests, full=True):
    g, h, size = np.zeros((5, 4, 3)), np.zeros((5, 4, 7, 2, 2)), np.zeros((5, 4))
    turning = np.broadcast_to(np.eye(3) / RADIUS, (5, 4, 3, 3)).copy()
    add_bending(x, basis, x / RADIUS, turning, EVERYWHERE, *rests, BEND, full, g, h, size)
    return g, h, size


def applied(h, way):
    """The second derivative (5, 4, 7, 2, 2) times a motion (5, 4, 2)."""
    out = np.zeros_like(way)
    for i, j in np.ndindex(5, 4):
        out[i, j] += h[i, j, 0] @ way[i, j]
        for block, (di, dj) in zip(h[i, j, 1:], FURTHER[1:], strict=True):
            if i + di < 5 and 0 <= j + dj < 4:
                out[i, j] += block @ way[i + di, j + dj]
                out[i + di, j + dj] += block.T @ way[i, j]
    return out


def test_the_gradient_is_that_of_the_energy_while_normals_turn():
    x, basis, rests, rng = uneven_net()
    move = np.einsum("ijxa,ija->ijx", basis, rng.normal(size=(5, 4, 2)))
    step = 1e-5
    ahead, behind = (on_sphere(x + s * move) for s in (step, -step))
    slope = (energy_of(ahead, *rests) - energy_of(behind, *rests)) / (2 * step)
    assert slope == pytest.approx((derivatives(x, basis, rests)[0] * move).sum(), rel=1e-7)


def test_the_second_derivative_is_that_of_the_energy_along_great_circles():
    x, basis, rests, rng = uneven_net()
    way = rng.normal(size=(5, 4, 2))
    move = np.einsum("ijxa,ija->ijx", basis, way)
    speed = np.linalg.norm(move, axis=2, keepdims=True) / RADIUS

    def energy_along(s):
        y = x * np.cos(s * speed) + move / speed * np.sin(s * speed)
        return energy_of(y, *rests)

    step = 2e-4
    bent = (energy_along(step) - 2.0 * energy_along(0.0) + energy_along(-step)) / step**2
    g, h, _ = derivatives(x, basis, rests)
    pressure = (g * x).sum(axis=2) / RADIUS**2  # what ``along_tangents`` takes off
    found = (way * applied(h, way)).sum() - (pressure * (way**2).sum(axis=2)).sum()
    assert found == pytest.approx(bent, rel=1e-6)


def test_without_turns_of_turns_the_second_derivative_is_positive():
    x, basis, rests, rng = uneven_net()
    h = derivatives(x, basis, rests, full=False)[1]
    for _ in range(20):
        way = rng.normal(size=(5, 4, 2))
        assert (way * applied(h, way)).sum() > 0.0


CAP = shapes.sphere_cap(80.0, 60.0, 3.0)
SADDLE = shapes.grid_surface(lambda x, y: (x**2 - y**2) / 300.0, np.linspace(-60, 60, 61), np.linspace(-60, 60, 61))
TOP, MIDDLE = (6.0, -4.0, 79.7), (6.0, -4.0, 0.07)


def posed(surface, seed, pitch=6.0, **fabric):
    """A geometric net and the problem of relaxing it."""
    net = gd.drape(surface, seed, 20.0, pitch, project=True)
    net = replace(net, fabric=replace(net.fabric, **fabric))
    return net, problem_of(net)


@pytest.mark.parametrize("length", [5.0, 20.0, 80.0])
@pytest.mark.parametrize(("surface", "seed"), [(CAP, TOP), (SADDLE, MIDDLE)], ids=["cap", "saddle"])
def test_the_net_is_the_same_from_any_start(surface, seed, length):
    net, problem = posed(surface, seed, bending_length=length)
    assert_the_same_from_another_start(net, problem, 2e-3, 1e-7)


def test_flat_fabric_on_a_plane_stays_as_it_is():
    plain = drape(shapes.plane(120.0, 100.0, 10.0), angle=30.0)
    net = drape(shapes.plane(120.0, 100.0, 10.0), "yarn-bending:length=60", angle=30.0)
    here = np.isfinite(net.points)
    np.testing.assert_allclose(net.points[here], plain.points[here], atol=1e-6)
    assert not net.warnings


def test_a_finer_mesh_and_a_finer_net_give_the_same_places():
    def places(edge, pitch):
        surface = shapes.sphere_cap(80.0, 60.0, edge)
        net = drape(surface, "yarn-bending:length=40", origin=TOP, angle=20.0, pitch=pitch, reach=(48.0, 48.0))
        every = np.ix_(*(np.argmin(abs(line - np.arange(-48, 49, 8)[:, None]), axis=1) for line in (net.u, net.v)))
        return net.points[every]

    coarse, fine = places(1.5, 8.0), places(1.5, 4.0)
    assert np.nanmax(np.linalg.norm(coarse - fine, axis=2)) < 0.5
    assert np.nanmax(np.linalg.norm(places(3.0, 4.0) - fine, axis=2)) < 0.15


def test_the_stiffer_the_yarns_the_less_they_bend():
    bends = []
    for length in (0.01, 30.0, 80.0):
        net, problem = posed(SADDLE, MIDDLE, bending_length=length)
        found = relax(problem, problem.footing)
        normal = problem.on_net(found.footing.normal)
        bends.append(bending_energy(found.x, normal, problem.smooth, problem.rest_u, problem.rest_v, 1.0))
    assert bends[1] < 0.95 * bends[0]
    assert bends[2] < 0.95 * bends[1]


def test_a_length_of_nothing_leaves_the_net_to_the_shear():
    one, other = (
        drape(SADDLE, effect, origin=MIDDLE, angle=20.0, pitch=6.0)
        for effect in ("yarn-bending:length=0.001", "shear-stiffness:ratio=0.001")
    )
    np.testing.assert_allclose(one.points, other.points, atol=1e-4)


def test_the_length_is_that_to_the_stiffness_in_shear_that_is_given():
    for fabric, ratio in (
        ({}, BENT_RATIO),
        ({"shear_stiffness": 0.01}, 0.01),
        ({"shear_asymmetry": 0.2}, BENT_RATIO),
    ):
        law = posed(SADDLE, MIDDLE, 12.0, bending_length=30.0, **fabric)[1].law
        assert law.ratio == ratio
        assert law.bend == pytest.approx(900.0 * ratio)


def test_effects_of_bending_add_their_stiffness():
    effects = [gd.effects.make("yarn-bending", length=value) for value in (30.0, 40.0)]
    net = gd.drape(SADDLE, MIDDLE, 20.0, 12.0, effects=effects, project=True)
    assert net.fabric.bending_length == pytest.approx(50.0)


@pytest.mark.parametrize("fold", [35.0, 90.0])
def test_yarns_that_cross_an_edge_on_the_skew_have_no_turn_there(fold):
    # two planes are developable: the geometric net has straight yarns and no shear, and must stay as it is
    part = roof(fold)
    bending, stiffness = gd.effects.make("yarn-bending", length=60.0), gd.effects.make("shear-stiffness", ratio=0.001)
    net, bent, sheared = (
        gd.drape(part, (20.0, 3.0, height(20.0, fold)), 30.0, 6.0, reference=(1, 0, 0), effects=effects)
        for effects in ([], [bending], [stiffness])
    )
    moved, usual = (np.nanmax(np.linalg.norm(x.points - net.points, axis=2)) for x in (bent, sheared))
    assert moved < 1.5 * usual + 0.1
    assert np.nanmax(np.abs(bent.cell_shear)) < 2.5


def height(x, fold):
    return -np.tan(np.radians(fold / 2.0)) * abs(x)


def roof(fold):
    """Two planes that meet at x = 0 in an edge of ``fold`` degrees."""
    flat = shapes.plane(200.0, 160.0, 8.0)
    points = flat.points.copy()
    points[:, 2] = height(points[:, 0], fold)
    return gd.Surface(points, flat.triangles)
