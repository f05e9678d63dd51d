"""Relaxed nets: derivatives, an independent minimum, any start, finer meshes, and the three effects that relax."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import minimize
from shared import assert_the_same_from_another_start, drape

import geomdrap as gd
from geomdrap.fishnet.dissection import AFTER
from geomdrap.fishnet.relax import relax
from geomdrap.fishnet.relax_energy import Law, derivatives, energy
from geomdrap.fishnet.relax_net import gone_along
from geomdrap.fishnet.relax_problem import HELD, chord_sines, pose, problem_of
from geomdrap.fishnet.relax_surface import stand
from geomdrap.surface import shapes

RADIUS = 80.0
SEED = (6.0, -4.0, 79.7)


def posed(surface, law=None, pitch=8.0, reach=(40.0, 40.0), **fabric):
    """A geometric net and the problem of relaxing it."""
    net = gd.drape(surface, SEED, 20.0, pitch, reach=reach, project=True)
    net = replace(net, fabric=replace(net.fabric, **fabric))
    return net, pose(net, law) if law else problem_of(net)


@pytest.mark.parametrize("law", [Law(0.02), Law(0.05, alpha=0.4), Law(0.01, lock=1.0, lock_sine=0.1)], ids=str)
def test_gradient_and_second_derivative_are_those_of_the_energy(law):
    rng = np.random.default_rng(3)
    x = np.stack([*np.meshgrid(np.arange(5.0), np.arange(4.0), indexing="ij"), np.zeros((5, 4))], axis=-1)
    x += 0.15 * rng.normal(size=x.shape)
    valid, target = np.ones((4, 3), bool), 0.05 * rng.normal(size=(4, 3, 2, 2))
    rests = np.full((4, 4), 1.1), np.full((5, 3), 0.9)
    basis = np.linalg.qr(rng.normal(size=(5, 4, 3, 3)))[0][..., :2].copy()
    g, h, _ = derivatives(x, basis, valid, target, *rests, law, True)
    way = rng.normal(size=(5, 4, 2))
    move = np.einsum("ijxa,ija->ijx", basis, way)
    step = 1e-6

    def gradient_along(s):
        return np.einsum(
            "ijxa,ijx->ija", basis, derivatives(x + s * move, basis, valid, target, *rests, law, True)[0]
        )

    slope = (
        energy(x + step * move, valid, target, *rests, law) - energy(x - step * move, valid, target, *rests, law)
    ) / (2 * step)
    assert slope == pytest.approx((g * move).sum(), rel=1e-6)
    bent = (gradient_along(step) - gradient_along(-step)) / (2 * step)
    applied = np.zeros_like(bent)
    for i, j in np.ndindex(5, 4):
        applied[i, j] += h[i, j, 0] @ way[i, j]
        for block, (di, dj) in zip(h[i, j, 1:], AFTER[1:], strict=True):
            if i + di < 5 and 0 <= j + dj < 4:
                applied[i, j] += block @ way[i + di, j + dj]
                applied[i + di, j + dj] += block.T @ way[i, j]
    np.testing.assert_allclose(applied, bent, atol=1e-6 * abs(bent).max())


def on_sphere(flat):
    """Points of the upper sphere over points of the plane."""
    return np.column_stack([flat, np.sqrt(RADIUS**2 - (flat**2).sum(axis=1))])


def corner_cosines(points, corners):
    """Cosines between the two sides at each corner (c, 3): the corner, its warp and its weft neighbour."""
    a, b = (points[corners[:, k]] - points[corners[:, 0]] for k in (1, 2))
    return (a * b).sum(axis=1) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1)


def plain_energy(points, laid, pieces, rests, corners, signs, law):
    """The definition, without any of the code under test; shear counts from that of ``laid``, None for none."""
    lengths = np.linalg.norm(points[pieces[:, 1]] - points[pieces[:, 0]], axis=1)
    cosine = corner_cosines(points, corners)
    off = cosine if laid is None else cosine - corner_cosines(laid, corners)
    stiffness = law.ratio * (1.0 + law.alpha * np.sign(signs * off))
    stored = ((lengths / rests - 1.0) ** 2).sum() + (stiffness * off**2).sum() / 4.0
    over = np.maximum(abs(cosine) - law.lock_sine, 0.0)
    return stored + law.lock * (over**2).sum() / 4.0


@pytest.mark.parametrize(
    ("fabric", "least"),
    [({"shear_stiffness": 0.05, "shear_asymmetry": 0.5}, 0.3), ({"locking_angle": 3.0}, 0.05)],
    ids=["asymmetric", "locking"],
)
def test_a_small_net_is_the_one_that_a_general_optimiser_finds_on_the_exact_sphere(fabric, least):
    net, problem = posed(shapes.sphere_cap(RADIUS, 50.0, 1.0), pitch=16.0, reach=(33.0, 33.0), **fabric)
    law, held = problem.law, "locking_angle" in fabric
    found = relax(problem, problem.footing)
    number = problem.number
    pieces, rests, corners, signs = [], [], [], []
    for i, j in np.argwhere(number >= 0):
        for di, dj, rest in ((1, 0, problem.rest_u), (0, 1, problem.rest_v)):
            if i < rest.shape[0] and j < rest.shape[1] and rest[i, j] > 0:
                pieces.append((number[i, j], number[i + di, j + dj]))
                rests.append(rest[i, j])
    for i, j in np.argwhere(problem.valid):
        for a in (0, 1):
            for b in (0, 1):
                signs.append(1.0 if a == b else -1.0)
                corners.append((number[i + a, j + b], number[i + 1 - a, j + b], number[i + a, j + 1 - b]))
    pieces, rests, corners, signs = (np.array(a) for a in (pieces, rests, corners, signs))
    start = problem.x0[number >= 0][:, :2]
    fixed, guided = number[problem.fixed], number[problem.guided]
    across = problem.side

    def points_of(unknown):
        flat = start + unknown.reshape(-1, 2)
        flat[fixed] = start[fixed]
        return on_sphere(flat)

    plane = on_sphere(start)[guided] @ across

    def objective(unknown):
        points = points_of(unknown)
        off = points[guided] @ across - plane  # the guided node stays in its plane
        laid = on_sphere(start) if held else None
        return plain_energy(points, laid, pieces, rests, corners, signs, law) + 10.0 * off**2

    best = minimize(objective, np.zeros(start.size), method="BFGS", options={"gtol": 1e-9, "maxiter": 2000})
    assert found.unrest < 1e-6
    assert found.energy == pytest.approx(best.fun, rel=1e-3)
    moved = np.linalg.norm(found.x[number >= 0] - problem.x0[number >= 0], axis=1).max()
    assert moved > least
    assert np.linalg.norm(found.x[number >= 0] - points_of(best.x), axis=1).max() < 0.05 * moved


@pytest.mark.parametrize(
    "fabric", [{"shear_stiffness": 0.003}, {"shear_asymmetry": 0.3}, {"locking_angle": 12.0}], ids=str
)
def test_the_net_is_the_same_from_any_start(fabric):
    net, problem = posed(shapes.sphere_cap(RADIUS, 60.0, 3.0), pitch=6.0, reach=None, **fabric)
    assert_the_same_from_another_start(net, problem, 1e-3, 1e-8)


def test_the_seed_and_the_heading_of_the_first_warp_piece_are_held():
    net, problem = posed(shapes.sphere_cap(RADIUS, 60.0, 3.0), shear_asymmetry=0.5)
    found = relax(problem, problem.footing)
    np.testing.assert_allclose(found.x[problem.fixed], problem.x0[problem.fixed], atol=1e-12)
    before, after = (x[problem.guided] - x[problem.fixed] for x in (problem.x0, found.x))
    assert abs((after - before) @ problem.side) < 1e-3


@pytest.mark.parametrize("effect", ["shear-stiffness:ratio=0.01", "locking:angle=10"])
def test_a_finer_mesh_gives_the_same_net(effect):
    nets = [
        drape(shapes.sphere_cap(RADIUS, 60.0, edge), effect, origin=SEED, pitch=8.0, reach=(45, 45))
        for edge in (6.0, 3.0, 1.5)
    ]
    away = [np.nanmax(np.linalg.norm(a.points - b.points, axis=2)) for a, b in pairwise(nets)]
    assert away[1] < 0.15
    assert away[1] < away[0]


def test_a_relaxed_net_has_less_energy_and_longer_yarns_than_the_geometric_one():
    net, problem = posed(shapes.sphere_cap(RADIUS, 60.0, 3.0), reach=None, shear_stiffness=0.01)
    found = relax(problem, problem.footing)
    start = energy(
        np.nan_to_num(problem.x0), problem.valid, problem.target, problem.rest_u, problem.rest_v, problem.law
    )
    assert found.energy < 0.95 * start
    relaxed = drape(
        shapes.sphere_cap(RADIUS, 60.0, 3.0), "shear-stiffness:ratio=0.01", origin=SEED, angle=20.0, pitch=8.0
    )
    assert np.nanmax(abs(relaxed.cell_shear)) < np.nanmax(abs(net.cell_shear)) + 1.0
    assert np.nanmax(abs(relaxed.sides[0] / 8.0 - 1.0)) > 1e-3


def test_flat_fabric_on_a_plane_stays_as_it_is():
    plain = drape(shapes.plane(120.0, 100.0, 10.0), angle=30.0)
    for effect in ("shear-stiffness:ratio=0.01", "locking:angle=10", "shear-asymmetry:alpha=0.4"):
        net = drape(shapes.plane(120.0, 100.0, 10.0), effect, angle=30.0)
        here = np.isfinite(net.points)
        np.testing.assert_allclose(net.points[here], plain.points[here], atol=1e-6)
        np.testing.assert_array_equal(net.cell_valid, plain.cell_valid)


def test_shear_goes_where_it_is_cheap():
    surface = shapes.sphere_cap(RADIUS, 60.0, 3.0)
    size = {}
    for alpha in (-0.5, 0.5):
        shear = drape(
            surface, f"shear-asymmetry:alpha={alpha}", origin=(0, 0, RADIUS), pitch=8.0, reach=(48, 48)
        ).cell_shear
        size[alpha] = np.nanmean(shear[shear > 0]), -np.nanmean(shear[shear < 0])
    assert size[0.5][0] < 0.8 * size[0.5][1]  # alpha > 0: positive shear is the dear one
    assert size[-0.5][0] == pytest.approx(size[0.5][1], rel=0.05)


def test_shear_stops_near_the_locking_angle_at_the_cost_of_yarn_length():
    surface = shapes.sphere_cap(RADIUS, 60.0, 3.0)
    free = drape(surface, origin=SEED, angle=20.0, pitch=8.0, reach=(48.0, 48.0))
    locked = drape(surface, "locking:angle=10", origin=SEED, angle=20.0, pitch=8.0, reach=(48.0, 48.0))
    assert not locked.warnings
    assert np.nanmax(abs(free.cell_shear)) > 17.0
    assert np.nanmax(abs(locked.cell_shear)) < 11.5
    assert np.nanmax(abs(locked.sides[0] / 8.0 - 1.0)) > 5e-3


def test_friction_takes_the_place_of_a_stiffness_that_is_nothing():
    cap = shapes.sphere_cap(RADIUS, 60.0, 3.0)
    for stiffness in (None, 0.0):
        _, problem = posed(cap, locking_angle=30.0, shear_stiffness=stiffness)
        assert problem.law.ratio == HELD
        np.testing.assert_array_equal(problem.target, chord_sines(problem.x0, problem.valid))
        assert abs(problem.target).max() > 0.1
    for fabric in ({"shear_stiffness": 0.01}, {"shear_asymmetry": 0.2}):
        _, problem = posed(cap, locking_angle=30.0, **fabric)
        assert 0.0 < problem.law.ratio < HELD
        assert (problem.target == 0.0).all()


def test_finer_nets_lock_in_the_same_way():
    """Yarns under pressure do not buckle from node to node; nets of 441, 1,681 and 6,561 nodes come to rest alike."""
    cap = shapes.sphere_cap(100.0, 60.0, 1.5)
    places, moved = [], []
    for pitch in (6.0, 3.0, 1.5):
        plain, net = (
            drape(cap, *effects, origin=(6.0, -4.0, 99.7), angle=20.0, pitch=pitch, reach=(60.0, 60.0))
            for effects in ((), ("locking:angle=10",))
        )
        assert not net.warnings
        every = np.ix_(*(np.argmin(abs(line - np.arange(-60, 61, 12)[:, None]), axis=1) for line in (net.u, net.v)))
        places.append(net.points[every])
        moved.append(np.linalg.norm(net.points[every] - plain.points[every], axis=2).max())
    change = [np.linalg.norm(a - b, axis=2).max() for a, b in pairwise(places)]
    assert min(moved) > 0.5
    assert change[0] < 0.07
    assert change[1] < 0.6 * change[0]  # of first order: rows at the rim have the most shear


def test_a_ply_that_locks_nowhere_lies_as_it_was_laid():
    surface = shapes.sphere_cap(RADIUS, 60.0, 3.0)
    free = drape(surface, origin=SEED, angle=20.0, pitch=8.0, reach=(48.0, 48.0))
    held = drape(surface, "locking:angle=60", origin=SEED, angle=20.0, pitch=8.0, reach=(48.0, 48.0))
    np.testing.assert_allclose(held.points, free.points, atol=1e-6)
    np.testing.assert_allclose(held.cell_shear, free.cell_shear, atol=1e-6)
    assert not held.warnings  # forces of rounding are no unrest


def test_the_unevenness_of_facets_keeps_no_net_from_coming_to_rest():
    net = drape(
        shapes.sphere_cap(100.0, 60.0, 1.8),
        "crossing-slip:share=0.3,onset=5",
        origin=(6.0, -4.0, 99.7),
        angle=20.0,
        pitch=float(np.sqrt(2e4 * np.pi * (1.0 - np.cos(np.pi / 3.0)) / 5000.0)),
    )
    assert not net.warnings


def test_relaxation_works_together_with_extension_and_placement():
    surface = shapes.sphere_cap(RADIUS, 60.0, 3.0)
    effects = ("shear-stiffness:ratio=0.003", "yarn-extension:strain_warp=0.02", "placement:du=3,dangle=2")
    one = drape(surface, *effects, origin=SEED, pitch=8.0)
    other = drape(surface, *effects[::-1], origin=SEED, pitch=8.0)
    np.testing.assert_array_equal(one.points, other.points)
    assert np.nanmean(one.sides[0]) == pytest.approx(8.0 * 1.02, rel=2e-3)
    seed = one.points[int(np.argmin(abs(one.u))), int(np.argmin(abs(one.v)))]
    np.testing.assert_allclose(seed, one.origin, atol=1e-9)


def test_a_relaxed_net_can_be_evaluated():
    net = drape(shapes.sphere_cap(RADIUS, 60.0, 3.0), "shear-stiffness:ratio=0.003", origin=SEED, pitch=6.0)
    result = gd.evaluate(net)
    assert result.area.coverage > 0.995
    assert result.checks.off_surface < 1e-9
    assert result.checks.edge_error < 1e-3
    on = np.isfinite(result.face_shear)
    assert np.percentile(abs(result.face_shear[on]), 95) < np.nanmax(abs(net.cell_shear)) + 2.0


def test_nodes_beyond_the_rim_are_off_the_part():
    net = drape(
        shapes.sphere_cap(RADIUS, 40.0, 3.0), "shear-stiffness:ratio=0.003", origin=(20.0, 10.0, 76.8), pitch=6.0
    )
    present = np.isfinite(net.points[..., 0])
    np.testing.assert_array_equal(net.status == 1, present)
    assert net.surface.nearest(net.points[present]).distance.max() < 1e-5
    assert (net.face >= 0).sum() == present.sum()


def test_a_net_relaxed_from_one_much_like_it_is_the_same():
    surface = shapes.sphere_cap(RADIUS, 60.0, 3.0)
    one, other = (
        gd.drape(surface, SEED, angle, 6.0, effects=[gd.effects.make("shear-stiffness", ratio=ratio)], project=True)
        for angle, ratio in ((20.0, 0.003), (20.4, 0.0035))
    )
    near = gd.drape(surface, SEED, 20.4, 6.0, effects=other.effects, project=True, near=one)
    assert not near.warnings
    assert np.nanmax(np.linalg.norm(near.points - other.points, axis=2)) < 1e-3
    rounds = [int(net.notes[-1].split()[-2]) for net in (other, near)]
    assert rounds[1] < 0.7 * rounds[0]


def test_yarns_that_the_other_net_has_not_go_the_way_of_their_neighbours():
    plane = shapes.plane(120.0, 100.0, 10.0)
    small = gd.drape(plane, (0.0, 0.0, 0.0), 0.0, 10.0, reach=(20.0, 20.0))
    large = gd.drape(plane, (0.0, 0.0, 0.0), 0.0, 10.0, reach=(40.0, 30.0))
    along = np.where(np.isfinite(small.lattice), [1.0, 0.0, 0.0], np.nan)
    start = gone_along(large.lattice, large, replace(small, moved=along))
    known = np.isfinite(large.lattice[..., 0])
    np.testing.assert_allclose((start - large.lattice)[known], [[1.0, 0.0, 0.0]] * known.sum(), atol=1e-9)


def test_beyond_the_rim_the_surface_goes_on_without_a_step():
    cap = shapes.sphere_cap(RADIUS, 60.0, 6.0)
    angle = np.linspace(0.0, np.pi, 4001)
    radius = np.linalg.norm(cap.points[:, :2], axis=1).max() + 4.0
    goal = np.column_stack(
        [radius * np.cos(angle), radius * np.sin(angle), np.full(len(angle), cap.points[:, 2].min())]
    )
    standing = stand(cap, goal)
    assert (standing.outside > 1.0).all()
    step = np.linalg.norm(np.diff(standing.lifted, axis=0), axis=1)
    assert step.max() < 2.0 * np.linalg.norm(np.diff(goal, axis=0), axis=1).max()
    out = goal[:, :2] / radius
    away = (standing.turning[:, :, :2] * out[:, None]).sum(axis=2)
    assert abs(away).max() < 0.2 * abs(standing.turning).max()  # straight on, but along the rim it turns


def test_beside_a_vertex_of_the_rim_it_goes_on_whichever_facet_is_asked():
    """Some of the facets round a vertex of the rim have no side there."""
    cap = shapes.sphere_cap(RADIUS, 60.0, 6.0)
    rim = np.flatnonzero(cap.on_rim)
    assert len(rim) == len(cap.boundary_loops[0])
    out = cap.points[rim] * [1.0, 1.0, 0.0]
    goal = cap.points[rim] + 3.0 * out / np.linalg.norm(out, axis=1, keepdims=True)
    fresh = stand(cap, goal)
    assert (fresh.outside > 1.0).all()
    for face in range(6):  # of the facets round each vertex
        around = [np.flatnonzero((cap.triangles == v).any(axis=1)) for v in rim]
        last = fresh._replace(face=np.array([f[face % len(f)] for f in around]))
        again = stand(cap, goal, last.face)
        np.testing.assert_allclose(again.lifted, fresh.lifted, atol=1e-6)
