"""Shear angles and labels that are probably others than the table says."""

from dataclasses import replace

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.measurement.plausible import check_shear
from geomdrap.surface import shapes

ANGLES = np.random.default_rng(0).normal(0.0, 10.0, 40)
READ = ANGLES + np.random.default_rng(1).normal(0.0, 1.0, 40)


@pytest.mark.parametrize(
    ("measured", "words"),
    [
        (READ, None),
        (-READ, "the other sign"),
        (np.radians(READ), "in radians"),
        (0.3 * READ, None),
        (READ[::-1], None),
    ],
)
def test_shear_of_the_other_sign_or_in_radians_is_noticed(measured, words):
    said = check_shear(measured, ANGLES, "table.csv")
    assert bool(said) == (words is not None)
    if words:
        assert words in said[0] and "table.csv" in said[0]


def test_shear_without_a_sign_is_noticed():
    (said,) = check_shear(np.abs(READ), ANGLES, "table.csv")
    assert "it looks as if the shear has no sign: it is never negative" in said
    (said,) = check_shear(-np.abs(READ), ANGLES, "table.csv")
    assert "never positive" in said
    one_way = np.abs(ANGLES)  # a ply that shears one way only is no mistake, nor one whose sign is that of the net
    assert check_shear(np.abs(READ), one_way, "t") == ()
    assert check_shear(np.abs(np.random.default_rng(2).normal(0.0, 0.6, 40)), ANGLES, "t") == ()


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("offset", [4.0, -4.0])
def test_shear_of_one_sign_that_follows_the_prediction_has_its_sign(seed, offset):
    small = np.random.default_rng(seed).uniform(-3.0, 3.0, 200)
    assert check_shear(small + offset, small, "t") == ()


def test_too_few_angles_or_equal_ones_say_nothing():
    assert check_shear(-READ[:5], ANGLES[:5], "t") == ()
    assert check_shear(np.zeros(40), ANGLES, "t") == ()
    assert check_shear(None, ANGLES, "t") == ()


@pytest.mark.parametrize(("factor", "words"), [(1 / 25.4, "u and v are in inches"), (25.4, "x, y, z are in inches")])
def test_labels_in_another_unit_than_the_points_are_noticed(factor, words):
    cap = shapes.sphere_cap(80.0, 60.0, 4.0)
    net = gd.drape(cap, (0.0, 0.0, 80.0), 0.0, 5.0, project=True)
    u, v = (a.ravel() for a in np.meshgrid(np.arange(-40.0, 41.0, 10.0), np.arange(-40.0, 41.0, 10.0)))
    points, _ = net.interpolate(u, v)
    table = gd.Measurement(source="t.csv", points=points, u=u, v=v)
    laid = {"origin": (0.0, 0.0, 80.0), "angle": 0.0, "pitch": 5.0, "sigma_xyz": 0.2, "project": True}
    assert not any("looks as if" in w for w in gd.compare(cap, table, **laid).warnings)
    wrong = replace(table, u=u * factor, v=v * factor)
    said = [w for w in gd.compare(cap, wrong, **laid).warnings if "looks as if" in w]
    assert len(said) == 1 and words in said[0]
