"""The picture of a sweep shows what its rows say."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from made_parts import bumpy_sheet

from geomdrap.export import sweep_picture
from geomdrap.sweep import Case, Job, Sweep, cases_of, run
from geomdrap.sweep.ranking import best_of_origins

POINTS = [(-20.0, -20.0, 0.0), (20.0, -20.0, 0.0), (20.0, 25.0, 0.0)]


def _sweep(origins: list[tuple[float, float, float]], angles: list[float], *more: Case) -> Sweep:
    return run(Job(bumpy_sheet(), pitch=8.0), [*cases_of(origins, angles), *more], "max-shear")


def test_a_line_per_origin_runs_through_its_rows_and_the_best_is_bold() -> None:
    sweep = _sweep(POINTS, [0.0, 40.0, 80.0])
    axes = sweep_picture.draw(sweep).axes[0]
    lines = [line for line in axes.lines if len(line.get_xdata()) == 3]
    assert len(lines) == 3
    for line, point in zip(lines, POINTS, strict=True):
        rows = [row for row in sweep.rows if row.asked == point]
        assert list(line.get_xdata()) == [0.0, 40.0, 80.0]
        assert list(line.get_ydata()) == pytest.approx([row.max_shear for row in rows])
        assert (line.get_linewidth() > 1.5) == (point == sweep.best.asked)
    assert axes.get_title(loc="left").startswith("largest shear [°]")


def test_the_map_shows_the_best_score_of_every_origin_where_it_lies() -> None:
    sweep = _sweep(POINTS, [0.0, 40.0])
    figure = sweep_picture.draw(sweep)
    points = next(a for a in figure.axes if a.collections and "Origins" in a.get_title(loc="left")).collections[0]
    best = best_of_origins(sweep.ranked)
    assert list(points.get_array()) == [row.max_shear for row in best]
    at, real = np.array(points.get_offsets()), np.array([row.origin for row in best])
    # the part is seen from above, so that plane distances keep their ratios, and y is down in the picture
    away, truly = at - at[0], (real - real[0])[:, :2]
    assert away[1:, 0] / truly[1:, 0] == pytest.approx(-away[1:, 1] / truly[1:, 1], rel=0.1)


@pytest.mark.parametrize(("origins", "angles"), [(POINTS[:1], [0.0, 40.0]), (POINTS, [0.0]), (POINTS[:1], [0.0])])
def test_there_are_diagrams_where_headings_differ_and_a_map_where_origins_do(
    tmp_path: Path, origins: list[tuple[float, float, float]], angles: list[float]
) -> None:
    sweep = _sweep(origins, angles)
    figure = sweep_picture.draw(sweep)
    diagrams = [
        axes for axes in figure.axes if "°" in axes.get_title(loc="left") or "m²" in axes.get_title(loc="left")
    ]
    maps = [axes for axes in figure.axes if "Origins" in axes.get_title(loc="left")]
    assert bool(diagrams) == (len(angles) > 1)
    assert bool(maps) == (len(origins) > 1 or len(angles) == 1)
    sweep_picture.write(sweep, tmp_path / "a.png")
    sweep_picture.write(sweep, tmp_path / "b.png")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_failed_cases_are_named_and_do_not_spoil_the_picture() -> None:
    sweep = _sweep(POINTS, [0.0, 40.0], Case("vertex:-1", 0.0))
    words = " ".join(text.get_text() for text in sweep_picture.draw(sweep).texts)
    assert "7 cases, 1 failed, ranked by max-shear" in words
