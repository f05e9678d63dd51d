"""Nets beside one at rest, to first order or at rest again: as those that are draped, none where that cannot be.

Steps are so small that no cell at the rim comes or goes, which moves the nodes beside it by tenths of a millimetre.
"""

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.fishnet import Fabric
from geomdrap.fishnet.effect import in_order, net_with, surface_with
from geomdrap.fishnet.held_warp import HeldWarp
from geomdrap.fishnet.laid_down import laid_down
from geomdrap.fishnet.relax import BALANCED
from geomdrap.fishnet.sway import TAKEN, swayed, taken_along
from geomdrap.surface import shapes

SEED, ANGLE, PITCH = (4.0, -3.0, 50.0), 20.0, 8.0
HOLD = HeldWarp(length=16.0)


@pytest.fixture(scope="module")
def dome():
    plane = shapes.plane(240.0, 240.0, 2.0)
    x, y = plane.points[:, 0], plane.points[:, 1]
    return gd.Surface(np.column_stack([x, y, 50.0 * np.exp(-(x**2 + y**2) / 6000.0)]), plane.triangles)


def effects(of, shift=(0.0, 0.0, 0.0), **more):
    du, dv, dangle = shift
    made = [gd.effects.make(name, **values) for name, values in {**of, **more}.items()]
    return [gd.effects.make("placement", du=du, dv=dv, dangle=dangle), *made, HOLD]


def at_rest(part, acting, near=None):
    return gd.drape(part, SEED, ANGLE, PITCH, effects=acting, project=True, near=near)


def start_of(part, acting):
    acting = in_order(acting)
    return laid_down(surface_with(acting, part), SEED, ANGLE, PITCH, Fabric(), acting, None, True)


def to_first_order(part, near, acting):
    return swayed(near, start_of(part, acting))


def along(part, near, acting):
    return taken_along(near, start_of(part, acting))


SOFT = {"shear-stiffness": {"ratio": 0.02}}
CASES = [
    (SOFT, (0.0, 0.0, 0.0), {"shear-stiffness": {"ratio": 0.0202}}),
    (SOFT, (0.01, 0.0, 0.0), SOFT),
    (SOFT, (0.0, 0.0, 0.02), SOFT),
    ({"yarn-bending": {"length": 40.0}}, (0.0, 0.0, 0.0), {"yarn-bending": {"length": 40.4}}),
    ({"shear-asymmetry": {"alpha": 0.2}}, (0.0, 0.0, 0.0), {"shear-asymmetry": {"alpha": 0.202}}),
]


@pytest.mark.parametrize(("of", "shift", "then"), CASES)
def test_it_is_as_the_net_that_comes_to_rest_itself(dome, of, shift, then):
    near = at_rest(dome, effects(of))
    full, quick = at_rest(dome, effects(then, shift), near), to_first_order(dome, near, effects(then, shift))
    assert not near.warnings + full.warnings
    _, i, k = np.intersect1d(full.u, near.u, return_indices=True)
    _, j, m = np.intersect1d(full.v, near.v, return_indices=True)
    moved, error = (
        net.points[np.ix_(i, j)] - of_which.points[np.ix_(k, m)] for net, of_which in ((full, near), (full, quick))
    )
    assert np.isfinite(error).sum() > 0.95 * np.isfinite(full.points).sum()
    assert np.sqrt(np.nanmean(error**2)) < 0.03 * np.sqrt(np.nanmean(moved**2))
    shear = full.shear[np.ix_(i, j)] - near.shear[np.ix_(k, m)]
    left = full.shear[np.ix_(i, j)] - quick.shear[np.ix_(k, m)]
    assert np.sqrt(np.nanmean(left**2)) < 0.1 * np.sqrt(np.nanmean(shear**2)) + 0.002


@pytest.mark.parametrize(("of", "shift", "then"), CASES)
def test_a_net_taken_along_is_the_one_that_is_draped(dome, of, shift, then):
    """Both are at rest, on the same cells: they are one net, up to what is left of the forces."""
    near = at_rest(dome, effects(of))
    full, taken = at_rest(dome, effects(then, shift), near), along(dome, near, effects(then, shift))
    assert taken.balance.found.unrest < BALANCED
    _, i, k = np.intersect1d(full.u, taken.u, return_indices=True)
    _, j, m = np.intersect1d(full.v, taken.v, return_indices=True)
    error = full.points[np.ix_(i, j)] - taken.points[np.ix_(k, m)]
    moved = full.points[np.ix_(i, j)] - near.points[np.ix_(k, m)]
    assert np.isfinite(error).sum() > 0.95 * np.isfinite(full.points).sum()
    assert np.sqrt(np.nanmean(error**2)) < 0.02 * np.sqrt(np.nanmean(moved**2))
    for name in ("origin", "origin_face", "angle", "warp0", "weft0", "normal0"):
        np.testing.assert_allclose(getattr(taken, name), getattr(full, name), atol=1e-9)
    assert taken.fabric == full.fabric
    moves = full.moved[np.ix_(i, j)] - taken.moved[np.ix_(k, m)]
    assert np.nanmedian(np.abs(moves)) < 0.02 * np.nanmedian(np.linalg.norm(full.moved, axis=2))


