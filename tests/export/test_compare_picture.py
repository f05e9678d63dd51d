"""compare.png: scales and words by exact checks, the page by what stands on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from analytic_tools import measured
from PIL import Image

import geomdrap as gd
from geomdrap.cli.compare_summary import summary
from geomdrap.criticism.compare import compare_net
from geomdrap.export.compare_legend import key_figures
from geomdrap.export.compare_picture import draw, draw_before_after, figure_of
from geomdrap.export.compare_scale import nice_above, nice_below, scale_of, signed_values
from geomdrap.export.compare_trend_plot import verdict


@pytest.fixture(scope="module")
def before():
    surface, m, laid = measured("steering")
    return gd.compare(surface, m, **{**laid, "pitch": 16.0})


@pytest.fixture(scope="module")
def after(before):
    """The same measurement with most of the residual taken out."""
    m = before.measurement
    known = np.nan_to_num(before.vector)
    return compare_net(before.net, replace(m, points=m.points - 0.9 * known), sigma_xyz=0.2, sigma_shear=0.6)


def _words(figure):
    from matplotlib.text import Text

    return "\n".join(text.get_text() for text in figure.findobj(Text))


@pytest.mark.parametrize("value", [0.013, 0.2, 0.99, 1.0, 3.7, 250.0])
def test_round_numbers_enclose_the_value(value):
    assert nice_below(value) <= value * (1 + 1e-9)
    assert nice_above(value) >= value * (1 - 1e-9)
    assert nice_above(value) <= 2.5 * nice_below(value)


def test_one_scale_holds_both_comparisons(before, after):
    both, first = scale_of([before, after]), scale_of([before])
    assert both.size >= np.nanquantile(after.size, 0.98)
    assert both.size <= first.size
    assert both.factor >= first.factor
    assert scale_of([after]).factor > first.factor


def test_the_page_says_the_numbers_the_factor_and_the_worst_place(before):
    words = _words(figure_of(before))
    assert f"{before.scores.position.robust_rms:.3g} mm" in words
    assert f"× {scale_of([before]).factor:g}" in words
    assert "Worst:" in words
    assert "noise alone" in words
    assert "without prediction" in words
    assert "far along" in words


def test_residuals_of_the_size_of_the_noise_are_noise_only_where_neighbours_are_no_more_alike(before):
    m = replace(before.measurement.take(np.flatnonzero(before.used)), shear=None)
    there, _ = before.net.interpolate(m.u, m.v)
    noise = np.random.default_rng(3).normal(0.0, 0.2, there.shape)
    wave = 0.2 * np.sqrt(2.0) * np.sin((m.u + 2.0 * m.v)[:, None] / 60.0 + np.arange(3.0))
    scattered, waved = (
        compare_net(before.net, replace(m, points=there + off), sigma_xyz=0.2) for off in (noise, wave)
    )
    assert all(c.scores.position.rms < 1.1 * c.scores.position.noise for c in (scattered, waved))
    assert ["noise only" in _words(figure_of(c)) for c in (scattered, waved)] == [True, False]
    # in step with the words of the summary, which are on the shear, too
    _, shear = before.net.interpolate(m.u, m.v)
    waved_shear = replace(m, points=there + noise, shear=shear + wave[:, 0])
    assert "noise only, unlike the shear" in _words(figure_of(compare_net(before.net, waved_shear, sigma_xyz=0.2)))
    assert ["neighbours are alike" in summary(c, {}) for c in (scattered, waved)] == [False, True]


def test_loud_numbers_are_in_alarm_colours_and_quiet_ones_are_not(before):
    surface, m, laid = measured("springback")
    quiet = gd.compare(surface, m, **laid)
    colours = [colour for _, _, colour in key_figures(quiet)]
    assert colours[0] != colours[1]  # positions at the noise, shear above it
    loud = [colour for _, _, colour in key_figures(before)]
    assert loud[0] == loud[1] == colours[1]


def test_an_outlier_makes_no_number_loud(before):
    m = replace(before.measurement.take(np.flatnonzero(before.used)), shear=None)
    there, _ = before.net.interpolate(m.u, m.v)
    points = there + np.random.default_rng(3).normal(0.0, 0.2, there.shape)
    colours, numbers = [], []
    for off in (0.0, 40.0):
        points[7, 2] += off
        got = compare_net(before.net, replace(m, points=points), sigma_xyz=0.2)
        assert bool(got.outliers) is (off > 0.0)
        number, _, colour = key_figures(got)[0]
        numbers.append(float(number.split()[0]))
        colours.append(colour)
    assert colours[0] == colours[1]
    assert numbers[1] == pytest.approx(numbers[0], rel=0.02)


def test_pages_are_written_as_pictures(before, after, tmp_path):
    draw(before, tmp_path / "one.png")
    draw_before_after(before, after, tmp_path / "two.png")
    for name in ("one.png", "two.png"):
        with Image.open(tmp_path / name) as image:
            assert image.size[0] == 1920
            assert np.asarray(image.convert("L")).std() > 10.0


def test_the_same_comparison_gives_the_same_bytes(before, tmp_path):
    draw(before, tmp_path / "a.png")
    draw(before, tmp_path / "b.png")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_dots_show_shear_else_directions_else_the_distance(before):
    m = before.measurement
    assert signed_values(before)[2] == "°"
    warp, _ = before.net.directions(m.u, m.v)
    turned = compare_net(before.net, replace(m, shear=None, warp=warp))
    assert "Warp" in signed_values(turned)[1]
    bare = compare_net(before.net, replace(m, shear=None))
    assert signed_values(bare)[2] == " mm"


def test_a_few_points_without_labels_or_noise_make_a_page_too(before, tmp_path):
    m = before.measurement
    few = gd.Measurement("few", m.points[:4])
    c = compare_net(before.net, few)
    assert c.scores.chi2_per_dof is None
    draw(c, tmp_path / "few.png")
    words = _words(figure_of(c))
    assert "noise not known" in words
    assert "stands out of the noise" not in words


def test_the_verdict_on_a_trend_follows_its_probability(before):
    trend = before.trends[0]
    assert verdict(replace(trend, rho=0.6, p=0.001)).startswith("grows with it")
    assert verdict(replace(trend, rho=-0.6, p=0.001)).startswith("falls with it")
    assert verdict(replace(trend, rho=-0.6, p=0.05)).startswith("may fall")
    assert verdict(replace(trend, rho=0.6, p=0.5)).startswith("no trend beyond chance")
