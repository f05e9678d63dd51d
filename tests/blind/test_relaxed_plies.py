"""Relaxed nets: derivatives, minima, and what they keep."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geomdrap.blind import energy
from geomdrap.blind.ply import lay
from geomdrap.blind.recipe import Recipe
from geomdrap.blind.relax import _joined, _Problem
from geomdrap.blind.shear import node_shear
from geomdrap.blind.terms import bowl, bump
from geomdrap.blind.tools import Tool

SADDLE = Tool("saddle", bowl(1.0 / 150.0, -1.0 / 150.0), (130.0, 130.0))
SIDE = 10.0
RECIPES = {
    "stiffness": Recipe(stiffness=0.003),
    "asymmetry": Recipe(stiffness=0.003, asymmetry=0.4),
    "locking": Recipe(lock=12.0),
    "bending": Recipe(stiffness=0.001, bending=6.0),
    "crossing-slip": Recipe(share=0.3, onset=3.0),
}


@pytest.fixture(scope="module")
def geometric():
    return lay(SADDLE, Recipe(), SIDE)


@pytest.fixture(scope="module")
def nets():
    return {name: lay(SADDLE, recipe, SIDE) for name, recipe in RECIPES.items()}


def _problem(ply, recipe):
    known = np.isfinite(ply.plan[..., 0])
    net = energy.topology(known)
    seed = int(np.count_nonzero(known.ravel()[: known.size // 2]))
    return _Problem(ply.sheet, net, recipe, SIDE, ply.plan[known], seed), ply.plan[known]


@pytest.mark.parametrize("name", RECIPES)
def test_the_gradient_is_that_of_the_energy(geometric, name):
    problem, xy = _problem(geometric, RECIPES[name])
    rng = np.random.default_rng(0)
    xy = xy + rng.normal(0.0, 0.2, xy.shape)
    way = rng.normal(size=xy.shape)
    way[problem.seed] = 0.0
    slope = (problem.energy(xy + 1e-6 * way) - problem.energy(xy - 1e-6 * way)) / 2e-6
    assert 2.0 * problem.linear(xy)[2] @ way.ravel() == pytest.approx(slope, rel=1e-5)


@pytest.mark.parametrize("name", RECIPES)
def test_a_relaxed_net_is_at_rest(geometric, nets, name):
    problem, start = _problem(geometric, RECIPES[name])
    xy = nets[name].plan[np.isfinite(nets[name].plan[..., 0])]
    assert np.linalg.norm(problem.linear(xy)[2]) < 1e-2 * np.linalg.norm(problem.linear(start)[2])
    rng = np.random.default_rng(1)
    for size in (1e-2, 0.1):
        assert problem.energy(xy + size * rng.normal(size=xy.shape)) > problem.energy(xy)


@pytest.mark.parametrize("name", RECIPES)
def test_the_seed_and_the_heading_of_the_first_warp_side_are_held(geometric, nets, name):
    m = len(geometric.u) // 2
    assert nets[name].points[m, m] == pytest.approx(geometric.points[m, m])
    before, after = (net.points[m + 1, m] - net.points[m, m] for net in (geometric, nets[name]))
    assert before[1] / before[0] == pytest.approx(after[1] / after[0], abs=1e-4)


def test_shear_stiffness_lowers_the_shear_and_locking_stops_it_near_the_angle(geometric, nets):
    plain, stiff, locked = (np.abs(node_shear(net.points)) for net in (geometric, nets["stiffness"], nets["locking"]))
    assert np.nanmean(stiff**2) < np.nanmean(plain**2)
    assert np.nanpercentile(plain, 97) > 20.0
    assert np.nanpercentile(locked, 97) < 13.0


def test_asymmetric_stiffness_trades_shear_of_one_sign_for_the_other(nets):
    even, odd = (node_shear(nets[name].points) for name in ("stiffness", "asymmetry"))
    assert np.nanmean(odd) < np.nanmean(even) - 0.3  # positive shear is the stiffer one


def test_slip_at_the_crossings_relieves_shear_and_keeps_the_length_of_each_yarn(geometric, nets):
    slipped = nets["crossing-slip"]
    plain, relieved = (np.nanpercentile(np.abs(node_shear(net.points)), 90) for net in (geometric, slipped))
    assert relieved == pytest.approx(plain - 0.3 * (plain - 3.0), abs=1.5)
    sides = np.linalg.norm(np.diff(slipped.points, axis=0), axis=-1)
    assert np.nanstd(sides) > 0.02
    yarns = np.isfinite(sides).any(axis=0)
    assert np.nanmean(sides[:, yarns], axis=0) == pytest.approx(SIDE, rel=1e-3)
    assert np.nanmax(np.abs(sides / SIDE - 1.0)) > 5e-3


def test_a_ply_on_the_reference_saddle_locks_as_far_as_other_simulated_data_do():
    """Locked at 12° on z = (x² − y²)/300, an independent simulation moved 0.84 mm rms per axis from the pinned net."""
    plain, locked = lay(SADDLE, Recipe(), 4.0), lay(SADDLE, Recipe(lock=12.0), 4.0)
    moved = np.sqrt(np.nanmean((locked.points - plain.points) ** 2))
    assert 0.5 < moved < 1.2


def test_a_node_that_hangs_on_one_yarn_is_left_out_and_the_net_comes_to_rest():
    """Nothing holds such a node from swinging: one at a corner of this dome kept the whole ply from its rest."""
    tool = Tool("dome", bump(75.0, 2.0, -3.0, 64.0, 64.0), (152.0, 152.0))
    recipe = Recipe(start=(1.76, 5.17), angle=46.25, stiffness=0.003, asymmetry=0.47)
    geometric, ply = lay(tool, replace(recipe, stiffness=0.0, asymmetry=0.0), SIDE), lay(tool, recipe, SIDE)
    hanging = np.isfinite(geometric.plan[..., 0]) & ~np.isfinite(ply.plan[..., 0])
    assert hanging.any()
    known = np.isfinite(ply.plan[..., 0])
    net = energy.topology(known)
    seed = int(np.count_nonzero(known.ravel()[: known.size // 2]))
    problem = _Problem(ply.sheet, net, recipe, SIDE, ply.plan[known], seed)
    assert set(np.unique(net.sides)) == set(np.unique(net.corners))
    forces = [problem.linear(plan[known])[2].reshape(-1, 2) for plan in (ply.plan, geometric.plan)]
    rest, start = (np.delete(force, problem.first, axis=0) for force in forces)  # there the heading is held, by 1e6
    assert np.linalg.norm(rest) < 1e-4 * np.linalg.norm(start)


def test_cells_that_hang_on_one_yarn_or_one_node_are_left_out():
    known = np.zeros((15, 15), bool)
    known[4:11, 4:11] = True  # beside the seed, (7, 7)
    known[11, 7] = known[12:15, 6:9] = True  # beyond a bare yarn
    known[10:13, 10:13] = True  # joined at one node
    want = np.zeros_like(known)
    want[4:11, 4:11] = True
    np.testing.assert_array_equal(_joined(known), want)
    assert not _joined(np.eye(15, dtype=bool)).any()
