"""Noise from repeats and from neighbours."""

from __future__ import annotations

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.measurement.local import deviations
from geomdrap.measurement.marks import mark_spacing, pitch_for_marks
from geomdrap.measurement.noise import noise_of, noise_of_directions, pooled, repeats_of

NOWHERE = np.full((40, 2), np.nan)


def _grid(n=20, spacing=10.0):
    u, v = (x.ravel() * spacing for x in np.mgrid[:n, :n])
    return np.column_stack([u, v])


def _noise(**more):
    n = len(more["values"])
    known = {"column": None, "given": None, "group": None, "residual": np.full((n, 1), np.nan), "places": np.full((n, 2), np.nan)}
    return noise_of("sigma_xyz", **{**known, **more})


def test_repeats_are_pooled_about_their_own_means():
    values = np.array([[0.0], [2.0], [10.0], [14.0], [99.0]])
    sigma, freedom = pooled(values, np.array([0, 0, 1, 1, 2]))
    assert freedom == 2
    assert sigma == pytest.approx(np.sqrt((2 + 8) / 2))


def test_marks_measured_twice_are_found_by_their_labels():
    u = np.array([0.0, 1.0, 0.0, 2.0])
    group = repeats_of(gd.Measurement("made", np.zeros((4, 3)), u=u, v=np.zeros(4)))
    assert group[0] == group[2]
    assert len(set(group.tolist())) == 3
    assert repeats_of(gd.Measurement("made", np.zeros((4, 3)), u=np.arange(4.0), v=np.zeros(4))) is None


@pytest.mark.parametrize("width", [1, 3])
def test_neighbours_show_the_noise_on_top_of_a_smooth_residual(width):
    places = _grid()
    smooth = np.outer(np.sin(places[:, 0] / 60.0) + 1e-4 * places[:, 1] ** 2, np.ones(width))
    ratios = []
    for seed in range(20):
        values = smooth + np.random.default_rng(seed).normal(0.0, 0.2, smooth.shape)
        noise, _ = _noise(values=values, residual=values, places=places)
        assert noise.source == "neighbour differences of the residual"
        ratios.append(noise.typical / 0.2)
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.03)


def test_a_tenth_of_outliers_hardly_moves_the_noise():
    places = _grid()
    rng = np.random.default_rng(0)
    values = rng.normal(0.0, 0.2, (400, 3))
    values[rng.choice(400, 40, replace=False)] += 8.0
    noise, _ = _noise(values=values, residual=values, places=places)
    assert noise.typical == pytest.approx(0.2, rel=0.15)


def test_the_sources_go_in_order_and_are_named():
    values = np.random.default_rng(0).normal(0.0, 0.1, (40, 3))
    group = np.repeat(np.arange(20), 2)
    column = np.full(40, 0.3)
    assert _noise(values=values, column=column, given=0.2, group=group)[0].source == "columns of the table"
    assert _noise(values=values, given=0.2, group=group)[0].source == "given"
    by_repeats = _noise(values=values, group=group)[0]
    assert by_repeats.source == "replicates"
    assert by_repeats.typical == pytest.approx(0.1, rel=0.2)
    assert _noise(values=values)[0].sigma is None


def test_open_cells_of_a_column_are_filled():
    column = np.array([0.3, np.nan])
    noise, _ = _noise(values=np.zeros((2, 3)), column=column, given=0.2)
    np.testing.assert_array_equal(noise.sigma, [0.3, 0.2])


def test_repeats_that_scatter_more_than_the_noise_given_are_reported():
    values = np.random.default_rng(0).normal(0.0, 0.5, (40, 3))
    group = np.repeat(np.arange(20), 2)
    _, warnings = _noise(values=values, given=0.1, group=group)
    assert "more than the noise of 0.1" in warnings[0]
    assert _noise(values=values, given=0.5, group=group)[1] == ()
    assert "less than the noise" in _noise(values=values, given=2.0, group=group)[1][0]


@pytest.mark.parametrize("slips", [[400, 403, 407, 410, 414], [401]])
def test_slips_among_repeats_are_no_noise(slips):
    places = np.concatenate([_grid()] + [_grid()[:20]])
    values = np.random.default_rng(0).normal(0.0, 0.2, (420, 3))
    values[slips, 2] += 80.0
    group = np.concatenate([np.arange(400), np.arange(20)])
    noise, said = _noise(values=values, residual=values, places=places, group=group)
    assert noise.source == "replicates"
    assert noise.typical == pytest.approx(0.2, rel=0.2)
    assert said == ()
    assert _noise(given=0.2, values=values, residual=values, places=places, group=group)[1] == ()


