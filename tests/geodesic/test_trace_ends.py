"""Where and why lines stop, and what is refused."""

import numpy as np
import pytest
from made_parts import cube, plate_with_holes

from geomdrap.errors import DrapeError
from geomdrap.geodesic import Stop, trace
from geomdrap.surface import shapes

PLANE = shapes.plane(200.0, 100.0, 10.0)
X, Y, Z = np.eye(3)


@pytest.mark.parametrize("degrees", [0.0, 20.0, 45.0, 90.0, 160.0, 270.0])
def test_a_line_that_leaves_the_part_ends_on_its_rim(degrees):
    way = np.cos(np.radians(degrees)) * X + np.sin(np.radians(degrees)) * Y
    start = np.array([3.0, -7.0, 0.0])
    with np.errstate(divide="ignore"):
        ways = [((np.sign(way[k]) * half) - start[k]) / way[k] for k, half in ((0, 100.0), (1, 50.0))]
    reach = min(w for w, d in zip(ways, way, strict=False) if abs(d) > 1e-12)
    line = trace(PLANE, start, way, 500.0)
    assert line.stopped is Stop.RIM
    assert line.length == pytest.approx(reach, abs=1e-10)
    np.testing.assert_allclose(line.point, start + reach * way, atol=1e-10)
    np.testing.assert_allclose(line.direction, way, atol=1e-12)


def test_a_line_into_a_corner_of_the_part_ends_there():
    line = trace(PLANE, np.zeros(3), 2 * X + Y, 500.0)
    assert line.stopped is Stop.RIM
    np.testing.assert_allclose(line.point, [100.0, 50.0, 0.0], atol=1e-9)


def test_a_line_stops_at_a_hole():
    line = trace(plate_with_holes(), np.array([-80.0, 3.0, 0.0]), X, 100.0)
    assert line.stopped is Stop.RIM
    np.testing.assert_allclose(line.point, [-30.0, 3.0, 0.0], atol=1e-10)
    assert line.length == pytest.approx(50.0, abs=1e-10)


def test_a_line_from_the_rim_outward_has_no_length():
    line = trace(PLANE, np.array([100.0, 3.0, 0.0]), X, 10.0)
    assert line.stopped is Stop.RIM
    assert line.length == pytest.approx(0.0, abs=1e-10)
    np.testing.assert_allclose(line.point, [100.0, 3.0, 0.0], atol=1e-10)


def test_a_line_from_the_rim_inward_runs_its_length():
    line = trace(PLANE, np.array([100.0, 3.0, 0.0]), -X, 10.0)
    assert line.stopped is Stop.LENGTH
    np.testing.assert_allclose(line.point, [90.0, 3.0, 0.0], atol=1e-10)


def test_a_line_whose_length_ends_just_at_the_rim_is_whole():
    line = trace(PLANE, np.array([90.0, 3.0, 0.0]), X, 10.0)
    assert line.length == pytest.approx(10.0, abs=1e-9)
    np.testing.assert_allclose(line.point, [100.0, 3.0, 0.0], atol=1e-9)


def test_a_line_of_no_length_stays_where_it_is():
    start = np.array([3.3, -7.1, 0.0])
    line = trace(PLANE, start, Y, 0.0)
    assert line.stopped is Stop.LENGTH
    assert line.length == 0.0
    np.testing.assert_allclose(line.point, start, atol=1e-12)
    np.testing.assert_allclose(line.direction, Y, atol=1e-12)
    np.testing.assert_allclose(line.path, [start, start], atol=1e-12)


def test_a_start_off_the_surface_is_moved_onto_it():
    line = trace(PLANE, np.array([5.0, 5.0, 8.0]), X, 10.0)
    np.testing.assert_allclose(line.path[0], [5.0, 5.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(line.point, [15.0, 5.0, 0.0], atol=1e-12)


def test_only_the_part_of_a_direction_in_the_surface_counts():
    line = trace(PLANE, np.zeros(3), X + 5 * Z, 10.0)
    np.testing.assert_allclose(line.point, [10.0, 0.0, 0.0], atol=1e-12)


def test_a_long_line_on_a_closed_part_is_followed_to_its_end():
    surface = cube(60.0, 6)
    line = trace(surface, np.array([1.0, 2.0, 30.0]), np.array([1.0, 0.37, 0.0]), 20_000.0)
    assert line.stopped is Stop.LENGTH
    assert line.length == pytest.approx(20_000.0, abs=1e-6)
    assert abs(line.path).max() < 30.0 + 1e-9
    assert np.linalg.norm(np.diff(line.path, axis=0), axis=1).sum() == pytest.approx(20_000.0, abs=1e-6)


@pytest.mark.parametrize("length", [-1.0, np.nan, np.inf])
def test_a_length_that_makes_no_sense_is_refused(length):
    with pytest.raises(DrapeError, match="finite length"):
        trace(PLANE, np.zeros(3), X, length)


@pytest.mark.parametrize("direction", [Z, -Z, 0 * X, X * np.nan])
def test_a_direction_that_points_nowhere_in_the_surface_is_refused(direction):
    with pytest.raises(DrapeError, match="direction"):
        trace(PLANE, np.zeros(3), direction, 1.0)


@pytest.mark.parametrize("start", [[np.nan, 0.0, 0.0], [np.inf, 0.0, 0.0]])
def test_a_start_that_is_no_point_is_refused(start):
    with pytest.raises(DrapeError):
        trace(PLANE, np.array(start), X, 1.0)