def test_a_net_taken_along_sways_from_where_it_is(dome):
    """Crossings that slide see how a net lies at its seed."""
    taken = along(dome, at_rest(dome, effects(SOFT)), effects(SOFT, (0.3, -0.2, 0.1)))
    same = to_first_order(dome, taken, effects(SOFT, (0.3, -0.2, 0.1)))
    for name in ("origin", "origin_face", "angle", "warp0", "weft0", "normal0", "points", "shear"):
        np.testing.assert_allclose(getattr(same, name), getattr(taken, name), atol=1e-6)


@pytest.mark.parametrize(
    "law", [("shear-stiffness", "ratio", 0.02), ("yarn-bending", "length", 40.0), ("locking", "angle", 8.0)]
)
def test_many_short_ways_lead_where_one_long_one_does(dome, law):
    """No net is held back in another balance on its way: on the same cells there is one, and draped anew as well."""
    name, key, value = law
    first = taken = draped = at_rest(dome, effects({name: {key: value}}))
    for share in np.linspace(0.0, 1.0, 9)[1:]:
        then = effects({name: {key: value * 0.7**share}}, (0.4 * share, -0.3 * share, 0.1 * share))
        taken, draped = along(dome, taken, then), at_rest(dome, then, draped)
    assert np.nanmax(np.linalg.norm(taken.points - along(dome, first, then).points, axis=2)) < 1e-3
    assert np.nanmax(np.linalg.norm(draped.points - at_rest(dome, then).points, axis=2)) < 1e-3


def test_a_net_is_not_taken_along_to_where_other_cells_would_be_on_the_part(dome):
    near = at_rest(dome, effects(SOFT))
    assert along(dome, near, effects(SOFT, (0.7 * TAKEN * PITCH, 0.0, 0.0))) is not None
    assert along(dome, near, effects(SOFT, (1.1 * TAKEN * PITCH, 0.0, 0.0))) is None
    twice = along(dome, near, effects(SOFT, (0.7 * TAKEN * PITCH, 0.0, 0.0)))
    assert along(dome, twice, effects(SOFT, (1.1 * TAKEN * PITCH, 0.0, 0.0))) is None  # counted from where it was laid
    assert along(dome, near, effects({"locking": {"angle": 10.0}})) is None
    assert along(dome, near, effects(SOFT, thickness={"offset": 1.0})) is None


def test_it_is_none_where_more_than_placement_and_stiffness_differ(dome):
    near = at_rest(dome, effects(SOFT))
    assert to_first_order(dome, near, effects(SOFT, **{"yarn-extension": {"strain_warp": 0.01}})) is None
    assert to_first_order(dome, near, effects(SOFT, thickness={"offset": 1.0})) is None
    assert to_first_order(dome, near, effects({"locking": {"angle": 10.0}})) is None
    assert to_first_order(dome, at_rest(dome, effects({})), effects(SOFT)) is None


def test_it_holds_for_a_piece_of_several_and_under_effects_on_the_net(dome):
    """Springback acts on what comes to rest; a second piece of the part does not count."""
    points, triangles = dome.points, dome.triangles
    both = gd.Surface(np.vstack([points, points + [400.0, 0.0, 0.0]]), np.vstack([triangles, triangles + len(points)]))
    of, then = ({"springback": {"fraction": 0.2}, "shear-stiffness": {"ratio": r}} for r in (0.02, 0.0202))
    near, alone = at_rest(both, effects(of)), at_rest(dome, effects(of))
    np.testing.assert_allclose(near.shear, alone.shear, atol=1e-6)
    quick = net_with(in_order(effects(then)), to_first_order(both, near, effects(then)))
    full = at_rest(both, effects(then), near)
    known = np.isfinite(full.shear) & np.isfinite(quick.shear) & np.isfinite(near.shear)
    change, error = (full.shear - near.shear)[known], (full.shear - quick.shear)[known]
    assert known.sum() > 0.95 * np.isfinite(full.shear).sum()
    assert np.sqrt((error**2).mean()) < 0.1 * np.sqrt((change**2).mean())


def test_a_fabric_that_locks_is_swayed_along_its_plateau(dome):
    near = at_rest(dome, effects({"locking": {"angle": 8.0}}))
    then = effects({"locking": {"angle": 8.02}})
    full, quick = at_rest(dome, then, near), to_first_order(dome, near, then)
    change, error = full.shear - near.shear, full.shear - quick.shear
    assert np.sqrt(np.nanmean(error**2)) < 0.2 * np.sqrt(np.nanmean(change**2))
