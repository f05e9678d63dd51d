"""Headings as they are written."""

from __future__ import annotations

import pytest

import geomdrap as gd
from geomdrap.sweep import parse_angles


def test_a_range_includes_both_ends() -> None:
    assert parse_angles("0:90:5") == tuple(5.0 * k for k in range(19))


def test_a_range_whose_step_does_not_fit_ends_before_its_stop() -> None:
    assert parse_angles("0:10:4") == (0.0, 4.0, 8.0)


def test_a_step_without_an_exact_binary_form_still_reaches_the_end() -> None:
    angles = parse_angles("0:1:0.1")
    assert len(angles) == 11
    assert angles[-1] == pytest.approx(1.0)


def test_a_range_may_run_downward() -> None:
    assert parse_angles("45:-45:-45") == (45.0, 0.0, -45.0)


def test_a_range_of_one_angle_is_one_angle() -> None:
    assert parse_angles("30:30:5") == (30.0,)


def test_numbers_and_ranges_are_joined_and_each_angle_comes_once() -> None:
    assert parse_angles("45, 0:90:45,12.5") == (45.0, 0.0, 90.0, 12.5)


@pytest.mark.parametrize("text", ["0:90:0", "90:0:5", "0:90:-5"])
def test_an_empty_range_is_refused(text: str) -> None:
    with pytest.raises(gd.SweepError, match="is empty; its step must lead from"):
        parse_angles(text)


@pytest.mark.parametrize("text", ["", "north", "0:90", "1:2:3:4", "0:inf:5", "nan", "0,,90", "1_0"])
def test_what_is_no_angle_is_refused_with_an_example(text: str) -> None:
    with pytest.raises(gd.SweepError, match="0:90:5"):
        parse_angles(text)


def test_an_endless_range_is_refused() -> None:
    with pytest.raises(gd.SweepError, match="use a larger step"):
        parse_angles("0:90:1e-9")
