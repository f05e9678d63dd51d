"""A stack of plies: each lies on those below, and is as long as the surface that they make."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

import click
import numpy as np
import pytest
from click.testing import CliRunner, Result
from made_parts import bumpy_sheet

import geomdrap as gd
from geomdrap.cli import cli
from geomdrap.cli.drape import THICKNESS
from geomdrap.cli.drape import drape as drape_command
from geomdrap.cli.plies import by_plies
from geomdrap.surface import shapes
from geomdrap.sweep import lay_plies
from geomdrap.sweep.plies import thickness_factor


def test_on_a_plate_every_ply_is_the_same_and_lies_one_thickness_higher() -> None:
    plies = lay_plies(shapes.plane(edge=20.0), [0.0, 45.0, 0.0], 0.3, pitch=10.0)
    for k, ply in enumerate(plies):
        assert np.nanmax(np.abs(ply.drape.net.points[..., 2] - 0.3 * k)) < 1e-9
        assert ply.below == pytest.approx((0.3 * k, 0.3 * k))
        assert ply.drape.statistics.max == pytest.approx(0.0, abs=1e-6)
        assert ply.drape.area.fabric == pytest.approx(plies[0].drape.area.fabric)
    assert np.array_equal(plies[0].drape.net.u, plies[2].drape.net.u)


def test_the_first_ply_is_the_plain_drape() -> None:
    part = bumpy_sheet()
    ply = lay_plies(part, [30.0], 0.2, angle=10.0, pitch=8.0)[0]
    plain = gd.drape(part, angle=40.0, pitch=8.0)
    assert np.array_equal(ply.drape.net.points, plain.points, equal_nan=True)
    assert ply.tool is part


def test_on_a_cylinder_the_fabric_grows_as_the_radius_does() -> None:
    tube = shapes.cylinder(100.0, 200.0, edge=4.0)
    up = np.sign((tube.normals * (tube.points[tube.triangles].mean(axis=1) * [0, 1, 1])).sum(axis=1).mean())
    plies = lay_plies(tube, [0.0, 90.0, 45.0], 2.0, pitch=8.0)
    for k, ply in enumerate(plies):
        assert ply.drape.area.fabric == pytest.approx(plies[0].drape.area.fabric * (1 + up * 0.02 * k), rel=2e-3)
        assert ply.drape.statistics.p95 < 0.1


def test_on_a_sphere_plies_lie_on_spheres_thicker_where_they_shear() -> None:
    radius, thickness = 100.0, 1.0
    part = shapes.sphere_cap(radius, 50.0, edge=4.0)
    first, second, third = lay_plies(part, [0.0, 0.0, 0.0], thickness, pitch=6.0)
    at = second.drape.net
    away = np.linalg.norm(at.points, axis=2)
    pole = np.unravel_index(np.nanargmax(at.points[..., 2]), at.points.shape[:2])
    assert away[pole] == pytest.approx(radius + thickness, abs=0.03)
    factor = thickness_factor(first)
    shear = np.degrees(np.arccos(1.0 / np.maximum(factor, 1.0)))
    assert shear.max() == pytest.approx(first.drape.statistics.max, abs=3.0)
    raised = np.linalg.norm(second.tool.points, axis=1) - np.linalg.norm(part.points, axis=1)
    assert raised == pytest.approx(thickness * factor, abs=2e-3)
    assert third.below[1] > third.below[0] > 2.0 * thickness


def test_where_a_ply_is_bare_it_adds_nothing() -> None:
    ply = lay_plies(shapes.plane(300.0, 200.0, edge=10.0), [0.0, 0.0], 0.5, reach=(50.0, 50.0), pitch=10.0)[1]
    away = np.abs(ply.tool.points[:, :2]).max(axis=1)
    assert ply.tool.points[away < 39.0, 2] == pytest.approx(0.5)
    assert ply.tool.points[away > 61.0, 2] == pytest.approx(0.0)


def test_plies_on_one_piece_of_a_part_leave_the_others_as_they_are() -> None:
    one = shapes.plane(100.0, 100.0, edge=20.0)
    both = gd.Surface(
        np.vstack([one.points, one.points + [500.0, 0.0, 0.0]]),
        np.vstack([one.triangles, one.triangles + len(one.points)]),
    )
    ply = lay_plies(both, [0.0, 0.0], 0.5, origin=(0.0, 0.0, 0.0), pitch=10.0)[1]
    left = ply.tool.points[:, 0] < 200.0
    assert ply.tool.points[left, 2] == pytest.approx(0.5)
    assert ply.tool.points[~left, 2] == pytest.approx(0.0)


def test_a_hollow_that_plies_fill_up_is_named() -> None:
    part = shapes.sphere_cap(10.0, 60.0, edge=1.0).flipped()  # the ply lies inside
    with pytest.raises(gd.DrapeError, match=r"curved more tightly than ply \d+ is thick"):
        lay_plies(part, [0.0] * 4, 6.0, pitch=1.0)


@pytest.mark.parametrize("thickness", [0.0, -1.0, float("nan"), float("inf")])
def test_a_thickness_that_is_not_positive_is_refused(thickness: float) -> None:
    with pytest.raises(gd.DrapeError, match="thickness of a ply must be a positive number"):
        lay_plies(bumpy_sheet(), [0.0], thickness)


def test_more_plies_than_can_be_meant_are_refused() -> None:
    with pytest.raises(gd.DrapeError, match="1001 plies are more than the 1000"):
        lay_plies(bumpy_sheet(), [0.0] * 1001, 0.1)


@pytest.fixture
def command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Result]:
    """Drape a small saddle with options."""
    monkeypatch.chdir(tmp_path)
    CliRunner().invoke(cli, ["sample", "saddle", "--facets", "1500"], catch_exceptions=False)
    return lambda *more: CliRunner().invoke(
        cli, ["drape", "saddle.stl", "--pitch", "15", *map(str, more)], catch_exceptions=False
    )


def test_the_command_writes_a_folder_per_ply(command: Callable[..., Result], tmp_path: Path) -> None:
    result = command("--plies", "0,45,-45", "--ply-thickness", 0.4, "--angle", 10, "--json", "--outputs", "json,dxf")
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    assert document["schema"] == "geomdrap.plies/1"
    assert [ply["angle"] for ply in document["plies"]] == [10.0, 55.0, -35.0]
    assert [ply["ply_angle"] for ply in document["plies"]] == [0.0, 45.0, -45.0]
    assert document["plies"][2]["below"]["mean"] > 0.8
    assert document["fabric"] == pytest.approx(sum(ply["area"]["fabric"] for ply in document["plies"]))
    for number in (1, 2, 3):
        folder = tmp_path / "drape" / f"ply-{number}"
        assert sorted(path.name for path in folder.iterdir()) == ["drape.json", "flat.dxf"]
        own = json.loads((folder / "drape.json").read_text())
        assert own["angle"] == document["plies"][number - 1]["angle"]
    assert json.loads((tmp_path / "drape" / "plies.json").read_text())["plies"][0]["ply_angle"] == 0.0


@pytest.mark.parametrize(
    ("after", "words"),
    [
        (0, "interrupted; nothing was written"),
        (1, "interrupted; 1 of 3 plies are written, in drape/ply-1, and no plies.json of them"),
        (2, "interrupted; 2 of 3 plies are written, in drape/ply-1 to ply-2, and no plies.json of them"),
    ],
)
def test_ctrl_c_says_which_plies_are_written(
    command: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, after: int, words: str
) -> None:
    from geomdrap.export import plies_outputs

    def write_all(drape: object, folder: Path, *more: object, **named: object) -> dict[str, Path]:
        if folder.name == f"ply-{after + 1}":
            raise KeyboardInterrupt
        return plain(drape, folder, *more, **named)

    plain = plies_outputs.write_all
    monkeypatch.setattr(plies_outputs, "write_all", write_all)
    result = command("--plies", "0,45,-45", "--outputs", "json")
    assert result.exit_code == 130
    assert result.stderr.splitlines()[-1] == f"Error: {words}".replace("drape/", f"{Path('drape')}{os.sep}")
    there = sorted(path.name for path in (tmp_path / "drape").iterdir()) if after else []
    assert there == [f"ply-{n}" for n in range(1, after + 1)]


def test_what_is_said_of_several_plies_is_said_once_with_their_numbers() -> None:
    assert by_plies([("a", "b"), ("b",), (), ("b", "b", "c")]) == ["ply 1: a", "plies 1, 2, 4: b", "ply 4: c"]
    assert by_plies([(), ()]) == []


def test_plies_and_files_of_an_earlier_run_are_warned_of(command: Callable[..., Result]) -> None:
    command("--plies", "0,45,90", "--outputs", "json,dxf")
    command("--outputs", "json")
    result = command("--plies", "0", "--outputs", "json", "--json")
    left = [
        "drape.json, ply-2, ply-3 in drape are of an earlier run: remove them, or use another folder (-o)",
        f"flat.dxf in {Path('drape', 'ply-1')} is of an earlier run: remove it, or use another folder (-o)",
    ]
    assert [line for line in result.stderr.splitlines() if "earlier" in line] == [f"Warning: {text}" for text in left]
    assert json.loads(result.stdout)["warnings"][-2:] == left
    assert "earlier" not in command("--plies", "0", "--outputs", "json", "-o", "fresh").stderr


def test_elements_that_get_no_ply_are_warned_of_with_the_plies(command: Callable[..., Result]) -> None:
    result = command("--plies", "0,45", "--outputs", "abaqus", "--blank", "60x60")
    lines = [line for line in result.stderr.splitlines() if "have no ply" in line]
    assert lines
    assert lines[0].startswith("Warning: pl")


@pytest.mark.parametrize("asked", [("drape", "--plies", "0"), ("sweep",), ("optimize",)])
def test_a_pitch_that_there_is_no_room_for_is_refused_before_anything_is_draped(
    command: Callable[..., Result], asked: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("geomdrap.fields.pieces.MOST_PIECES", 1000)
    name, *more = asked
    result = CliRunner().invoke(cli, [name, "saddle.stl", *more, "--pitch", "2"])
    assert result.exit_code == 2
    assert "a pitch of 2 mm is too small for saddle.stl" in result.stderr
    assert "Draping" not in result.stderr


def test_the_summary_has_a_line_per_ply(command: Callable[..., Result]) -> None:
    lines = command("--plies", "0,-45, 0", "--outputs", "none").stdout.splitlines()
    assert [line.split()[:2] for line in lines if line.lstrip()[:1].isdigit()] == [
        ["1", "0"],
        ["2", "-45"],
        ["3", "0"],
    ]


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        *(
            (("--plies", text), f"'{text}' is not a finite number, or several with commas")
            for text in ("0,up", "", "0,,90", "nan", "1_0")
        ),
        (("--plies", "0", "--ply-thickness", "0"), "0 is not a finite number above 0"),
        (("--plies", "0,90", "--fe-axis", "1,0,0"), "take one ply: leave --plies out"),
    ],
)
def test_bad_plies_are_said(command: Callable[..., Result], asked: tuple[str, ...], words: str) -> None:
    result = command(*asked)
    assert result.exit_code == 2
    assert words in result.stderr


def test_the_help_names_the_thickness_that_plies_have_if_none_is_given() -> None:
    option = next(p for p in drape_command.params if p.name == "ply_thickness")
    assert isinstance(option, click.Option)
    assert f"with --plies {THICKNESS:g}]" in str(option.help)


def test_guide_curves_are_refused_beside_plies_and_need_a_name(command: Callable[..., Result]) -> None:
    for guide in ("--warp-guide", "--weft-guide"):
        result = command("--plies", "0", guide, "spine.csv")
        assert (result.exit_code, f"{guide} and --plies contradict each other" in result.stderr) == (2, True)
        result = command(guide, "")
        assert (result.exit_code, "the name is empty" in result.stderr) == (2, True)
