"""How yarns turn beyond the net: slopes of the shear, their signs, and what is made of them."""

import numpy as np
import pytest

from geomdrap.fields.gradient import bend_cells, complete_ends, gradient_near, one_sided, shear_gradients, turn_by


def linear(nu, nv, along_u, along_v):
    i, j = np.indices((nu, nv))
    return along_u * i + along_v * j


def test_a_linear_shear_has_its_slopes_everywhere_the_rim_included():
    shear = linear(6, 7, 0.03, -0.02)
    shear[:2, :3] = np.nan
    shear[5, 6] = np.nan
    found = shear_gradients(shear)
    for i, j in np.argwhere(np.isfinite(shear)):
        assert gradient_near(found, i + 0.5, j + 0.5) == pytest.approx((0.03, -0.02), abs=1e-12)
    assert np.isnan(found[1, 1]).all()  # between cells that are not there


def test_a_jump_is_not_carried_on():
    shear = np.zeros((8, 3))
    shear[4:] = 0.5
    assert [gradient_near(shear_gradients(shear), p, 1.5)[0] for p in (1.5, 4.0, 7.5, 9.0)] == [0.0] * 4
    shear = np.zeros((8, 3))
    shear[-1] = 0.5  # the last cell alone
    assert [gradient_near(shear_gradients(shear), p, 1.5)[0] for p in (7.0, 7.5, 9.0)] == [0.0] * 3


def test_beyond_the_rim_slopes_are_those_of_the_same_row_or_column():
    i, j = np.indices((9, 9))
    shear = 0.02 * np.maximum(i - 4, 0) + 0.01 * np.maximum(j - 4, 0)  # a wall: f(u) + g(v)
    shear[i + j > 10] = np.nan
    found = shear_gradients(shear)
    for p, q, slopes in ((5.5, 5.5, (0.02, 0.01)), (8.0, 3.5, (0.02, 0.0)), (3.5, 8.0, (0.0, 0.01))):
        assert gradient_near(found, p, q) == pytest.approx(slopes, abs=1e-12)


def test_a_cell_alone_takes_the_slope_of_the_nearest_cells():
    shear = np.full((6, 5), np.nan)
    shear[:5] = linear(5, 5, 0.03, 0.01)
    shear[5, 2] = 5 * 0.03 + 2 * 0.01
    found = shear_gradients(shear)
    assert np.isnan(found[5, 2, 1])
    assert gradient_near(found, 5.5, 2.5) == pytest.approx((0.03, 0.01))
    assert gradient_near(found, 7.5, -1.5) == pytest.approx((0.03, 0.01))
    assert gradient_near(found, 50.0, 50.0) == (0.0, 0.0)


def test_turning_is_counter_clockwise_about_the_normal():
    out = np.empty(3)
    turn_by(np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]), 0.5 * np.pi, out)
    np.testing.assert_allclose(out, [0.0, 1.0, 0.0], atol=1e-15)
    turn_by(np.array([0.0, 2.0, 0.0]), np.array([1.0, 0.0, 0.0]), 0.5 * np.pi, out)
    np.testing.assert_allclose(out, [0.0, 0.0, 2.0], atol=1e-15)


def test_the_ends_of_yarns_are_where_cells_are_on_one_side_only():
    valid = np.ones((3, 2), bool)
    warp = np.array([[one_sided(valid, i, j, 1, 0) for j in range(3)] for i in range(4)])
    weft = np.array([[one_sided(valid, i, j, 0, 1) for j in range(3)] for i in range(4)])
    np.testing.assert_array_equal(warp, np.repeat([[-1], [0], [0], [1]], 3, axis=1))
    np.testing.assert_array_equal(weft, np.tile([-1, 0, 1], (4, 1)))


def test_directions_at_the_ends_are_those_of_the_circle_that_the_yarn_follows():
    k, n = 0.08, 6  # warp yarns turn by k per cell, weft yarns are straight: shear grows by k per cell along u
    p = np.arange(n + 1.0)
    angle = k * p
    angle[0], angle[-1] = k * 0.5, k * (n - 0.5)  # known only in the middle of the side
    yarns = np.zeros((2, n + 1, 4, 3))
    yarns[0, :, :, 0], yarns[0, :, :, 1] = np.cos(angle)[:, None], np.sin(angle)[:, None]
    yarns[1, :, :, 1] = 1.0
    shear = linear(n, 3, k, 0.0) + 0.5 * k
    done = complete_ends(yarns, np.ones((n, 3), bool), shear_gradients(shear))
    np.testing.assert_allclose(np.arctan2(done[0, ..., 1], done[0, ..., 0]), np.tile(k * p[:, None], 4), atol=1e-12)
    np.testing.assert_allclose(done[1], yarns[1], atol=1e-12)


def test_coordinates_are_corrected_for_yarns_that_bend_between_nodes():
    k, n = 0.05, 6  # as above, translation surface of a circle of radius 1 / k cells along straight wefts

    def place(p, q):
        return np.stack([np.sin(k * p) / k, (1.0 - np.cos(k * p)) / k + q], axis=-1)

    i, j = np.indices((n + 1, 4))
    yarns = np.zeros((2, n + 1, 4, 3))
    yarns[0, ..., 0], yarns[0, ..., 1], yarns[1, ..., 1] = np.cos(k * i), np.sin(k * i), 1.0
    gradient = shear_gradients(linear(n, 3, k, 0.0))
    rng = np.random.default_rng(0)
    exact = rng.uniform([0, 0], [n, 3], (200, 2))
    cell = np.floor(exact[:, 0])
    low, high = place(cell, 0 * cell), place(cell + 1, 0 * cell)
    x, y = place(*exact.T).T
    share = (x - low[:, 0]) / (high - low)[:, 0]  # between straight sides
    found = np.column_stack([cell + share, y - low[:, 1] - share * (high - low)[:, 1]])
    before = np.abs(found - exact).max()
    bend_cells(found, yarns, gradient)
    assert before > 5e-3
    assert np.abs(found - exact).max() < 0.1 * before
