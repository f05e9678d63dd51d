"""Families of tools: not too steep to lay, rounded as their flags say, and enough of them for each effect."""

from __future__ import annotations

import numpy as np
import pytest

from geomdrap.blind import HIDDEN, LIBRARY, TOOLS, make, unseal
from geomdrap.blind.ply import lay
from geomdrap.blind.recipe import Recipe
from geomdrap.blind.shear import node_shear
from geomdrap.blind.tools import CONCAVE, draw_tool
from geomdrap.errors import GeomdrapError

SMALLEST_BALL = 50.0  # mm, that bridging draws
GEOMETRIC = ("slip", "bridging", "springback")
"""Effects that do not show everywhere, and take no relaxed net."""


def drawn(name, seed):
    """A tool and slopes and curvatures (n,) of its height on a grid over it."""
    tool = draw_tool(name, np.random.default_rng(seed))
    x, y = np.meshgrid(*(np.linspace(-half, half, 201) for half in tool.half))
    return tool, tool.term(x.ravel(), y.ravel())[1:]


@pytest.mark.parametrize("name", TOOLS)
def test_no_tool_is_steeper_than_60_degrees(name):
    for seed in range(20):
        _, (zx, zy, *_) = drawn(name, seed)
        assert np.degrees(np.arctan(np.hypot(zx, zy).max())) < 60.0


@pytest.mark.parametrize("name", TOOLS)
def test_concave_tools_and_no_others_have_a_fillet_tighter_than_any_ball(name):
    for seed in range(20):
        tool, (zx, zy, zxx, zxy, zyy) = drawn(name, seed)
        grown = 1.0 + zx * zx + zy * zy
        mean = ((1.0 + zy * zy) * zxx - 2.0 * zx * zy * zxy + (1.0 + zx * zx) * zyy) / (2.0 * grown**1.5)
        gauss = (zxx * zyy - zxy * zxy) / grown**2
        tightest = np.max(mean + np.sqrt(np.maximum(mean * mean - gauss, 0.0)))
        assert tool.concave == (name in CONCAVE) == (tightest > 1.0 / SMALLEST_BALL)


@pytest.mark.parametrize("name", TOOLS)
def test_a_ply_covers_the_tool_from_any_heading_and_seed(name):
    rng = np.random.default_rng(5)
    for angle in (0.0, 20.0, 45.0, 70.0):
        tool, (zx, zy, *_) = drawn(name, int(angle))
        ply = lay(tool, Recipe(start=tuple(rng.uniform(-10.0, 10.0, 2)), angle=angle), 10.0)
        shear = np.abs(node_shear(ply.points))
        assert np.nanmax(shear) < 65.0
        area = 4.0 * tool.half[0] * tool.half[1] * np.sqrt(1.0 + zx * zx + zy * zy).mean()
        assert np.isfinite(shear).sum() * 100.0 > 0.7 * area


@pytest.mark.parametrize("effect", LIBRARY)
def test_each_known_effect_shows_on_four_families_or_more(effect):
    assert len(set(HIDDEN[effect].parts)) >= 4
    assert set(HIDDEN[effect].parts) <= set(TOOLS)


@pytest.mark.slow
@pytest.mark.parametrize(("effect", "part"), [(e, p) for e in GEOMETRIC for p in HIDDEN[e].parts])
def test_an_effect_shows_on_each_part_that_is_drawn_for_it(tmp_path, effect, part):
    assert unseal(make(7, effect=effect, part=part, folder=tmp_path))["signal_to_noise"] > 15.0


def test_a_part_that_does_not_exist_is_refused_with_those_that_do():
    with pytest.raises(GeomdrapError, match=r"dome.*joggle"):
        draw_tool("teapot", np.random.default_rng(0))
