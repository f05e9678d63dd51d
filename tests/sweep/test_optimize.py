"""The optimum: where it is known, never worse than the sweep, and reached by real drapes."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from made_parts import bumpy_sheet, square_tube
from scipy.spatial.transform import Rotation

import geomdrap as gd
from geomdrap.cli import cli
from geomdrap.surface import samples, shapes
from geomdrap.sweep import CRITERIA, Case, Job, Objective, cases_of, locate_origins, optimize, parse_angles, run
from geomdrap.sweep.optimize import AXES, FINEST, FINEST_ANGLE, Step, _around, first_headings


def _begin(surface: gd.Surface, grid: str, angles: str = "0:75:15") -> list[gd.sweep.Case]:
    return cases_of(locate_origins(surface, [grid])[0], parse_angles(angles))


@pytest.mark.parametrize("objective", ["max-shear", "p95-shear"])
def test_on_a_sphere_cap_the_best_origin_is_the_pole(objective: str) -> None:
    cap = shapes.sphere_cap(100.0, 60.0, edge=10.0)
    pitch = 10.0
    # an even grid: the pole is not on it
    found = optimize(Job(cap, pitch), _begin(cap, "grid:4x4", "0:60:30"), objective)
    assert np.hypot(*found.of_sweep.origin[:2]) > 20.0
    assert np.hypot(*found.best.origin[:2]) < 0.5 * pitch


@pytest.mark.slow
def test_on_the_sample_hemisphere_with_its_flange_the_best_origin_is_the_pole() -> None:
    part = samples.build("hemisphere", facets=6000)
    found = optimize(Job(part, 5.0), _begin(part, "grid:4x4", "0:60:30"))
    assert np.hypot(*found.best.origin[:2]) < 2.5
    assert found.best.coverage > 0.999


@pytest.mark.parametrize(
    "seed", [0, pytest.param(1, marks=pytest.mark.slow), pytest.param(2, marks=pytest.mark.slow)]
)
def test_on_a_saddle_tilted_anyhow_the_best_drape_lies_along_the_diagonals_from_the_middle(seed: int) -> None:
    flat = shapes.saddle(edge=8.0)
    turned = Rotation.random(random_state=seed).as_matrix()
    part = gd.Surface(flat.points @ turned.T, flat.triangles)
    pitch = 8.0
    best = optimize(Job(part, pitch), _begin(part, "grid:4x4", "0:75:25")).best
    warp = turned.T @ gd.drape(part, best.origin, best.angle, pitch, project=True).warp0
    heading = np.degrees(np.arctan2(warp[1], warp[0])) % 90.0
    assert heading == pytest.approx(45.0, abs=1.5)
    assert np.linalg.norm(turned.T @ best.origin) < 0.5 * pitch


@pytest.mark.parametrize("objective", CRITERIA)
def test_the_optimum_is_never_worse_than_the_sweep_and_is_a_real_drape(objective: str) -> None:
    job = Job(bumpy_sheet(), pitch=8.0)
    cases, wanted = _begin(job.surface, "grid:2x2", "0:60:30"), Objective.parse(objective)
    found = optimize(job, cases, objective, budget=60)
    swept = run(job, cases, objective)
    assert found.of_sweep == swept.best
    assert wanted.score(found.best) <= wanted.score(swept.best)
    assert job.row(Case(*found.best.key)) == found.best
    assert job.surface.nearest([found.best.origin]).distance[0] < 1e-6


def test_the_way_falls_step_by_step_to_the_best() -> None:
    job = Job(bumpy_sheet(), pitch=8.0)
    found = optimize(job, _begin(job.surface, "grid:2x2", "0:60:30"))
    scores = [row.max_shear for row in found.path]
    assert len(scores) > 1
    assert all(b < a for a, b in pairwise(scores))
    assert found.path[0] in found.sweep.rows
    assert found.path[-1] == found.best


@pytest.mark.parametrize("seed", [4, pytest.param(3, marks=pytest.mark.slow)])
def test_no_step_of_a_quarter_of_the_pitch_or_of_a_degree_from_a_converged_optimum_is_better(seed: int) -> None:
    job = Job(bumpy_sheet(seed), pitch=8.0)
    found = optimize(job, _begin(job.surface, "grid:2x2", "0:60:30"), budget=2500)
    assert found.converged
    x, y, z = found.best.origin
    score = found.sweep.objective.score
    for turn in (-FINEST_ANGLE, FINEST_ANGLE):
        assert score(job.row(Case((x, y, z), found.best.angle + turn))) >= score(found.best)
    frame = gd.drape(job.surface, found.best.origin, found.best.angle, 8.0)
    for direction in (frame.warp0, -frame.warp0, frame.weft0, -frame.weft0):
        aside = gd.trace(job.surface, found.best.origin, direction, FINEST * 8.0).point
        assert score(job.row(Case(tuple(aside.tolist()), found.best.angle))) >= score(found.best)


def test_where_an_effect_displaces_the_ply_a_step_leads_to_a_drape_one_step_away() -> None:
    job = Job(shapes.plane(400.0, 300.0, edge=50.0), 20.0, effects=(gd.effects.parse("placement:du=20"),))
    row = job.row(Case("centroid", 30.0))
    assert np.linalg.norm(row.origin) == pytest.approx(20.0)
    for case in _around(job, row, Step(5.0, 1.0), AXES)[:4]:
        away = np.subtract(job.row(case).origin, row.origin)
        assert np.linalg.norm(away) == pytest.approx(5.0)


@pytest.mark.parametrize(
    ("asked", "written"),
    [
        ({}, "0:75:15"),
        ({"reach": (200.0, 200.0)}, "0:75:15"),
        ({"reach": (400.0, 100.0)}, "0:165:15"),
        ({"effects": (gd.effects.parse("thickness:offset=1"),)}, "0:165:15"),
    ],
)
def test_the_search_begins_over_half_a_turn_where_warp_and_weft_differ(asked: dict[str, Any], written: str) -> None:
    assert first_headings(Job(bumpy_sheet(), 8.0, **asked)) == parse_angles(written)


def test_a_strip_is_best_laid_along_a_plate_though_it_stands_across_it() -> None:
    across = Job(shapes.plane(100.0, 400.0, edge=20.0), 10.0, reach=(200.0, 50.0))
    cases = cases_of(["centroid"], first_headings(across))
    assert optimize(across, cases, "coverage", budget=0).best.angle == 90.0


def test_the_budget_is_kept_and_said() -> None:
    job = Job(bumpy_sheet(), pitch=8.0)
    cases = _begin(job.surface, "grid:2x2", "0:60:30")
    found = optimize(job, cases, budget=20)
    assert len(cases) < len(found.sweep.rows) <= len(cases) + 20
    assert not found.converged
    assert optimize(job, cases, budget=0).best == run(job, cases).best


def test_two_processes_find_the_same_drapes_as_one() -> None:
    from geomdrap.sweep.pool import LocalPool

    job = Job(bumpy_sheet(), pitch=8.0)
    cases = _begin(job.surface, "grid:2x1", "0:60:30")
    one, two = optimize(job, cases, budget=40), optimize(job, cases, budget=40, pool=LocalPool(job, 2))
    assert one.path == two.path
    assert {row.key: row for row in one.sweep.rows} == {row.key: row for row in two.sweep.rows}


def test_on_a_closed_developable_part_every_drape_is_as_good() -> None:
    found = optimize(Job(square_tube(), pitch=10.0), _begin(square_tube(), "grid:2x1", "0"), "max-shear", budget=30)
    assert found.best.max_shear == pytest.approx(0.0, abs=1e-6)


def test_without_a_case_or_a_drape_there_is_no_optimum() -> None:
    job = Job(bumpy_sheet(), pitch=8.0)
    with pytest.raises(gd.SweepError, match="at least one origin and one angle"):
        optimize(job, [])
    with pytest.raises(gd.SweepError, match="none of the 1 cases could be draped"):
        optimize(job, cases_of(["vertex:-1"], [0.0]))


@pytest.fixture
def command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Result]:
    """Optimize a small saddle on the command line."""
    monkeypatch.chdir(tmp_path)
    CliRunner().invoke(cli, ["sample", "saddle", "--facets", "1500"], catch_exceptions=False)
    asked = ["optimize", "saddle.stl", "--pitch", "15", "--origins", "grid:2x2", "--angles", "0,40", "-j", "1"]
    return lambda *more: CliRunner().invoke(cli, [*asked, *map(str, more)], catch_exceptions=False)


def test_the_command_writes_what_it_found(command: Callable[..., Result], tmp_path: Path) -> None:
    result = command("--budget", 60, "--json")
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    assert document["schema"] == "geomdrap.optimize/1"
    assert document["best"]["score"] <= document["sweep"]["score"]
    assert document["drapes"] <= 8 + 60
    best = json.loads((tmp_path / "optimize" / "best" / "drape.json").read_text())
    assert best["shear"]["max"] == document["best"]["max_shear"]
    assert best["origin"] == document["best"]["origin"]
    assert sorted(path.name for path in (tmp_path / "optimize").iterdir()) == [
        "best", "optimize.csv", "optimize.json", "optimize.png", "rows.jsonl",
    ]  # fmt: skip


def test_resume_gives_the_same_optimum_without_draping_again(command: Callable[..., Result], tmp_path: Path) -> None:
    first = json.loads(command("--budget", 60, "--json", "--outputs", "json").stdout)
    rows = tmp_path / "optimize" / "rows.jsonl"
    kept = rows.read_text().splitlines(keepends=True)
    rows.write_text("".join(kept[:20]))  # as if interrupted
    again = json.loads(command("--budget", 60, "--json", "--outputs", "json", "--resume").stdout)
    assert again == first
    assert sorted(rows.read_text().splitlines()) == sorted("".join(kept).splitlines())


def test_a_budget_that_ended_the_search_is_said(command: Callable[..., Result]) -> None:
    assert "a larger --budget may find a better drape" in command("--budget", 10, "--outputs", "none").stdout
