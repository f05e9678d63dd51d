"""Fitting with few predictions: right answers, bounds, and places that predict nothing."""

import numpy as np
import pytest

from geomdrap.criticism.fit import fit, take_slopes

WIDE = (np.full(2, -100.0), np.full(2, 100.0))
STEPS = np.full(2, 0.01)


def same(a):
    return a


def curve(p):
    t = np.linspace(0.0, 2.0, 40)
    return p[0] * np.exp(-p[1] * t)


def test_a_linear_model_is_solved_in_one_step_as_least_squares_solves_it():
    rng = np.random.default_rng(0)
    a, y = rng.normal(size=(30, 2)), rng.normal(size=30)
    calls = []

    def predict(p):
        calls.append(p)
        return a @ p

    got = fit(predict, y, same, np.zeros(2), STEPS, *WIDE)
    np.testing.assert_allclose(got.values, np.linalg.lstsq(a, y, rcond=None)[0], atol=1e-8)
    assert len(calls) <= 6


def test_a_curved_model_is_found_from_noisy_values_as_scipy_finds_it():
    from scipy.optimize import least_squares

    y = curve(np.array([3.0, 1.5])) + np.random.default_rng(1).normal(0.0, 0.02, 40)
    exact = least_squares(lambda p: y - curve(p), [1.0, 0.5]).x
    got = fit(curve, y, lambda a: a / 0.02, np.array([1.0, 0.5]), STEPS, *WIDE)
    spread = np.sqrt(np.diag(np.linalg.inv(got.slopes.T @ got.slopes / 0.02**2)))
    # a step that promises less than 0.05 of chi-square is not taken, and sqrt(0.05) of a spread gains as much
    assert (np.abs(got.values - exact) < 0.2 * spread).all()
    assert got.chi2 == pytest.approx((((y - curve(exact)) / 0.02) ** 2).sum(), abs=0.1)


def test_values_stay_within_their_bounds_and_the_rest_is_the_best_there():
    y = curve(np.array([3.0, 1.5]))
    got = fit(curve, y, same, np.array([1.0, 0.5]), STEPS, np.zeros(2), np.array([10.0, 1.0]))
    assert got.values[1] == 1.0
    base = curve(np.array([1.0, 1.0]))
    assert got.values[0] == pytest.approx(base @ y / (base @ base), rel=1e-3)


def test_values_that_a_step_can_no_longer_predict_are_reported_and_pull_nowhere():
    y = curve(np.array([3.0, 1.5]))

    def shrinking(p):
        out = curve(p)
        out[:5] = np.nan if p[0] > 2.0 else out[:5]
        return out

    got = fit(shrinking, y, same, np.array([1.0, 1.5]), STEPS, *WIDE)
    assert np.isnan(got.residual[:5]).all()
    assert np.isfinite(got.residual[5:]).all()
    assert got.values[0] == pytest.approx(3.0, abs=0.05)


def test_slopes_lean_away_from_a_bound():
    at = np.array([1.0, 1.0])
    got = take_slopes(curve, at, curve(at), STEPS, np.zeros(2), np.array([1.0, 1.0]))
    t = np.linspace(0.0, 2.0, 40)
    np.testing.assert_allclose(got, np.column_stack([np.exp(-t), -t * np.exp(-t)]), atol=0.02)


def test_a_parameter_that_only_rounding_shows_stays_where_it_is():
    rng = np.random.default_rng(2)

    def predict(p):
        return curve(p[:2]) + 1e-7 * np.sin(1e6 * p[2] + np.arange(40))

    y = curve(np.array([3.0, 1.5])) + 0.02 * rng.normal(size=40)
    bounds = np.array([-100.0, -100.0, 1.0]), np.array([100.0, 100.0, 90.0])
    got = fit(predict, y, lambda a: a / 0.02, np.array([1.0, 0.5, 40.0]), np.array([0.01, 0.01, 5.0]), *bounds)
    assert got.values[2] == 40.0
    assert got.values[:2] == pytest.approx([3.0, 1.5], abs=0.1)


def test_what_is_held_is_not_moved_to_take_slopes_and_keeps_its_own():
    asked = []

    def predict(values):
        asked.append(values.copy())
        return np.array([values[0] ** 3, values[0] * values[1], values[1]])

    start, steps = np.array([2.0, 0.3]), np.array([0.1, 0.2])
    slopes = np.array([[-5.0, 0.0], [0.3, 2.0], [0.0, 1.0]])  # the first is wrong, and is taken anew
    found = fit(
        predict,
        np.array([1.0, 0.3, 0.3]),
        lambda a: a,
        start,
        steps,
        np.array([0.0, 0.3]),
        np.array([9.0, 0.3]),
        slopes,
    )
    assert all(values[1] == 0.3 for values in asked)
    assert found.values[0] == pytest.approx(1.0, abs=0.1)
    np.testing.assert_allclose(found.slopes[:, 1], slopes[:, 1], atol=1e-12)


def test_slopes_are_taken_within_a_range_smaller_than_the_step():
    asked = []

    def predict(values):
        asked.append(values[0])
        return 3.0 * values

    got = take_slopes(predict, np.array([0.4]), np.array([1.2]), np.array([1.0]), np.array([0.0]), np.array([0.5]))
    assert got[0, 0] == pytest.approx(3.0)
    assert all(0.0 <= x <= 0.5 for x in asked)


