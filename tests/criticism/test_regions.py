"""Where the residual is worst, in words and in place; what was not measured."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from analytic_tools import measured

import geomdrap as gd
from geomdrap.criticism.compare_regions import region_words, unmeasured, worst_regions
from geomdrap.export.compare_json import as_dict
from geomdrap.export.compare_table import columns_of


@pytest.fixture(scope="module")
def quiet():
    """The net itself at the marks, with noise."""
    surface, m, laid = measured("springback")
    net = gd.drape(surface, laid["origin"], laid["angle"], 8.0)
    points, shear = net.interpolate(m.u, m.v)
    rng = np.random.default_rng(0)
    return (
        surface,
        replace(m, points=points + rng.normal(0, 0.2, points.shape), shear=shear + rng.normal(0, 0.6, len(m))),
        laid,
    )


def test_noise_has_no_worst_region(quiet):
    surface, m, laid = quiet
    assert worst_regions(gd.compare(surface, m, **laid)) == ()


@pytest.mark.parametrize(
    ("u", "v", "words"),
    [
        (120, 0, "far along +warp"),
        (0, -112, "far along −weft"),
        (-96, 96, "on the"),
        (48, 0, "halfway along +warp"),
        (0, 0, "near the origin"),
    ],
)
def test_a_bump_in_the_residual_is_named_by_its_place(quiet, u, v, words):
    surface, m, laid = quiet
    there = np.exp(-((m.u - u) ** 2 + (m.v - v) ** 2) / 25.0**2)
    net = gd.drape(surface, laid["origin"], laid["angle"], 8.0)
    warp, _ = net.directions(m.u, m.v)
    c = gd.compare(surface, replace(m, points=m.points + 2.0 * there[:, None] * warp), **laid)
    worst = worst_regions(c)[0]
    assert words in worst.name
    assert np.hypot(worst.u - u, worst.v - v) < 30.0
    assert worst.along_warp > 0.8
    assert abs(worst.along_weft) < 0.4
    assert abs(worst.normal) < 0.2
    assert worst.name in region_words(worst)


def test_the_size_of_a_region_is_that_of_its_components(quiet):
    surface, m, laid = quiet
    there = np.exp(-((m.u - 60.0) ** 2 + (m.v - 60.0) ** 2) / 25.0**2)[:, None]
    net = gd.drape(surface, laid["origin"], laid["angle"], 8.0)
    warp, weft = net.directions(m.u, m.v)
    c = gd.compare(surface, replace(m, points=m.points + there * (6.0 * warp + 2.0 * weft)), **laid)
    worst = worst_regions(c)[0]
    a, b, n = worst.along_warp, worst.along_weft, worst.normal
    assert worst.size**2 == pytest.approx(a**2 + b**2 + n**2 + 2 * a * b * np.cos(np.radians(worst.yarn_angle)))
    assert abs(90.0 - worst.yarn_angle) > 5.0
    assert f"normal; yarns {worst.yarn_angle:.0f}° apart)" in region_words(worst)


def test_without_labels_only_the_distance_from_the_part_is_told(quiet):
    surface, m, laid = quiet
    there = np.exp(-((m.u - 48.0) ** 2 + m.v**2) / 25.0**2)[:, None]
    net = gd.drape(surface, laid["origin"], laid["angle"], 8.0)
    normal = np.cross(*net.directions(m.u, m.v))
    lifted = m.points + 3.0 * there * normal / np.linalg.norm(normal, axis=1, keepdims=True)
    c = gd.compare(surface, replace(m, points=lifted, u=None, v=None), **laid)
    worst = worst_regions(c)[0]
    assert (worst.along_warp, worst.along_weft) == (None, None)
    assert f"{worst.size:.2f} mm ({worst.normal:+.2f} normal)" in region_words(worst)
    position = as_dict(c)["position"]
    for name in ("bias", "rms_along"):
        assert (position[name]["warp"], position[name]["weft"]) == (None, None)
        assert position[name]["normal"] is not None
    assert not {"along_warp", "along_weft"} & set(columns_of(c))


def test_the_rim_is_in_the_name_with_its_distance(quiet):
    surface, m, laid = quiet
    c = gd.compare(surface, replace(m, shear=m.shear + 8.0 * (m.u > 100)), **laid)
    worst = worst_regions(c)[0]
    assert "mm from the rim" in worst.name
    assert worst.shear > 4.0


def test_turned_directions_are_a_region_too(quiet):
    surface, m, laid = quiet
    net = gd.drape(surface, laid["origin"], laid["angle"], 8.0)
    warp, weft = net.directions(m.u, m.v)
    normal = np.cross(warp, weft)
    angle = np.radians(np.random.default_rng(1).normal(0.0, 0.5, len(m)) + 6.0 * (m.v > 90.0))[:, None]
    turned = np.cos(angle) * warp + np.sin(angle) * np.cross(
        normal / np.linalg.norm(normal, axis=1, keepdims=True), warp
    )
    c = gd.compare(surface, replace(m, warp=turned), **laid)
    worst = worst_regions(c)[0]
    assert "+weft" in worst.name
    assert worst.warp_turn == pytest.approx(6.0, abs=1.5)
    assert worst.weft_turn is None
    assert {t.kind for t in c.trends} == {"position", "shear", "warp"}


def test_the_part_that_was_not_measured_is_found(quiet):
    surface, m, laid = quiet
    c = gd.compare(surface, m.take(m.points[:, 0] < 0.0), **laid)
    share, gaps = unmeasured(c)
    assert 0.25 < share < 0.5
    assert len(gaps) == 1
    assert gaps[0].center[0] > 50.0
    assert gaps[0].area == pytest.approx(share * surface.area, rel=0.02)


def test_a_part_that_was_measured_all_over_has_no_gap(quiet):
    surface, m, laid = quiet
    share, gaps = unmeasured(gd.compare(surface, m, **laid))
    assert share < 0.02
    assert gaps == ()


def test_marks_read_more_than_once_leave_no_more_unmeasured(quiet):
    surface, m, laid = quiet
    some = m.take(np.flatnonzero((m.u < 40.0) & (m.v > -100.0)))
    thrice = some.take(np.repeat(np.arange(len(some)), 3))
    shaken = replace(thrice, points=thrice.points + np.random.default_rng(1).normal(0.0, 0.1, thrice.points.shape))
    once, often = (unmeasured(gd.compare(surface, table, **laid))[0] for table in (some, shaken))
    assert often == pytest.approx(once, abs=0.01)
