"""Intervals by left-out blocks: those of the covariance where that is right, wider where it is not."""

from dataclasses import replace

import numpy as np
import pytest

from geomdrap.criticism.experiment import Experiment
from geomdrap.criticism.fit import Fit
from geomdrap.criticism.holdout import blocks_of
from geomdrap.criticism.jackknife import jackknifed, widened
from geomdrap.criticism.layup import Layup
from geomdrap.criticism.likelihood import NO_SCATTER, deviations
from geomdrap.criticism.model import Fitted, Model

POINTS = 400
RNG = np.random.default_rng(2)
AT = RNG.uniform(-100.0, 100.0, (POINTS, 2))
SLOPES = np.column_stack([np.ones(POINTS), AT[:, 0] / 100.0, AT[:, 1] / 100.0])


def experiment():
    return Experiment(
        surface=None,
        measurement=None,
        layup=Layup("centroid", 0.0),
        at=AT,
        frames=np.tile(np.eye(3), (POINTS, 1, 1)),
        channels=("normal",),
        mask=np.ones((POINTS, 1), bool),
        noise=np.ones(POINTS),
        measured=np.zeros(POINTS),
        pitches=(4.0, 4.0),
    )


def model(residual):
    left = residual - SLOPES @ np.linalg.lstsq(SLOPES, residual, rcond=None)[0]
    return Fitted(Model(()), Fit(np.zeros(3), left, SLOPES, float(left @ left)))


def test_of_independent_noise_the_jackknife_finds_the_deviations_of_the_covariance():
    found = [jackknifed(experiment(), model(RNG.normal(size=POINTS)), NO_SCATTER) for _ in range(60)]
    np.testing.assert_allclose(np.sqrt(np.mean(np.square(found), axis=0)), deviations(SLOPES), rtol=0.2)


def test_what_whole_blocks_have_in_common_widens_the_interval():
    shifted = RNG.normal(size=POINTS) + 2.0 * RNG.normal(size=8)[blocks_of(AT)]
    found = widened(experiment(), model(shifted), NO_SCATTER)
    whole = np.hypot(deviations(SLOPES), found.doubt)
    assert (whole > 3.0 * deviations(SLOPES)).all()
    np.testing.assert_allclose(whole, jackknifed(experiment(), model(shifted), NO_SCATTER))


def test_an_interval_is_never_narrower_for_it_and_other_doubts_stay():
    calm = replace(model(0.1 * RNG.normal(size=POINTS)), doubt=np.array([0.3, 0.0, 0.0]))
    assert widened(experiment(), calm, NO_SCATTER).doubt == pytest.approx([0.3, 0.0, 0.0])


@pytest.mark.parametrize("elsewhere", [0.0, 1e-9, 1e-3])
def test_what_one_block_alone_shows_keeps_a_sane_interval(elsewhere):
    first = blocks_of(AT) == 0
    local = np.where(first, 1.0, elsewhere * RNG.normal(size=POINTS))
    slopes = np.column_stack([SLOPES, local, np.zeros(POINTS)])
    residual = RNG.normal(size=POINTS)
    there = Fitted(Model(()), Fit(np.zeros(5), residual, slopes, float(residual @ residual)))
    found = jackknifed(experiment(), there, NO_SCATTER)
    assert found[3] < 3.0 * deviations(slopes)[3]
    assert found[4] == 0.0  # nothing is seen of it, and its own deviation is infinite
    assert np.isfinite(widened(experiment(), there, NO_SCATTER).doubt).all()