def test_a_fit_ends_where_a_step_gains_less_than_is_asked():
    y = curve(np.array([3.0, 1.5]))
    chi2 = [
        fit(curve, y, lambda a: a / 0.02, np.array([1.0, 0.5]), STEPS, *WIDE, small=small).chi2
        for small in (1e-9, 50.0)
    ]
    assert chi2[0] < 1e-3 < chi2[1]


def test_what_a_model_leaves_counts_as_noise_where_it_is_more(monkeypatch):
    """A fit of many values ends where it would if their noise were as large as what no such curve fits."""
    x = np.linspace(0.0, 4.0, 2000)

    def wave(p):
        return p[0] * np.exp(-p[1] * x)

    y = wave(np.array([3.0, 1.5])) + 0.3 * np.random.default_rng(1).normal(size=2000)

    def count(noise):
        calls = []

        def predict(p):
            calls.append(p)
            return wave(p)

        got = fit(predict, y, lambda a: a / noise, np.array([1.0, 0.5]), STEPS, *WIDE)
        return len(calls), got.values

    (few, values), (same_count, same_values) = count(0.3), count(0.003)
    assert few == same_count
    np.testing.assert_allclose(values, same_values, rtol=1e-9)
    monkeypatch.setattr("geomdrap.criticism.fit.MANY", 1e12)
    assert count(0.003)[0] > few


def test_a_step_that_breaks_its_promise_does_not_end_a_fit():
    """Slopes that are given are ten times too steep: the first step gains little, and they are taken anew."""
    a = np.random.default_rng(3).normal(size=(40, 2))
    y = a @ [2.0, -1.0]
    y *= np.sqrt(1000.0 / (y @ y))
    got = fit(lambda p: a @ p, y, same, np.zeros(2), 10.0 * STEPS, *WIDE, slopes=10.0 * a, small=400.0)
    assert got.chi2 < 1.0


def test_fresh_slopes_are_not_taken_again_where_a_step_fails():
    asked = []
    edge = np.array([2.0, 1.0])

    def predict(p):
        asked.append(p.copy())
        return curve(p) if (p == edge).all() else np.full(40, 100.0)

    slopes = take_slopes(curve, edge, curve(edge), STEPS, *WIDE)
    fit(predict, curve(np.array([2.5, 1.1])), same, edge, STEPS, *WIDE, slopes, 3, are_fresh=True)
    assert len(asked) == 4  # where it began, and three steps


def test_a_fit_that_stays_far_above_what_is_asked_is_given_up():
    y = curve(np.array([3.0, 1.5]))

    def count(measured, enough):
        calls = []

        def predict(p):
            calls.append(p)
            return curve(p)

        fit(predict, measured, lambda a: a / 0.02, np.array([1.0, 0.5]), STEPS, *WIDE, enough=enough)
        return len(calls)

    far = y + 10.0  # nothing of the kind fits
    assert count(far, 1e3) < count(far, np.inf)
    assert count(y, 1e3) == count(y, np.inf)


def test_a_step_goes_no_further_than_a_hundred_times_a_parameters_own():
    asked = []

    def predict(p):
        asked.append(p.copy())
        return np.array([p[0], 1e-3 * p[1]])

    fit(predict, np.array([50.0, 50.0]), lambda a: a / 1e-3, np.zeros(2), STEPS, *WIDE)
    assert np.abs(np.diff(asked, axis=0)).max() <= 100.0 * STEPS[0] + 2.0 * STEPS[0]
    assert np.abs(asked).max() > 1.0


def test_what_a_step_over_a_threshold_shows_is_no_slope():
    """Below 0 the model is another one, and far off: the slopes are those of where the fit stays."""
    a = np.random.default_rng(5).normal(size=(30, 2))
    y = a @ [1.0, -1.0]

    def predict(p):
        return a @ p + (1e3 if p[1] < 0.0 else 0.0)

    got = fit(predict, y, same, np.array([0.0, 0.01]), STEPS, *WIDE)
    assert got.values[1] >= 0.0
    np.testing.assert_allclose(got.slopes, a, atol=0.05)


def test_what_a_small_step_changes_is_asked_before_a_prediction():
    asked = []

    def beside(at, step):
        asked.append(step.copy())
        return np.full(40, 7.0) * step[0] if step[0] else None

    at = np.array([0.5, 0.25])
    got = take_slopes(curve, at, curve(at), STEPS, np.zeros(2), np.ones(2), beside=beside)
    plain = take_slopes(curve, at, curve(at), STEPS, np.zeros(2), np.ones(2))
    assert len(asked) == 2
    np.testing.assert_allclose(got[:, 0], 7.0)
    np.testing.assert_array_equal(got[:, 1], plain[:, 1])


def test_slopes_that_last_are_not_taken_at_the_start():
    asked = []

    def predict(p):
        asked.append(p.copy())
        return curve(p)

    start = np.array([1.5, 0.8])
    known = take_slopes(curve, start, curve(start), STEPS, *WIDE)
    wrong = known.copy()
    wrong[:, 1] = 0.0  # of the second: taken anew
    got = fit(predict, curve(np.array([2.0, 1.0])), lambda a: 1e3 * a, start, STEPS, *WIDE, wrong, lasting=1)
    np.testing.assert_allclose(got.values, [2.0, 1.0], atol=1e-3)
    moved = [np.flatnonzero(p != start) for p in asked[:4]]
    assert [1] in [list(m) for m in moved]
    assert [0] not in [list(m) for m in moved]
