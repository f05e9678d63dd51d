"""Structure against scatter: what moves whole yarns is found, scatter as lay-ups have it is not."""

from types import SimpleNamespace

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.blind import make
from geomdrap.cli.blind import _read
from geomdrap.criticism.ended import chosen, explains_the_rest
from geomdrap.criticism.evidence import Evidence
from geomdrap.criticism.leftover import Leftover, leftover
from geomdrap.criticism.likelihood import NO_SCATTER, Judge, Residuals, Scatter
from geomdrap.criticism.scatter import DEG, scatter_covariance
from geomdrap.criticism.search import Round

CHANNELS = ("along", "across", "shear")
SCATTER = Scatter(0.5, 38.0)
AT = np.stack(np.meshgrid(*2 * [16.0 * np.arange(-7, 8)], indexing="ij"), axis=-1).reshape(-1, 2)
N = len(AT)
MASK = np.ones((N, 3), bool)
NOISE = np.repeat([0.2, 0.2, 0.6], N)
EXPERIMENT = SimpleNamespace(
    at=AT,
    channels=CHANNELS,
    point_of=lambda: np.tile(np.arange(N), 3),
    channel_of=lambda: np.repeat(np.arange(3), N),
)
JUDGE = Judge(AT, CHANNELS, MASK, NOISE, 0.2)
PLACEMENT = np.column_stack(
    [np.repeat([1.0, 0.0, 0.0], N), np.repeat([0.0, 1.0, 0.0], N), np.concatenate([-AT[:, 1], AT[:, 0], np.zeros(N)])]
)


def judged(values):
    return leftover(EXPERIMENT, np.ones(3 * N, bool), JUDGE, Residuals(values, PLACEMENT), SCATTER)


def scattered(seed):
    rng = np.random.default_rng(seed)
    covariance = SCATTER.size**2 * scatter_covariance(AT, CHANNELS, MASK, SCATTER.length, SCATTER.kind)
    root = np.linalg.cholesky(covariance + 1e-9 * np.eye(3 * N))
    return root @ rng.normal(size=3 * N) + NOISE * rng.normal(size=3 * N)


def moved(shift, slope):
    """What weft yarns shifted along themselves by ``shift`` mm, ``slope`` mm per mm of u, change."""
    return np.concatenate([np.zeros(N), shift, DEG * slope])


def test_scatter_is_no_structure():
    p = np.array([judged(scattered(seed)).p_value for seed in range(30)])
    assert p.min() > 1e-4
    assert np.mean(p < 0.1) < 0.3


@pytest.mark.parametrize("seed", range(3))
def test_a_kink_of_the_warp_generator_is_structure_where_its_bend_and_turn_are_taken_out(seed):
    u = AT[:, 0]
    kink, step = 0.1 * np.maximum(u - 30.0, 0.0), 0.1 * (u > 30.0)
    bend = np.polyfit(u, kink, 2)
    found = judged(scattered(seed) + moved(kink - np.polyval(bend, u), step - np.polyval(np.polyder(bend), u)))
    assert found.structured
    assert found.channels


def test_what_is_left_is_doubtful_before_it_is_structure():
    kinds = [(1e-6, 1.0, True, True), (1e-3, 1.0, False, True), (0.3, 1.0, False, False), (1e-6, 0.1, False, False)]
    for p_value, size, structured, doubtful in kinds:
        left = Leftover(p_value, size, ())
        assert (left.structured, left.doubtful) == (structured, doubtful)


@pytest.mark.parametrize(("share", "explained"), [(0.5, False), (0.95, True)])
def test_what_might_be_scatter_is_explained_by_what_explains_nearly_all_of_it(share, explained):
    last = SimpleNamespace(evidence=[SimpleNamespace(name="steering", share=share)])
    assert explains_the_rest(last, "steering") is explained
    assert not explains_the_rest(last, None)


@pytest.mark.slow
def test_a_second_effect_that_scatter_could_take_for_its_own_is_looked_for(tmp_path):
    """Without it scatter of 0.5 mm is likeliest, where there is none."""
    make(72, folder=tmp_path, effect="yarn-extension+weave-skew", part="dome")
    found = gd.diagnose(**_read(tmp_path), effects=["weave-skew", "yarn-extension", "steering"])
    assert set(found.verdict.split("+")) == {"weave-skew", "yarn-extension"}
    assert found.scatter.size == 0.0
    assert found.steps[-1].error < 1.1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("effects", "seed", "options"),
    [
        ("weave-skew+springback", 715, {"part": "hat", "placement": "right"}),
        ("slip+springback", 716, {"part": "hat", "scatter": 0.3}),
        ("yarn-extension+springback", 83, {"part": "bowl", "points": 300}),
    ],
)
def test_a_first_effect_is_no_scatter_because_a_second_is_there_too(tmp_path, effects, seed, options):
    """The placement alone called a millimetre of it scatter: nothing was named, or one of the two for certain."""
    make(seed, folder=tmp_path, effect=effects, **options)
    found = gd.diagnose(**_read(tmp_path), effects=["weave-skew", "springback", "slip", "yarn-extension"])
    assert set(found.verdict.split("+")) == set(effects.split("+"))
    assert found.scatter.size < 0.3


@pytest.mark.parametrize(
    ("gain", "share", "before", "wanted"),
    [(400.0, 0.2, 0.5, True), (100.0, 0.9, 0.02, True), (100.0, 0.5, 0.02, False), (100.0, 0.9, 0.01, False)],
)
def test_a_second_effect_explains_a_part_of_all_or_most_of_what_needs_a_cause(gain, share, before, wanted):
    first = 10_000.0

    def round_of(name, chi2, less):
        base, trial = (
            SimpleNamespace(
                fit=SimpleNamespace(chi2=100.0 + x, residual=np.sqrt((100.0 + x) / 100.0) * np.ones(100)),
                model=SimpleNamespace(effects=effects),
            )
            for x, effects in ((chi2, ("slip",)), (chi2 - less, ("slip", name)))
        )
        evidence = (Evidence(name, 900.0, 1, 0.0, 0.0, share, 0.5, True),)
        rows, judge = np.ones(100, bool), SimpleNamespace(noise=np.ones(100))
        return Round(base, (trial,), evidence, (NO_SCATTER,) * 2, rows, judge, 1.0, ())

    rounds = [round_of("slip", first, first * (1.0 - before)), round_of("springback", first * before, gain)]
    assert (chosen(rounds) == "springback") is wanted
