"""Order, objectives and the front."""

from __future__ import annotations

import pytest

import geomdrap as gd
from geomdrap.sweep import CRITERIA, Objective, Row, ranked
from geomdrap.sweep.ranking import pareto_front
from geomdrap.sweep.row import failed


def _row(angle: float, **numbers: float) -> Row:
    values = dict.fromkeys(("max_shear", "p95_shear", "mean_shear", "over_limit", "waste"), 0.0)
    areas = {"part_area": 1e4, "draped_area": 1e4, "fabric_area": 1e4, "blank_area": 2e4, "coverage": 1.0}
    return Row("centroid", (0.0, 0.0, 0.0), angle, pitch=1.0, **{**values, **areas, **numbers})


def test_the_smallest_is_first_and_failures_are_last() -> None:
    rows = [
        failed("centroid", 9.0, "off"),
        _row(1.0, p95_shear=5.0),
        _row(2.0, p95_shear=3.0),
        _row(3.0, p95_shear=5.0),
    ]
    assert [row.angle for row in ranked(rows, Objective.parse("p95-shear"))] == [2.0, 1.0, 3.0, 9.0]


def test_what_is_bare_counts_ten_degrees_a_per_cent_beyond_half_a_per_cent() -> None:
    objective = Objective.parse("max-shear")
    assert objective.score(_row(0.0, max_shear=20.0, coverage=0.995)) == 20.0
    assert objective.score(_row(0.0, max_shear=20.0, coverage=0.975)) == pytest.approx(40.0)


def test_a_drape_that_saves_fabric_by_leaving_the_part_bare_is_no_better() -> None:
    whole, half = _row(0.0), _row(1.0, coverage=0.5, fabric_area=5e3)
    assert ranked([half, whole], Objective.parse("fabric-area"))[0] is whole


def test_a_weighted_sum_adds_the_criteria() -> None:
    row = _row(0.0, p95_shear=10.0, waste=0.3)
    assert Objective.parse("p95-shear=2,waste=0.5").score(row) == pytest.approx(2 * 10.0 + 0.5 * 30.0)


@pytest.mark.parametrize("name", CRITERIA)
def test_every_criterion_is_worse_where_its_number_is(name: str) -> None:
    field = name.replace("-", "_")
    worse = {"coverage": 0.9}.get(field, 9e4 if "area" in field else 0.9)
    objective = Objective.parse(name)
    assert objective.score(_row(0.0, **{field: worse})) > objective.score(_row(0.0))


@pytest.mark.parametrize("text", ["beauty", "p95-shear=-1", "p95-shear=x", "p95-shear=0", "waste,waste", ""])
def test_what_is_no_objective_is_refused(text: str) -> None:
    with pytest.raises(gd.SweepError, match="objective"):
        Objective.parse(text)


def test_an_objective_is_written_as_it_is_read() -> None:
    for text in ("p95-shear", "p95-shear=1,waste=0.5"):
        assert str(Objective.parse(text)) == text


def test_on_the_front_nothing_is_beaten_and_off_it_everything_is() -> None:
    rows = [
        _row(0.0, p95_shear=10.0, blank_area=30e3),
        _row(1.0, p95_shear=20.0, blank_area=20e3),
        _row(2.0, p95_shear=20.0, blank_area=30e3),
        failed("centroid", 3.0, "off"),
    ]
    assert [row.angle for row in pareto_front(rows, ("p95-shear", "blank-area"))] == [0.0, 1.0]


def test_a_difference_that_nobody_could_measure_puts_no_row_on_the_front() -> None:
    rows = [_row(0.0, p95_shear=10.0, coverage=0.9999), _row(1.0, p95_shear=30.0, coverage=1.0)]
    assert [row.angle for row in pareto_front(rows, ("p95-shear", "coverage"))] == [0.0]
