"""Mistakes in a table: single values, labels, units, frames."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from analytic_tools import measured

import geomdrap as gd
from geomdrap.criticism.compare import compare_net
from geomdrap.measurement.match import match
from geomdrap.measurement.outliers import find_outliers
from geomdrap.measurement.plausible import check_labels, looks_wrong, require_on_part
from geomdrap.surface import shapes

SIGMA = 0.2


@pytest.fixture(scope="module")
def case():
    surface, measurement, laid = measured("springback")
    net = gd.drape(surface, laid["origin"], laid["angle"], 4.0)
    return net, measurement


def _outliers(net, measurement):
    n = len(measurement)
    return find_outliers(net, measurement, match(net, measurement), np.full(n, SIGMA), np.full(n, 0.6))


def test_good_data_have_no_outliers(case):
    assert _outliers(*case) == ()


@pytest.mark.parametrize("seed", range(5))
def test_all_slips_of_ten_sigmas_are_found_and_nothing_else(case, seed):
    net, m = case
    rng = np.random.default_rng(seed)
    rows = rng.choice(len(m), 6, replace=False)
    points, shear = m.points.copy(), m.shear.copy()
    way = rng.normal(size=(6, 3))
    points[rows] += 12.0 * SIGMA * way / np.linalg.norm(way, axis=1, keepdims=True)
    shear[rows[:3]] += 9.0
    found = _outliers(net, replace(m, points=points, shear=shear))
    assert {o.row for o in found if o.kind == "position"} == set(rows.tolist())
    assert {o.row for o in found if o.kind == "shear"} == set(rows[:3].tolist())
    assert {o.line for o in found} == {int(m.row[r]) for r in rows}


@pytest.mark.parametrize("times", [2, 3])
def test_the_one_of_repeated_marks_that_is_far_off_is_the_outlier(case, times):
    net, m = case
    rows = np.concatenate([np.arange(len(m)), np.repeat([20, 90, 160, 200, 260], times - 1)])
    table = m.take(rows)
    rng = np.random.default_rng(0)
    points = table.points + rng.normal(0.0, 0.1, (len(table), 3)) * (np.arange(len(table)) >= len(m))[:, None]
    wrong = len(m) + np.arange(0, 5 * (times - 1), times - 1)  # one repeat of each
    points[wrong, 2] += 80.0
    for sigma in (None, SIGMA):
        c = compare_net(net, replace(table, points=points, row=np.arange(len(table))), sigma_xyz=sigma)
        assert {o.row for o in c.outliers if o.kind == "position"} == set(wrong.tolist())
        assert c.scores.position.robust_rms < 1.0
        assert c.noise_xyz.typical < 0.3


@pytest.mark.parametrize("shift", [(1, 0), (0, -1), (-1, 1), (2, 0)])
def test_a_label_that_is_off_by_marks_is_recognised(case, shift):
    net, m = case
    row = int(np.argmin(np.hypot(m.u, m.v)))
    u, v = m.u.copy(), m.v.copy()
    u[row] += 16.0 * shift[0]
    v[row] += 16.0 * shift[1]
    found = [o for o in _outliers(net, replace(m, u=u, v=v)) if o.kind == "position"]
    assert [(o.row, o.shift) for o in found] == [(row, (-shift[0], -shift[1]))]


@pytest.mark.parametrize(("fixed", "along", "way"), [("v", "u", 1), ("v", "u", -1), ("u", "v", 1)])
def test_a_whole_line_of_marks_labelled_one_off_is_named_and_set_apart(case, fixed, along, way):
    net, m = case
    line = np.round(getattr(m, fixed)) == 32.0
    c = compare_net(net, replace(m, **{along: getattr(m, along) + 16.0 * way * line}), sigma_xyz=SIGMA)
    predicted = line & c.used
    assert {o.row for o in c.outliers if o.kind == "position"} == set(np.flatnonzero(predicted).tolist())
    assert predicted.sum() > 8
    fit = {"u": (-way, 0), "v": (0, -way)}[along]
    said = [w for w in c.warnings if "seem" in w]
    assert said == [
        f"the marks with {fixed} = 32 mm: {predicted.sum()} of {predicted.sum()} labels of this line seem to be off; "
        f"they fit {fit[0]:+d} along u and {fit[1]:+d} along v (in marks)"
    ]
    assert c.scores.position.robust_rms < 1.0


@pytest.mark.parametrize("after", [-64.0, -16.0])
def test_the_right_marks_before_one_that_was_skipped_are_kept(case, after):
    net, m = case
    line = np.round(m.v) == 32.0
    wrong = line & (m.u > after)
    c = compare_net(net, replace(m, u=m.u + 16.0 * wrong), sigma_xyz=SIGMA)
    off = [o for o in c.outliers if o.kind == "position"]
    assert {o.row for o in off} == set(np.flatnonzero(wrong & c.used).tolist())
    (said,) = [w for w in c.warnings if "seem" in w]
    assert f"v = 32 mm: {len(off)} of {(line & c.used).sum()} labels of this line seem to be off; they fit -1" in said
    assert len(off) < (line & c.used).sum()


def test_the_size_of_a_mark_of_a_line_is_what_it_is_off_the_lines_beside():
    surface, m, laid = measured("steering")  # off by up to 13 mm itself
    line = np.round(m.v) == 32.0
    c = gd.compare(surface, replace(m, u=m.u + 16.0 * line), **laid)
    size = np.array([o.size for o in c.outliers if o.kind == "position"])
    assert len(size) == (line & c.used).sum()
    assert np.abs(size - 16.0).max() < 4.0


@pytest.mark.parametrize("wrong", [None, 32.0, -48.0])
def test_a_line_is_told_from_a_misfit_of_nearly_a_mark(wrong):
    surface, m, laid = measured("steering")  # off by up to 13 mm of the 16 between marks
    line = np.round(m.v) == (np.nan if wrong is None else wrong)
    c = gd.compare(surface, replace(m, u=m.u + 16.0 * line), **laid)
    assert {o.row for o in c.outliers if o.kind == "position"} == set(np.flatnonzero(line & c.used).tolist())


def test_good_labels_are_not_doubted(case):
    assert check_labels(*case) == ()


@pytest.mark.parametrize(
    ("matrix", "words"),
    [
        ([[0, 1], [1, 0]], "u and v are swapped:"),
        ([[-1, 0], [0, 1]], "u runs the other way"),
        ([[1, 0], [0, -1]], "v runs the other way"),
        ([[-1, 0], [0, -1]], "180 degrees"),
        ([[0, 1], [-1, 0]], "turned by 90 degrees"),
        ([[0, -1], [1, 0]], "turned by 90 degrees"),
    ],
)
def test_swapped_and_mirrored_labels_are_noticed(case, matrix, words):
    net, m = case
    u, v = np.array(matrix) @ np.stack([m.u, m.v])
    warnings = check_labels(net, replace(m, u=u, v=v))
    assert len(warnings) == 1
    assert words in warnings[0]


def test_of_mirrored_labels_shear_is_not_judged_as_well(case):
    """Held against what is predicted at the wrong labels it was said to have the other sign."""
    net, m = case
    mirrored = replace(m, v=-m.v)
    assert m.shear is not None
    (said,) = looks_wrong(net, mirrored, match(net, mirrored))
    assert "v runs the other way" in said


def test_labels_counted_from_another_mark_are_noticed(case):
    net, m = case
    warnings = check_labels(net, replace(m, u=m.u + 16.0))
    assert "all labels are off by a mark (by +1 along u, +0 along v)" in warnings[0]


def test_labels_of_which_most_have_no_prediction_are_not_called_off_by_a_mark(case):
    """A table read from another origin was said to lie within 65 mm instead of inf mm; swapped ones are still found."""
    net, m = case
    apart = replace(m, u=m.u + np.where(m.u > 0.0, 200.0, -200.0))  # beyond the net, on both sides
    assert not np.isfinite(net.interpolate(apart.u, apart.v)[0]).all(axis=1).any()
    assert check_labels(net, apart) == ()
    (said,) = check_labels(net, replace(m, u=1000.0 * m.u, v=1000.0 * m.v))
    assert "where most have none as they are" in said
    assert "inf" not in said


@pytest.mark.parametrize(("unit", "factor"), [("m", 1000.0), ("in", 25.4), ("cm", 10.0)])
@pytest.mark.parametrize("labelled", [True, False])
def test_points_in_another_unit_are_refused_and_the_unit_named(case, unit, factor, labelled):
    net, m = case
    u, v = (m.u, m.v) if labelled else (None, None)
    with_unit = replace(m, points=m.points / factor, u=u, v=v)
    try:
        said = " ".join(require_on_part(net.surface, with_unit))
        assert not labelled  # without labels a small patch in the middle may be meant
    except gd.MeasurementError as error:
        said = str(error)
    assert f"--unit-measured {unit}" in said


@pytest.mark.parametrize("factor", [10.0, 25.4, 1000.0])
def test_where_labels_and_points_agree_either_the_part_or_all_of_the_table_is_in_another_unit(case, factor):
    net, m = case
    large = gd.Surface(net.surface.points * factor, net.surface.triangles)
    small = replace(m, points=m.points / factor, u=m.u / factor, v=m.v / factor)
    for part, table in ((large, m), (net.surface, small)):
        with pytest.raises(gd.MeasurementError, match=r"use --unit-measured .*check --unit\)$"):
            require_on_part(part, table)


@pytest.mark.parametrize(("factor", "refused"), [(1.0, False), (1.0 / 25.4, True)])
def test_on_a_flat_part_a_small_table_lies_on_it_in_several_units_which_is_said_and_a_tiny_one_refused(
    factor, refused
):
    plate = gd.Surface([[-100.0, -100, 0], [100, -100, 0], [100, 100, 0], [-100, 100, 0]], [[0, 1, 2], [0, 2, 3]])
    u, v = (a.ravel() for a in np.meshgrid(*2 * [np.linspace(-11.0, 11.0, 9)]))
    u, v = factor * u, factor * v
    table = gd.Measurement("t.csv", np.column_stack([u, v, 0.0 * u]), u=u, v=v)
    try:
        said = require_on_part(plate, table)
        assert not refused
        assert "--unit-measured cm if so" in said[0]
    except gd.MeasurementError as error:
        assert refused
        assert "check --unit" in str(error)


def test_points_in_another_frame_are_refused(case):
    net, m = case
    with pytest.raises(gd.MeasurementError, match="part's coordinates"):
        require_on_part(net.surface, replace(m, points=m.points + [0.0, 0.0, 900.0]))


def test_a_small_patch_in_the_right_unit_is_no_mistake(case):
    net, m = case
    assert require_on_part(net.surface, m.take(np.hypot(m.u, m.v) < 40.0)) == ()


@pytest.fixture(scope="module")
def lopsided():
    """A part that no mirror leaves as it is, and marks on it."""
    plane = shapes.plane(240.0, 200.0, 6.0)
    x, y = plane.points[:, 0], plane.points[:, 1]
    height = 40.0 * np.exp(-((x - 40.0) ** 2 + (y - 20.0) ** 2) / 2500.0) + 8e-4 * x * y
    part = gd.Surface(np.column_stack([x, y, height]), plane.triangles)
    net = gd.drape(part, (5.0, 3.0, 0.0), 20.0, 6.0, project=True)
    u, v = (a.ravel() for a in np.meshgrid(np.arange(-80.0, 81.0, 20.0), np.arange(-70.0, 71.0, 20.0)))
    points = net.interpolate(u, v)[0]
    known = np.isfinite(points[:, 0])
    return net, gd.Measurement("marks.csv", points[known], u[known], v[known])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda p: p * [1.0, 1.0, -1.0], "mirrored"),
        (lambda p: p * [1.0, -1.0, 1.0], "mirrored"),
        (lambda p: p + [8.0, -6.0, 0.0], "another frame, moved by (8, -6, 0) mm:"),
        (lambda p: p[:, [2, 0, 1]] + [5.0, 0.0, 0.0], "turned by 120 degrees"),
    ],
)
def test_points_in_another_frame_are_noticed(lopsided, change, words):
    net, m = lopsided
    wrong = replace(m, points=change(m.points))
    said = looks_wrong(net, wrong, match(net, wrong))
    assert len(said) == 1
    assert words in said[0]


@pytest.mark.parametrize("change", [lambda p: p, lambda p: p + [0.0, 0.0, 2.0], lambda p: p + [1.0, -1.5, 0.0]])
def test_a_ply_that_lies_nearly_where_it_should_is_in_no_other_frame(lopsided, change):
    net, m = lopsided
    other = replace(m, points=change(m.points))
    assert not looks_wrong(net, other, match(net, other))


@pytest.mark.parametrize("offset", [3.0, 7.0, 15.0])
def test_a_thick_ply_is_in_no_other_frame(lopsided, offset):
    net, m = lopsided
    other = replace(m, points=m.points + offset * match(net, m).normal)
    assert not looks_wrong(net, other, match(net, other))


def test_a_ply_laid_far_from_its_place_is_on_the_part_still(lopsided):
    net, m = lopsided
    points = net.interpolate(m.u + 12.0, m.v - 9.0)[0]
    known = np.isfinite(points[:, 0])
    other = m.take(np.flatnonzero(known))
    other = replace(other, points=points[known])
    assert not any("frame" in words for words in looks_wrong(net, other, match(net, other)))


def test_angles_from_yarn_to_yarn_are_no_shear(lopsided):
    """Acute ones are told by what is predicted: a shear of 90 degrees is refused when the table is read."""
    net, m = lopsided
    shear = match(net, m).shear
    for between in (90.0 - np.abs(shear), 90.0 - shear):
        wrong = replace(m, shear=between + np.random.default_rng(0).normal(0.0, 0.6, len(m)))
        said = looks_wrong(net, wrong, match(net, wrong))
        assert len(said) == 1
        assert "the angle between warp and weft: give 90 less it" in said[0]
    assert not looks_wrong(net, replace(m, shear=shear), match(net, m))
