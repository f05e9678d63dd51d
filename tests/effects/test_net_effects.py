"""Effects that act on the finished net."""

from dataclasses import replace

import numpy as np
import pytest
from shared import drape

import geomdrap as gd
from geomdrap.effects.crossing_slip import CrossingSlip
from geomdrap.surface import shapes

CAP = shapes.sphere_cap(80.0, 60.0, 3.0)
SEED = (3.0, 2.0, 79.9)


def test_springback_takes_a_share_of_the_shear_and_leaves_the_crossings():
    plain, sprung = drape(CAP, origin=SEED), drape(CAP, "springback:fraction=0.2", origin=SEED)
    np.testing.assert_array_equal(sprung.points, plain.points)
    np.testing.assert_allclose(sprung.shear, 0.8 * plain.shear)
    np.testing.assert_allclose(sprung.cell_shear, 0.8 * plain.cell_shear)


def test_sliding_crossings_relieve_shear_and_leave_each_yarn_its_length():
    plain = drape(CAP, origin=SEED, pitch=6.0)
    slid = drape(CAP, "crossing-slip:share=0.4,onset=15", origin=SEED, pitch=6.0)
    assert not slid.warnings
    for axis, sides in enumerate(slid.sides):
        strain = sides / 6.0 - 1.0
        assert np.nanmax(abs(strain)) > 5e-3  # spacing becomes uneven
        assert abs(np.nansum(strain, axis=axis)).max() < 1e-5  # but no yarn gets longer
    sheared = abs(plain.cell_shear) > 25.0
    relieved = abs(plain.cell_shear) - abs(slid.cell_shear)
    assert relieved[sheared].min() > 0.5
    wanted = 0.4 * (abs(plain.cell_shear) - 15.0)
    assert (relieved[sheared] / wanted[sheared]).max() < 1.2
    assert np.nanmedian((relieved / wanted)[sheared]) > 0.3


def slid_on(part, share, onset):
    return gd.drape(part, SEED, pitch=6.0, effects=[CrossingSlip(share=share, onset=onset)], project=True)


@pytest.mark.parametrize(("share", "onset"), [(0.31, 15.0), (0.3, 15.5)])
def test_crossings_beside_those_that_have_slid_to_first_order(share, onset):
    near = slid_on(CAP, 0.3, 15.0)
    full = slid_on(CAP, share, onset).points - near.points
    quick = gd.effects.make("crossing-slip", share=share, onset=onset).beside(near).points - near.points
    assert np.isfinite(quick).sum() == np.isfinite(full).sum()
    assert np.sqrt(np.nanmean((quick - full) ** 2)) < 0.1 * np.sqrt(np.nanmean(full**2))


def test_what_derives_from_crossing_slip_is_not_taken_for_it():
    class More(CrossingSlip):
        name = "more-slip"

        def on_net(self, net):
            slid = super().on_net(net)
            return replace(slid, shear=slid.shear + 5.0)

    assert More(share=0.3, onset=15.0).beside(slid_on(CAP, 0.3, 15.0)) is None


def test_beside_crossings_that_have_not_slid_there_is_nothing_to_first_order():
    plain = drape(CAP, origin=SEED, pitch=6.0, reach=(30.0, 30.0))
    assert gd.effects.make("crossing-slip", share=0.3, onset=40.0).beside(plain) is None


def test_crossings_stay_where_shear_is_below_the_onset():
    plain = drape(CAP, origin=SEED, pitch=6.0, reach=(30.0, 30.0))
    slid = drape(CAP, "crossing-slip:share=0.5,onset=40", origin=SEED, pitch=6.0, reach=(30.0, 30.0))
    np.testing.assert_array_equal(slid.points, plain.points)
    assert not slid.warnings


def test_relief_grows_with_the_share():
    most = [
        np.nanmax(abs(drape(CAP, f"crossing-slip:share={s},onset=15", origin=SEED, pitch=6.0).cell_shear))
        for s in (1e-6, 0.2, 0.4)
    ]
    plain = np.nanmax(abs(drape(CAP, origin=SEED, pitch=6.0).cell_shear))
    assert most[0] == pytest.approx(plain, abs=1e-2)
    assert most[0] > most[1] > most[2]


def test_springback_comes_last():
    one = drape(CAP, "springback:fraction=0.5", "crossing-slip:share=0.3,onset=10", origin=SEED, pitch=8.0)
    slid = drape(CAP, "crossing-slip:share=0.3,onset=10", origin=SEED, pitch=8.0)
    np.testing.assert_allclose(one.cell_shear, 0.5 * slid.cell_shear)
    assert [e.name for e in one.effects] == ["crossing-slip", "springback"]


def test_curvature_is_not_held_against_a_net_that_was_changed():
    assert gd.evaluate(drape(CAP, "springback:fraction=0.5", origin=SEED)).checks.curvature_residual is None
    assert gd.evaluate(drape(CAP, "thickness:offset=1", origin=SEED)).checks.curvature_residual < 1.0
