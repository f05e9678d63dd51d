"""Nets that turn as a whole about their seed, and nets that refine a coarser one."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import geomdrap as gd
from geomdrap.fishnet.held_warp import HeldWarp
from geomdrap.fishnet.relax_net import gone_along
from geomdrap.surface import shapes

RADIUS = 80.0


@pytest.fixture(scope="module")
def bumps():
    """A part on which a soft net turns by 15 degrees about its seed: the first piece of its warp holds it but softly."""
    plane = shapes.plane(330.0, 250.0, 4.0)
    x, y = plane.points[:, 0], plane.points[:, 1]
    z = sum(
        h * np.exp(-((x - a) ** 2 + (y - b) ** 2) / 4800.0) for h, a, b in ((57.0, -70.0, 8.0), (36.0, 70.0, -8.0))
    )
    return gd.Surface(np.column_stack([x, y, z]), plane.triangles)


def laid(part, pitch, near=None, angle=50.0, held=()):
    soft = gd.effects.make("shear-stiffness", ratio=0.0027)
    return gd.drape(part, (-2.3, 7.7, 30.0), angle, pitch, effects=[soft, *held], project=True, near=near)


def rounds_of(net):
    return int(net.notes[-1].split()[-2])


@pytest.mark.parametrize(("angle", "most"), [(40.0, 37), (44.0, 30)])
def test_a_soft_net_comes_to_rest_though_it_turns(bumps, angle, most):
    """A straight step stretches a net that turns: where each had to lower the energy it took 74 and 46 rounds.

    At 40 degrees it begins on a ridge of the energy, from which Newton's step does not lead away.
    """
    net = laid(bumps, 4.0, angle=angle)
    assert not net.warnings
    assert rounds_of(net) < most


def test_a_refined_net_keeps_to_the_coarser_one(bumps):
    coarse = laid(bumps, 8.0)
    away = {}
    for name, near, held in (("refined", coarse, [HeldWarp(length=8.0)]), ("alone", None, [])):
        fine = laid(bumps, 4.0, near, held=held)
        _, i, k = np.intersect1d(fine.u, coarse.u, return_indices=True)
        _, j, m = np.intersect1d(fine.v, coarse.v, return_indices=True)
        apart = np.linalg.norm(fine.points[np.ix_(i, j)] - coarse.points[np.ix_(k, m)], axis=2)
        assert not fine.warnings
        away[name] = np.sqrt(np.nanmean(apart**2)), rounds_of(fine)
    assert away["refined"][0] < 0.6 * away["alone"][0]
    assert away["refined"][1] < away["alone"][1]


@pytest.mark.parametrize("pitch", [5.0, 7.5, 10.0])
def test_a_net_goes_the_way_of_a_coarser_one_between_its_nodes(pitch):
    """The coarser one has turned about the seed, and its ply lies at another heading than the finer one."""
    cap = shapes.sphere_cap(RADIUS, 60.0, 3.0)
    turn = Rotation.from_euler("z", 8.0, degrees=True).as_matrix()
    coarse, fine = (gd.drape(cap, (0.0, 0.0, RADIUS), a, p, project=True) for a, p in ((10.0, 10.0), (35.0, pitch)))
    start = gone_along(fine.lattice, fine, replace(coarse, moved=coarse.lattice @ turn.T - coarse.lattice))
    apart = np.linalg.norm(start - fine.lattice @ turn.T, axis=2)
    inside = (np.abs(fine.u)[:, None] < 40.0) & (np.abs(fine.v) < 40.0)
    assert apart[inside].max() < 0.02
    assert np.nanmax(apart) < 1.0


def test_nets_that_share_one_node_or_a_line_are_not_turned():
    plane = shapes.plane(120.0, 100.0, 10.0)
    large = gd.drape(plane, (0.0, 0.0, 0.0), 0.0, 10.0, reach=(40.0, 30.0))
    for keep in (np.s_[4:5, 3:4], np.s_[:, 3:4]):
        moved = np.full(large.lattice.shape, np.nan)
        moved[keep] = [0.0, 3.0, 0.0]
        start = gone_along(large.lattice, large, replace(large, moved=moved))
        known = np.isfinite(large.lattice[..., 0])
        np.testing.assert_allclose(start[known] - large.lattice[known], [[0.0, 3.0, 0.0]] * known.sum(), atol=1e-9)


def test_what_a_net_that_turned_leaves_bare_is_not_called_narrow(bumps):
    """A smaller pitch would not cover it: the command line must not be led to halve it."""
    bare = gd.evaluate(laid(bumps, 8.0, angle=40.0)).bare
    assert bare and all("has turned or drawn in" in region.reason for region in bare)
