"""Generators that follow curves of the user's, node by node."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from made_parts import bumpy_sheet, sheet

import geomdrap as gd
from geomdrap.cli import cli
from geomdrap.surface import shapes

LINE = np.linspace(-1.0, 1.0, 80)


def _warp(net: gd.Net) -> np.ndarray:
    """Nodes (n, 3) of the warp generator, in its order."""
    nodes = net.points[:, int(np.argmin(np.abs(net.v)))]
    return nodes[np.isfinite(nodes[:, 0])]


def _weft(net: gd.Net) -> np.ndarray:
    nodes = net.points[int(np.argmin(np.abs(net.u)))]
    return nodes[np.isfinite(nodes[:, 0])]


def test_on_a_plate_the_warp_lies_on_the_parabola_and_its_sides_are_the_pitch() -> None:
    plate = shapes.plane(300.0, 200.0, edge=10.0)
    curve = np.column_stack([150.0 * LINE, 40.0 * LINE**2 - 20.0, 0.0 * LINE])
    net = gd.drape(plate, pitch=5.0, warp_guide=curve)
    nodes = _warp(net)
    assert np.abs(nodes[:, 1] - (40.0 * (nodes[:, 0] / 150.0) ** 2 - 20.0)).max() < 0.02  # sag of its chords
    assert np.linalg.norm(np.diff(nodes, axis=0), axis=1) == pytest.approx(5.0)
    assert net.origin == pytest.approx((0.0, -20.0, 0.0), abs=0.02)
    assert net.angle == pytest.approx(0.0, abs=0.6)


def test_on_a_plate_shear_is_how_far_the_warp_has_turned() -> None:
    """A weft yarn leaves a node as the one at the seed does: shear is the turn of the warp since the seed."""
    plate = shapes.plane(300.0, 200.0, edge=10.0)
    curve = np.column_stack([150.0 * LINE, 40.0 * LINE**2 - 20.0, 0.0 * LINE])
    net = gd.drape(plate, pitch=2.5, warp_guide=curve)
    i, j = np.nonzero(np.isfinite(net.shear))
    x = net.points[i, j, 0]
    turned = np.degrees(np.arctan(2.0 * 40.0 * x / 150.0**2))
    inner = np.abs(net.v[j]) < 30.0
    assert np.abs(np.abs(net.shear[i, j]) - np.abs(turned))[inner].max() < 0.5


def test_a_geodesic_as_a_guide_gives_the_plain_net() -> None:
    cap = shapes.sphere_cap(100.0, 60.0, edge=5.0)
    turn_rad = np.radians(58.0 * LINE)
    curve = 100.0 * np.column_stack([np.sin(turn_rad), 0.0 * turn_rad, np.cos(turn_rad)])
    guided, plain = gd.drape(cap, (0, 0, 100), pitch=6.0, warp_guide=curve), gd.drape(cap, (0, 0, 100), pitch=6.0)
    at = np.linalg.norm(guided.points - plain.points, axis=2)
    assert np.nanmax(at) < 0.7  # the seed is the guide's nearest point, on its chords
    assert np.nanmax(np.abs(guided.shear - plain.shear)) < 0.5


def test_a_circle_of_latitude_is_followed_and_left_straight_at_its_end() -> None:
    cap = shapes.sphere_cap(100.0, 60.0, edge=5.0)
    turn_rad = np.radians(90.0 + 60.0 * LINE)
    high = np.sin(np.radians(70.0))
    curve = 100.0 * np.column_stack(
        [np.cos(np.radians(70.0)) * f(turn_rad) for f in (np.cos, np.sin)] + [0 * LINE + high]
    )
    net = gd.drape(cap, (0.0, 34.2, 94.0), pitch=3.0, warp_guide=curve)
    nodes = _warp(net)
    latitude = np.degrees(np.arcsin(nodes[:, 2] / np.linalg.norm(nodes, axis=1)))
    on_guide = np.abs(np.degrees(np.arctan2(nodes[:, 1], nodes[:, 0])) - 90.0) < 55.0
    assert on_guide.sum() > 15
    assert np.abs(latitude[on_guide] - 70.0).max() < 0.01
    assert latitude[0] < 60.0  # past its end a great circle, which comes down
    assert latitude[-1] < 60.0


def test_the_weft_follows_a_guide_too() -> None:
    plate = shapes.plane(200.0, 200.0, edge=10.0)
    curve = np.column_stack([20.0 * LINE**2, 100.0 * LINE, 0.0 * LINE])
    nodes = _weft(gd.drape(plate, pitch=5.0, weft_guide=curve))
    assert np.abs(nodes[:, 0] - 20.0 * (nodes[:, 1] / 100.0) ** 2).max() < 0.02


def test_where_two_guides_cross_askew_the_ply_is_sheared_by_that() -> None:
    plate = shapes.plane(300.0, 200.0, edge=10.0)
    askew = np.radians(12.0)
    warp = 150.0 * np.column_stack([LINE * np.cos(askew), LINE * np.sin(askew), 0.0 * LINE])
    weft = 100.0 * np.column_stack([0.0 * LINE, LINE, 0.0 * LINE])
    net = gd.drape(plate, pitch=5.0, warp_guide=warp, weft_guide=weft)
    assert net.angle == pytest.approx(12.0)
    assert net.cell_shear[net.cell_valid] == pytest.approx(12.0, abs=1e-3)
    assert gd.evaluate(net).area.coverage > 0.999
    assert gd.evaluate(net).checks.curvature_residual is None


def test_on_a_bumpy_part_both_generators_lie_on_their_guides() -> None:
    part = bumpy_sheet(n=40)
    warp = part.nearest(np.column_stack([45 * LINE, 8 * np.sin(2 * LINE), 0 * LINE])).point
    weft = part.nearest(np.column_stack([6 * LINE**2, 45 * LINE, 0 * LINE])).point
    net = gd.drape(part, pitch=2.0, warp_guide=warp, weft_guide=weft)
    for nodes, guide in ((_warp(net), warp), (_weft(net), weft)):
        inner = np.abs(nodes[:, :2]).max(axis=1) < 42.0
        dense = np.concatenate([a + np.linspace(0, 1, 50)[:, None] * (b - a) for a, b in pairwise(guide)])
        away = np.linalg.norm(nodes[inner][:, None] - dense[None], axis=2).min(axis=1)
        assert away.max() < 0.1
    assert gd.evaluate(net).checks.edge_error < 1e-9


@pytest.mark.parametrize(
    ("guides", "words"),
    [
        ({"warp_guide": [[0, 0, 0]]}, "the warp guide must have two different points"),
        ({"warp_guide": [[0, 0, 0], [0, 0, 0]]}, "two different points"),
        ({"warp_guide": [[0, 0], [1, 1]]}, "must be points"),
        ({"warp_guide": [[0, 0, 0], [9, 0, float("nan")]]}, "must be points"),
        (
            {"weft_guide": [[0, 0, 0], [400, 0, 0]]},
            r"the weft guide leaves plane: at \(15[5-9].* it lies .* move it",
        ),
        ({"warp_guide": [[-50, 0, 0], [50, 0, 0]], "weft_guide": [[-50, 40, 0], [50, 40, 0]]}, "do not cross"),
        ({"warp_guide": [[-50, 0, 0], [50, 0, 0]], "weft_guide": [[0, 40, 0], [0, -40, 0]]}, "leaves at -90.0°"),
        ({"warp_guide": [[-50, 0, 0], [0, 0, 0], [-50, 1, 0]]}, "bends too tightly for a pitch of 5 mm"),
    ],
)
def test_a_guide_that_cannot_be_followed_is_refused(guides: dict[str, list[list[float]]], words: str) -> None:
    plate = shapes.plane(300.0, 200.0, edge=10.0)
    with pytest.raises(gd.DrapeError, match=words):
        gd.drape(plate, (-20.0, 0.0, 0.0), pitch=5.0, **guides)


def test_a_guide_beside_an_effect_that_turns_generators_is_refused() -> None:
    plate = shapes.plane(300.0, 200.0, edge=10.0)
    curve = [[-50, 0, 0], [50, 0, 0]]
    for name, values in (
        ("steering", {"curvature_warp": 1.0}),
        ("weave-skew", {"skew": 2.0}),
        ("placement", {"du": 3.0}),
    ):
        with pytest.raises(gd.DrapeError, match="use one or the other"):
            gd.drape(plate, pitch=5.0, warp_guide=curve, effects=[gd.effects.make(name, **values)])


def test_the_command_takes_guides_from_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    CliRunner().invoke(cli, ["sample", "saddle", "--facets", "1500"], catch_exceptions=False)
    (tmp_path / "spine.csv").write_text("x,y,z\n-150,-20,36.8\n0,10,0\n150,-20,36.8\n")
    asked = ["drape", "saddle.stl", "--warp-guide", "spine.csv", "--project", "--outputs", "none"]
    result = CliRunner().invoke(cli, asked, catch_exceptions=False)
    assert result.exit_code == 0
    assert "Note: the warp through the origin follows its guide" in result.stderr
    for more, words in (
        (["--angle", "10"], "--warp-guide and --angle contradict"),
        (["--plies", "0"], "--plies contradict"),
    ):
        result = CliRunner().invoke(cli, [*asked, *more], catch_exceptions=False)
        assert result.exit_code == 2
        assert words in result.stderr
    (tmp_path / "spine.csv").write_text("a,b\n1,2\n")
    assert "no column x, y, z" in CliRunner().invoke(cli, asked, catch_exceptions=False).stderr


@pytest.mark.parametrize("y", [40.0, 45.0, 50.0])
def test_a_smooth_curve_is_followed_however_finely_it_is_sampled(y: float) -> None:
    """Laid onto the facets it has a corner at each edge, where the nearest place may jump."""

    def bell(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.asarray(60.0 * np.exp(-(x**2 + y**2) / 3200.0))

    grid = np.meshgrid(np.linspace(-100, 100, 61), np.linspace(-100, 100, 61), indexing="ij")
    x = np.arange(-100.0, 100.5, 1.0)
    curve = np.column_stack([x, np.full(len(x), y), bell(x, np.full(len(x), y))])
    nodes = _warp(gd.drape(sheet(np.stack([*grid, bell(*grid)], axis=2)), pitch=5.0, warp_guide=curve))
    assert len(nodes) > 38
    assert np.abs(nodes[:, 1] - y).max() < 0.1
