"""Fibre directions that cannot be what the table says: swapped families, and directions out of the part."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.criticism.compare import compare_net
from geomdrap.criticism.layup import Layup
from geomdrap.criticism.prepare import prepare
from geomdrap.measurement.noise import noise_of_directions
from geomdrap.measurement.upright import without_upright
from geomdrap.surface import shapes

SIGMA = 0.5


@pytest.fixture(scope="module")
def case():
    """A net with warp along +x, and directions measured at places without labels."""
    net = gd.drape(shapes.sphere_cap(80.0, 60.0, 4.0), (0.0, 0.0, 80.0), 0.0, 5.0, project=True)
    u, v = (a.ravel() for a in np.meshgrid(np.arange(-36.0, 37.0, 8.0), np.arange(-36.0, 37.0, 8.0)))
    warp, weft = net.directions(u, v)
    points, _ = net.interpolate(u, v)
    rng = np.random.default_rng(0)
    warp, weft = (d + rng.normal(0.0, np.radians(SIGMA), d.shape) for d in (warp, weft))
    unit = [d / np.linalg.norm(d, axis=1, keepdims=True) for d in (warp, weft)]
    return net, gd.Measurement("fibres.csv", points, warp=unit[0], weft=unit[1])


def _swapped(m):
    return replace(m, warp=m.weft, weft=m.warp)


def test_good_directions_are_not_doubted(case):
    c = compare_net(*case)
    assert c.warnings == ()
    assert c.noise_warp.typical == pytest.approx(SIGMA, rel=0.2)


def test_swapped_warp_and_weft_are_noticed_and_their_noise_is_not_that_of_the_turn_by_a_right_angle(case):
    net, m = case
    c = compare_net(net, _swapped(m))
    (said,) = c.warnings
    assert (
        "fibres.csv: it looks as if the directions of warp and weft are swapped, or the heading is off by 90" in said
    )
    for noise in (c.noise_warp, c.noise_weft):
        assert noise.typical < 3.0 * SIGMA
    warnings = prepare(net.surface, _swapped(m), Layup((0.0, 0.0, 80.0), 0.0), sigma_xyz=0.2)[0].warnings
    assert any("are swapped" in w for w in warnings)


def test_a_heading_off_by_a_right_angle_is_said_of_the_labels_and_no_swap_of_the_directions(case):
    net, m = case
    u, v = (a.ravel() for a in np.meshgrid(np.arange(-36.0, 37.0, 8.0), np.arange(-36.0, 37.0, 8.0)))
    turned = gd.drape(net.surface, (0.0, 0.0, 80.0), 90.0, 5.0, project=True)
    (said,) = compare_net(turned, replace(m, u=u, v=v)).warnings
    assert "turned by 90 degrees" in said
    (said,) = compare_net(net, _swapped(replace(m, u=u, v=v))).warnings
    assert "directions of warp and weft are swapped" in said


@pytest.mark.parametrize(("family", "other"), [("warp", "weft"), ("weft", "warp")])
def test_one_family_that_is_the_other_is_noticed(case, family, other):
    net, m = case
    alone = replace(m, **{family: getattr(m, other), other: None})
    (said,) = compare_net(net, alone).warnings
    assert f"the directions of the {family} are those of the {other}" in said


@pytest.mark.parametrize("about", [0.0, 60.0, 89.0, 90.0, -75.0])
def test_the_noise_of_directions_is_the_same_about_any_turn(about):
    rng = np.random.default_rng(0)
    turn = about + rng.normal(0.0, 0.4, (400, 1))
    places = np.column_stack([x.ravel() * 10.0 for x in np.mgrid[:20, :20]])
    noise, _ = noise_of_directions(None, None, None, 90.0 - (90.0 - turn) % 180.0, None, places)
    assert noise.typical == pytest.approx(0.4, rel=0.1)


def test_directions_along_the_normal_are_left_out_and_do_not_raise_the_noise_of_the_others(case):
    net, m = case
    upright = np.tile([0.0, 0.0, 1.0], (len(m), 1))
    c = compare_net(net, replace(m, warp=upright))
    (said,) = c.warnings
    assert f"of {len(m)} warp directions (first in line 1) point out of the part" in said
    assert "check warp_x, warp_y, warp_z" in said
    assert int(said.split()[1]) > 0.9 * len(m)
    assert c.noise_weft.typical == pytest.approx(SIGMA, rel=0.2)
    few = m.warp.copy()
    few[[3, 40]] = [0.0, 0.1, -1.0]
    c = compare_net(net, replace(m, warp=few))
    assert f"fibres.csv: 2 of {len(m)} warp directions (first in line 4)" in c.warnings[0]
    assert np.isnan(c.measurement.warp[[3, 40]]).all()
    assert c.noise_warp.typical == pytest.approx(SIGMA, rel=0.2)


FEW = [3, 40, 57]


def _with_a_few(m, family):
    """Labelled marks with the directions of one family at a few of them only."""
    u, v = (a.ravel() for a in np.meshgrid(np.arange(-36.0, 37.0, 8.0), np.arange(-36.0, 37.0, 8.0)))
    few = np.full(m.warp.shape, np.nan)
    few[FEW] = getattr(m, family)[FEW]
    return replace(m, u=u, v=v, **{family: few})


@pytest.mark.parametrize(("family", "other"), [("warp", "weft"), ("weft", "warp")])
def test_a_few_directions_of_one_family_have_the_noise_of_the_other(case, family, other):
    net, m = case
    experiment, notes = prepare(net.surface, _with_a_few(m, family), Layup((0.0, 0.0, 80.0), 0.0), sigma_xyz=0.2)
    (said,) = [n for n in notes if f"direction of the {family}" in n]
    assert f"that of the {other}: there are too few directions of the {family}" in said
    assert float(said.split(" deg")[0].split()[-1]) == pytest.approx(SIGMA, rel=0.2)
    assert experiment.mask[:, experiment.channels.index(family)].sum() == len(FEW)
    assert np.isfinite(experiment.noise).all()


def test_a_few_directions_whose_noise_nothing_says_are_left_out_and_a_warning_says_so(case):
    net, m = case
    alone = replace(_with_a_few(m, "warp"), weft=None)
    experiment, _ = prepare(net.surface, alone, Layup((0.0, 0.0, 80.0), 0.0), sigma_xyz=0.2)
    (said,) = [w for w in experiment.warnings if "left out" in w]
    assert (
        "fibres.csv: there are too few directions of the warp to read their noise from them, and they are left out"
        in said
    )
    assert "give it (--sigma-direction)" in said
    assert "warp" not in experiment.channels
    assert experiment.measurement.warp is None
    told, _ = prepare(net.surface, alone, Layup((0.0, 0.0, 80.0), 0.0), sigma_xyz=0.2, sigma_direction=SIGMA)
    assert told.mask[:, told.channels.index("warp")].sum() == len(FEW)


def test_upright_warp_but_for_a_few_rows_does_not_end_the_diagnosis(case):
    net, m = case
    table = _with_a_few(m, "warp")
    upright = np.where(np.isfinite(table.warp), table.warp, [0.0, 0.0, 1.0])
    inner = np.hypot(table.u, table.v) < 30.0
    table = replace(table, warp=upright).take(inner | np.isin(np.arange(len(m)), FEW))
    experiment, notes = prepare(net.surface, table, Layup((0.0, 0.0, 80.0), 0.0), sigma_xyz=0.2)
    assert any("point out of the part" in w for w in experiment.warnings)
    assert any("too few directions of the warp" in n for n in notes)


def test_wild_warp_does_not_raise_the_noise_of_the_weft(case):
    net, m = case
    wild = m.warp + np.random.default_rng(1).normal(0.0, 0.2, m.warp.shape)
    c = compare_net(net, replace(m, warp=wild / np.linalg.norm(wild, axis=1, keepdims=True)))
    assert c.noise_warp.typical > 8.0 * SIGMA
    assert c.noise_weft.typical == pytest.approx(SIGMA, rel=0.2)


def test_a_direction_up_a_wall_is_on_the_part_up_to_the_edge_and_none_on_the_floor():
    corners = [[0.0, 0, 0], [100, 0, 0], [100, 100, 0], [0, 100, 0], [100, 0, 100], [100, 100, 100]]
    angle = gd.Surface(corners, [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]])
    up = np.tile([0.0, 0.0, 1.0], (3, 1))
    m = gd.Measurement("m.csv", np.array([[100.0, 50, 50], [100, 40, 0], [20, 50, 0]]), warp=up)
    kept = without_upright(angle, m)
    assert np.isfinite(kept.warp).all(axis=1).tolist() == [True, True, False]
    assert "1 of 3 warp directions (first in line 3)" in kept.warnings[0]