def test_a_noise_that_neighbours_contradict_is_questioned():
    places = _grid()
    values = np.random.default_rng(0).normal(0.0, 0.2, (400, 3))
    known = {"values": values, "residual": values, "places": places}
    (said,) = _noise(given=20.0, **known)[1]
    for words in ("20 mm", "--sigma-xyz", "set-up", "0.19 mm at most", "leave it out"):
        assert words in said
    (said,) = _noise(column=np.full(400, 20.0), **known)[1]
    assert "the column sigma_xyz" in said
    assert "take the column out" in said
    for fair in (0.2, 0.5, 0.01):  # neighbours differ by structure too: that a noise is too small, they do not show
        assert _noise(given=fair, **known)[1] == ()
    structure = values + 5.0 * np.sin(places[:, :1] / 5.0)
    assert _noise(given=3.0, values=structure, residual=structure, places=places)[1] == ()


def test_a_right_noise_is_not_questioned_by_chance_even_with_few_points():
    for seed in range(300):
        rng = np.random.default_rng(seed)
        values = rng.normal(0.0, 0.2, (20, 1))
        assert _noise(given=0.2, values=values, residual=values, places=rng.uniform(0.0, 100.0, (20, 2)))[1] == ()


@pytest.mark.parametrize("sigma", [0.0, -1.0, np.nan, np.inf])
def test_a_noise_that_is_none_is_refused(sigma):
    with pytest.raises(gd.MeasurementError, match="sigma_xyz"):
        _noise(values=np.zeros((4, 3)), given=sigma)


def test_a_plane_deviates_nowhere():
    places = np.random.default_rng(0).uniform(0.0, 100.0, (60, 2))
    values = places @ np.array([[1.0, 2.0], [-0.5, 0.3]]) + 7.0
    off, factor = deviations(places, values)
    np.testing.assert_allclose(off, 0.0, atol=1e-2)  # the planes are held up a little where places lie on a line
    assert (factor > 1.0).all()


@pytest.mark.parametrize("spacing", [1.0, 16.0, 0.3])
def test_the_spacing_of_marks_is_found_although_some_are_lost(spacing):
    places = _grid(12, spacing)
    kept = np.random.default_rng(0).random(len(places)) < 0.7
    assert mark_spacing(places[kept, 0]) == pytest.approx(spacing)


def test_points_in_no_order_have_no_spacing():
    assert mark_spacing(np.random.default_rng(0).uniform(0, 100, 200)) is None
    assert mark_spacing(None) is None


def test_the_pitch_divides_the_spacing():
    assert pitch_for_marks(16.0, 5.0) == 4.0
    assert pitch_for_marks(16.0, 8.0) == 8.0
    assert pitch_for_marks(16.0, 20.0) == 16.0
    assert pitch_for_marks(None, 5.0) == 5.0
    assert pitch_for_marks(0.6, 5.0) == pytest.approx(4.8)


def test_directions_take_the_noise_of_the_shear_only_where_nothing_else_says_theirs():
    turn = np.random.default_rng(0).normal(0.0, 0.4, (400, 2))
    group = np.repeat(np.arange(200), 2)
    nowhere, places = np.full((400, 2), np.nan), _grid()
    given, said = noise_of_directions(None, 0.7, 3.0, turn, None, places)
    assert (given.typical, said) == (0.7, ())
    repeats, said = noise_of_directions(None, None, 3.0, turn, group, places)
    assert (repeats.source, said) == ("replicates", ())
    neighbours, said = noise_of_directions(None, None, 3.0, turn, None, places)
    assert neighbours.typical == pytest.approx(0.4, rel=0.1)
    assert said == ()
    of_shear, (said,) = noise_of_directions(None, None, 3.0, turn, None, nowhere)
    assert of_shear.typical == pytest.approx(3.0 / np.sqrt(2.0))
    assert "noise of the shear over √2" in said
    column = np.where(np.arange(400) < 200, 0.5, np.nan)
    filled, (said,) = noise_of_directions(column, None, 3.0, turn, None, nowhere)
    np.testing.assert_allclose(filled.sigma[[0, -1]], [0.5, 3.0 / np.sqrt(2.0)])
    assert noise_of_directions(None, None, None, turn, None, nowhere)[0].sigma is None


def test_a_noise_of_the_shear_that_is_none_is_refused_for_directions_too():
    with pytest.raises(gd.MeasurementError, match="sigma_shear"):
        noise_of_directions(None, None, -1.0, np.zeros((4, 2)), None, np.zeros((4, 2)))
