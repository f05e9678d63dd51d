"""`geomdrap drape --onto`: the ply on a finite element mesh, from the command line."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result

sys.path.insert(0, str(Path(__file__).parents[1] / "export"))

from fe_decks import abaqus, grid, nastran

PART = Path(__file__).parents[2] / "samples" / "parts" / "saddle.stl"
FAST = "--pitch", "15", "--outputs"
Run = Callable[..., Result]


@pytest.fixture
def mesh(run: Run) -> Path:
    """Quads on the saddle z = (x² − y²)/600, and the 44 of the outer ring beside it, by two pitches."""
    points, quads = grid(12, 12, 400.0, height=lambda x, y: (x**2 - y**2) / 600)
    Path("fe_mesh.inp").write_text(abaqus(points, quads))
    Path("fe_mesh.bdf").write_text(nastran(points, quads))
    return Path("fe_mesh.inp")


def test_the_format_of_the_mesh_is_written_and_elements_without_ply_are_named(run: Run, mesh: Path) -> None:
    done = run("drape", PART, *FAST, "json", "--onto", mesh, "-o", "out", "--ply-thickness", "0.3")
    assert done.exit_code == 0, done.stderr
    assert sorted(f.name for f in Path("out").iterdir()) == ["acp.csv", "drape.json", "fe.inp"]
    text = Path("out/fe.inp").read_text()
    assert "*ORIENTATION, NAME=GEOMDRAP_WARP_AXES" in text
    assert "NAME=GEOMDRAP_THICKNESS," in text
    assert "*NODE" not in text, "the mesh is the user's own"
    rows = Path("out/acp.csv").read_text().splitlines()
    assert len(rows) == 1 + 144 - 44
    assert "Warning: 44 of 144 elements of fe_mesh.inp have no ply" in done.stderr


def test_formats_can_be_named_whatever_the_mesh_is(run: Run, mesh: Path) -> None:
    done = run("drape", PART, *FAST, "optistruct,radioss", "--onto", mesh.with_suffix(".bdf"), "-o", "out", "-q")
    assert done.exit_code == 0, done.stderr
    assert sorted(f.name for f in Path("out").iterdir()) == ["fe.fem", "fe.inc"]


def test_nodes_that_a_deck_of_another_solver_leaves_loose_are_warned_of(run: Run, mesh: Path) -> None:
    mesh.write_text("*NODE\n99, 0., 0., 0.\n" + mesh.read_text())
    for outputs, count in (("nastran", 1), ("optistruct", 0)):
        done = run("drape", PART, *FAST, outputs, "--onto", mesh, "-o", "out")
        assert done.exit_code == 0, done.stderr
        assert done.stderr.count("by their corners alone: its other nodes, 1 of them") == count


def test_the_axis_of_ply_angles_can_be_given(run: Run, mesh: Path) -> None:
    angles = []
    for axis in ("1,0,0", "0,1,0"):
        done = run("drape", PART, *FAST, "optistruct", "--onto", mesh, "-o", "out", "-q", "--fe-axis", axis)
        assert done.exit_code == 0, done.stderr
        lines = [line for line in Path("out/fe.fem").read_text().splitlines() if line.startswith("+")]
        angles.append(np.array([float(line[32:40]) for line in lines]))
    turn = np.abs((angles[0] - angles[1] + 180.0) % 360.0 - 180.0)
    np.testing.assert_allclose(turn, 90.0, atol=20.0)  # x and y laid into sloping elements are not at right angles


def test_without_a_mesh_decks_hold_the_part(run: Run) -> None:
    done = run("drape", PART, *FAST, "abaqus,nastran", "-o", "out", "-q")
    assert done.exit_code == 0, done.stderr
    assert Path("out/fe.inp").read_text().count("*ELEMENT") == 1
    assert "GRID " in Path("out/fe.bdf").read_text()


def test_a_bad_mesh_is_refused_before_anything_is_computed(run: Run, error_of: Callable[..., str]) -> None:
    assert "nowhere.inp cannot be read" in error_of("drape", "missing.stl", "--onto", "nowhere.inp")
    Path("fe.stl").write_text("solid")
    assert "not '.stl'" in error_of("drape", "missing.stl", "--onto", "fe.stl")
    assert "--outputs none" in error_of("drape", PART, "--onto", "fe.inp", "--outputs", "none")


def test_a_mesh_in_metres_is_refused_with_a_hint(run: Run, error_of: Callable[..., str]) -> None:
    points, quads = grid(4, 4, 300.0)
    Path("m.inp").write_text(abaqus(1e-3 * points, quads))
    assert "0.001 times as large as the part; write the mesh in mm" in error_of("drape", PART, *FAST, "json", "--onto", "m.inp", "-o", "out")
