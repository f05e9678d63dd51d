"""Residuals of known size and direction; scores beside the noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from analytic_tools import measured
from made_parts import bumpy_sheet

import geomdrap as gd
from geomdrap.criticism.compare import compare_net
from geomdrap.criticism.compare_regions import worst_regions
from geomdrap.surface import shapes


@pytest.fixture(scope="module")
def net():
    return gd.drape(bumpy_sheet(), (1.0, 2.0, 0.0), 25.0, 4.0, project=True)


@pytest.fixture(scope="module")
def exact(net):
    """What the net itself says at some marks: labels, points, shear, directions."""
    u, v = (x.ravel() for x in np.meshgrid(np.arange(-32.0, 33.0, 8.0), np.arange(-32.0, 33.0, 8.0)))
    points, shear = net.interpolate(u, v)
    known = np.isfinite(shear)
    warp, weft = net.directions(u, v)
    return gd.Measurement(
        "made", points[known], u=u[known], v=v[known], shear=shear[known], warp=warp[known], weft=weft[known]
    )


def test_a_net_agrees_with_itself(net, exact):
    c = compare_net(net, exact)
    assert c.used.all()
    np.testing.assert_allclose(c.size, 0.0, atol=1e-9)
    np.testing.assert_allclose(c.shear, 0.0, atol=1e-9)
    np.testing.assert_allclose(c.warp_turn, 0.0, atol=1e-6)


def test_residuals_are_measured_less_predicted_and_split_along_the_yarns(net, exact):
    normal = np.cross(exact.warp, exact.weft)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    moved = replace(
        exact, points=exact.points + 0.3 * exact.warp - 0.2 * exact.weft + 0.1 * normal, shear=exact.shear + 2
    )
    c = compare_net(net, moved)
    np.testing.assert_allclose(c.parts, [[0.3, -0.2, 0.1]] * len(exact), atol=1e-9)
    np.testing.assert_allclose(c.shear, 2.0, atol=1e-9)
    back = np.einsum("nk,knj->nj", c.parts, np.stack([c.matched.warp, c.matched.weft, c.matched.normal]))
    np.testing.assert_allclose(back, c.vector, atol=1e-9)


@pytest.mark.parametrize("turn", [-60.0, -3.0, 3.0, 60.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_directions_turn_counter_clockwise_about_the_normal_and_have_no_head(net, exact, turn, sign):
    normal = np.cross(exact.warp, exact.weft)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    a = np.radians(turn)
    warp = sign * (np.cos(a) * exact.warp + np.sin(a) * np.cross(normal, exact.warp))
    tilted = warp + 0.1 * normal  # a measured direction need not lie in the model's tangent plane
    c = compare_net(net, replace(exact, warp=tilted / np.linalg.norm(tilted, axis=1, keepdims=True)))
    np.testing.assert_allclose(c.warp_turn, turn, atol=1e-6)
    np.testing.assert_allclose(c.weft_turn, 0.0, atol=1e-6)


def test_without_labels_the_residual_is_the_signed_distance_from_the_part():
    surface = shapes.plane(100.0, 100.0, 10.0)
    points = np.array([[0.0, 5.0, 0.4], [10.0, -8.0, -0.3], [-22.0, 3.0, 0.0]])
    c = gd.compare(surface, gd.Measurement("made", points), origin="centroid", angle=0.0, pitch=5.0, sigma_xyz=0.5)
    np.testing.assert_allclose(c.parts, [[0, 0, 0.4], [0, 0, -0.3], [0, 0, 0]], atol=1e-9)
    np.testing.assert_allclose([c.matched.u, c.matched.v], points[:, :2].T, atol=1e-9)
    position = c.scores.position
    assert position.rms == pytest.approx(np.sqrt((0.4**2 + 0.3**2) / 3))
    assert position.noise == pytest.approx(0.5)
    assert c.scores.chi2_per_dof == pytest.approx((0.4**2 + 0.3**2) / 3 / 0.25)


def test_scores_are_of_vectors_and_beside_the_noise_of_vectors(net, exact):
    rng = np.random.default_rng(0)
    noisy = replace(exact, points=exact.points + rng.normal(0, 0.2, exact.points.shape), warp=None, weft=None)
    c = compare_net(net, noisy, sigma_xyz=0.2, sigma_shear=1.0)
    position, shear = c.scores.position, c.scores.shear
    assert position.rms == pytest.approx(np.sqrt(np.mean(c.size**2)))
    assert position.noise == pytest.approx(0.2 * np.sqrt(3.0))
    assert position.rms == pytest.approx(position.noise, rel=0.15)
    assert (position.dof, shear.dof) == (3 * len(exact), len(exact))
    total = np.sum(c.vector**2) / 0.04 + np.sum(c.shear**2)
    assert c.scores.chi2_per_dof == pytest.approx(total / (4 * len(exact)))


def test_outliers_count_in_the_rms_but_not_in_chi2(net, exact):
    rng = np.random.default_rng(0)
    points = exact.points + rng.normal(0, 0.2, exact.points.shape)
    points[30] += [0.0, 0.0, 5.0]
    c = compare_net(net, replace(exact, points=points, warp=None, weft=None, shear=None), sigma_xyz=0.2)
    assert [o.row for o in c.outliers] == [30]
    assert not c.trusted[30]
    assert c.scores.position.rms > 1.5 * c.scores.position.robust_rms
    assert c.scores.chi2_per_dof == pytest.approx(1.0, abs=0.3)
    assert any("stand out" in warning for warning in c.warnings)


def test_marks_lie_on_nodes_where_the_pitch_is_open():
    surface, m, laid = measured("springback")
    c = gd.compare(surface, m, **laid)
    assert c.net.pitch == pytest.approx(16.0 / round(16.0 / c.net.pitch))
    assert any("marks" in note for note in c.notes)


def test_rows_without_a_prediction_are_kept_with_a_reason(net, exact):
    more = replace(exact, u=exact.u + np.where(np.arange(len(exact)) == 4, 500.0, 0.0))
    c = compare_net(net, more)
    assert c.used.sum() == len(exact) - 1
    assert c.matched.reason[4] == "beyond the rim of the net"
    assert np.isnan(c.vector[4]).all()
    assert np.isnan(c.places.rim[4])


def test_a_measurement_without_any_prediction_is_refused(net, exact):
    with pytest.raises(gd.MeasurementError, match=r"none of its .* points has a prediction"):
        compare_net(net, replace(exact, u=exact.u + 900.0))


def test_without_a_hidden_effect_nothing_but_noise_is_left():
    surface, m, laid = measured("none")
    x, y, _ = laid["origin"]
    on_vertex = (x, y, 85.0 * np.exp(-(x**2 + y**2) / 85.0**2))
    c = gd.compare(surface, m, **{**laid, "origin": on_vertex})
    assert c.scores.chi2_per_dof == pytest.approx(1.0, abs=0.12)
    assert c.scores.position.rms == pytest.approx(c.scores.position.noise, rel=0.05)
    assert not worst_regions(c)
    assert all(likeness.p > 0.01 for likeness in (c.structure.position, c.structure.shear))


def test_an_origin_at_a_vertex_written_with_four_decimals_does_as_well():
    surface, m, laid = measured("none")
    assert gd.compare(surface, m, **laid).scores.chi2_per_dof == pytest.approx(1.0, abs=0.12)


@pytest.mark.xfail(
    strict=True, reason="beside a vertex the heading counts in the plane of the facet, 0.1 degrees off"
)
def test_an_origin_beside_a_vertex_does_as_well():
    surface, m, laid = measured("none")
    x, y, z = laid["origin"]
    beside = (x + 0.003, y + 0.002, z)
    assert gd.compare(surface, m, **{**laid, "origin": beside}).scores.chi2_per_dof == pytest.approx(1.0, abs=0.12)


@pytest.mark.parametrize(
    ("name", "least", "most"), [("steering", 50, 400), ("weave-skew", 50, 400), ("springback", 2, 4)]
)
def test_an_independent_simulator_is_matched_to_its_noise_only_where_no_effect_is_hidden(name, least, most):
    surface, m, laid = measured(name)
    c = gd.compare(surface, m, **laid)
    assert c.used.mean() > 0.98
    assert worst_regions(c)
    assert least < c.scores.chi2_per_dof < most
    assert not c.outliers


def test_noise_that_was_not_given_is_found_in_the_data():
    surface, m, laid = measured("steering")
    c = gd.compare(surface, m, origin=laid["origin"], angle=laid["angle"])
    assert c.noise_xyz.typical == pytest.approx(0.2, rel=0.1)
    assert c.noise_shear.typical == pytest.approx(0.6, rel=0.1)


def test_an_effect_goes_into_the_net():
    class Springback(gd.Effect):
        def on_net(self, net):
            return replace(net, shear=0.82 * net.shear, cell_shear=0.82 * net.cell_shear)

    surface, m, laid = measured("springback")
    with_effect = gd.compare(surface, m, effects=[Springback()], **laid)
    assert with_effect.scores.chi2_per_dof == pytest.approx(1.0, abs=0.15)
