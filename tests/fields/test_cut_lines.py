"""Cuts in the flat fabric: those that stay shut are lines of it, and where it tears behind one is said."""

import numpy as np
import pytest
from made_parts import plane_sheet

import geomdrap as gd
from geomdrap.surface.shapes import sphere_cap


@pytest.mark.parametrize("line", [[[30, 42, 0], [80, 47, 0]], [[0, 33, 0], [71, 52, 0]]], ids=["within", "from the rim"])
def test_a_cut_in_a_plane_sheet_lies_in_the_pattern_where_it_was_drawn(line):
    drape = gd.evaluate(gd.drape(plane_sheet(12, 120.0).cut(line), (60.0, 90.0, 0.0), 20.0, 5.0))
    line = np.array(line, float)
    drawn = np.array(drape.flat.cuts)
    assert np.linalg.norm(drawn[:, 1] - drawn[:, 0], axis=1).sum() == pytest.approx(
        np.linalg.norm(line[1] - line[0]), rel=2e-3
    )
    turn = np.radians(20.0)
    warp, weft = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
    there = (line[:, :2] - [60.0, 90.0]) @ np.column_stack([warp, weft])
    along = (there[1] - there[0]) / np.linalg.norm(there[1] - there[0])
    off = (drawn.reshape(-1, 2) - there[0]) @ [-along[1], along[0]]
    assert np.abs(off).max() < 0.15  # the line may bend to vertices nearby, a hundredth of an edge
    assert not drape.warnings
    assert drape.area.fabric == pytest.approx(120.0**2, rel=1e-9)


def test_a_tear_behind_a_cut_is_warned_of_and_a_part_without_cuts_has_no_cut_lines():
    dome = sphere_cap(radius=100.0, opening=60.0, edge=4.0)
    whole = gd.evaluate(gd.drape(dome, (0.0, 0.0, 100.0), 0.0, 5.0))
    assert not whole.flat.cuts
    assert not any("behind a cut" in w for w in whole.warnings)
    line = [dome.nearest([[x, x, 100.0]]).point[0] for x in (20.0, 35.0, 45.0)]
    cut = gd.evaluate(gd.drape(dome.cut(line), (0.0, 0.0, 100.0), 0.0, 5.0))
    assert any("behind a cut the fabric of its two sides does not join" in w for w in cut.warnings)


def test_a_cut_ends_with_the_blank():
    part = plane_sheet(12, 120.0).cut([[60, 60, 0], [110, 60, 0]])
    drape = gd.evaluate(gd.drape(part, (60.0, 50.0, 0.0), 0.0, 5.0, reach=(30.0, 25.0)))
    ends = np.array(drape.flat.cuts)[..., 0]
    assert ends.min() == pytest.approx(0.0, abs=0.1)
    assert ends.max() == pytest.approx(30.0, abs=5.0)  # to half a piece of the line
