"""Likelihoods under noise and scatter, against the plain formula and against made-up plies."""

import numpy as np
import pytest

from geomdrap.criticism.likelihood import NO_SCATTER, Judge, Residuals, Scatter, correlation_lengths
from geomdrap.criticism.scatter import Smoothness, scatter_covariance

CHANNELS = ("along", "across", "normal", "shear")


def grid(n=12, spacing=16.0):
    a, b = np.meshgrid(np.arange(n) * spacing, np.arange(n) * spacing, indexing="ij")
    return np.column_stack([a.ravel(), b.ravel()])


@pytest.fixture
def judge():
    at = grid()
    mask = np.ones((len(at), 4), bool)
    mask[::7, 3] = False
    noise = np.concatenate([np.full(mask[:, c].sum(), 0.6 if c == 3 else 0.2) for c in range(4)])
    return Judge(at, CHANNELS, mask, noise, 0.2)


def test_it_is_the_density_of_a_normal_distribution_at_the_best_parameters(judge):
    from scipy.stats import multivariate_normal

    rng = np.random.default_rng(0)
    m = len(judge.noise)
    model = Residuals(rng.normal(size=m), rng.normal(size=(m, 3)))
    scatter = Scatter(0.5, 35.0, Smoothness.ROUGH)
    covariance = 0.25 * scatter_covariance(judge.at, CHANNELS, judge.mask, 35.0, Smoothness.ROUGH)
    covariance += np.diag(judge.noise**2)
    inverse = np.linalg.inv(covariance)
    a = model.slopes
    best = np.linalg.solve(a.T @ inverse @ a, a.T @ inverse @ model.residual)
    exact = multivariate_normal(np.zeros(m), covariance).logpdf(model.residual - a @ best)
    got = judge.log_likelihood(scatter, [model])[0] - 0.5 * m * np.log(2.0 * np.pi)
    assert got == pytest.approx(exact, abs=1e-6 * abs(exact))


def test_the_scatter_that_was_put_in_is_found_again(judge):
    rng = np.random.default_rng(3)
    covariance = 0.5**2 * scatter_covariance(judge.at, CHANNELS, judge.mask, 40.0, Smoothness.SMOOTH)
    values, vectors = np.linalg.eigh(covariance)
    made = vectors @ (np.sqrt(np.maximum(values, 0.0)) * rng.normal(size=len(values)))
    model = Residuals(made + judge.noise * rng.normal(size=len(made)), np.zeros((len(made), 0)))
    scatter, _ = judge.best_scatter([model], [0])
    assert scatter[0].size == pytest.approx(0.5, rel=0.5)
    assert scatter[0].length == pytest.approx(40.0, rel=0.4)


def test_where_there_is_only_noise_no_scatter_is_found(judge):
    found = 0
    for seed in range(10):
        rng = np.random.default_rng(seed)
        m = len(judge.noise)
        scatter, _ = judge.best_scatter([Residuals(judge.noise * rng.normal(size=m), np.zeros((m, 0)))], [0])
        found += scatter[0].size > 0.06
    assert found <= 1


def test_a_perfect_model_leaves_noise_and_scatter(judge):
    assert judge.floor(Scatter(0.3, 40.0)) > 1.0
    assert judge.log_likelihood(NO_SCATTER, [Residuals(0.0 * judge.noise, np.zeros((len(judge.noise), 0)))])[0] == (
        pytest.approx(-np.log(judge.noise).sum())
    )


def test_correlation_lengths_go_from_the_spacing_to_a_good_part_of_the_patch():
    lengths = correlation_lengths(grid())
    assert 16.0 < lengths[0] < 24.0
    assert 35.0 < lengths[-1] <= 0.3 * 11 * 16.0 + 1e-9


@pytest.mark.parametrize(("size", "length", "kind"), [(0.6, 29.0, Smoothness.ROUGH), (0.3, 30.0, Smoothness.SMOOTH)])
def test_no_scatter_that_could_be_tried_is_much_likelier_than_the_one_found(judge, size, length, kind):
    from geomdrap.criticism.likelihood import SIZES, largest_scatter

    rng = np.random.default_rng(5)
    covariance = size**2 * scatter_covariance(judge.at, CHANNELS, judge.mask, length, kind)
    values, vectors = np.linalg.eigh(covariance)
    made = vectors @ (np.sqrt(np.maximum(values, 0.0)) * rng.normal(size=len(values)))
    model = Residuals(made + judge.noise * rng.normal(size=len(made)), np.zeros((len(made), 0)))
    _, found = judge.best_scatter([model], [0])
    known, again = judge.best_scatter([model], [0], Scatter(size, length, kind))
    assert again[0] > found[0] - 3.0  # from what is known it comes as far
    assert known[0].size == pytest.approx(size, rel=0.5)
    every = [Scatter(s * judge.unit, x, k) for s in SIZES[1:] for x in judge.lengths for k in Smoothness]
    allowed = [s for s in every if s.size <= largest_scatter(s.length)]
    assert found[0] > max(judge.log_likelihood(s, [model])[0] for s in allowed) - 3.0


@pytest.mark.parametrize("kind", Smoothness)
def test_the_shear_of_a_scatter_is_that_of_its_covariance(judge, kind):
    covariance = scatter_covariance(judge.at, CHANNELS, judge.mask, 35.0, kind)
    own = np.sqrt(np.diag(covariance)[-1])  # the last value is a shear
    assert Scatter(0.4, 35.0, kind).shear == pytest.approx(0.4 * own, rel=1e-9)
