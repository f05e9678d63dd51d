"""The light evaluation of a sweep gives the numbers of the full one, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest
from made_parts import bumpy_sheet, pyramid

import geomdrap as gd
from geomdrap.fields.figures import figures
from geomdrap.surface import shapes

PARTS = {
    "bumps": bumpy_sheet,
    "pyramid": lambda: pyramid(slope=0.9),
    "sphere": lambda: shapes.icosphere(50.0, 4),
    "bracket": lambda: shapes.bracket(edge=12.0),
}


@pytest.mark.parametrize("name", PARTS)
@pytest.mark.parametrize("angle", [0.0, 33.0])
def test_areas_and_statistics_are_those_of_the_full_evaluation(name: str, angle: float) -> None:
    net = gd.drape(PARTS[name](), angle=angle)
    light, full = figures(net, 20.0), gd.evaluate(net, 20.0)
    assert light.area == full.area
    assert light.statistics == full.statistics


@pytest.mark.parametrize("reach", [None, (30.0, 25.0)])
def test_the_least_blank_is_the_box_round_the_flat_pattern(reach: tuple[float, float] | None) -> None:
    net = gd.drape(bumpy_sheet(), angle=20.0, reach=reach)
    corners = np.concatenate(gd.evaluate(net).flat.outer)
    assert figures(net).blank == pytest.approx(tuple(np.ptp(corners, axis=0)), abs=1e-3)


def test_a_limit_angle_out_of_range_is_refused() -> None:
    with pytest.raises(gd.DrapeError, match="limit angle"):
        figures(gd.drape(bumpy_sheet()), 100.0)
