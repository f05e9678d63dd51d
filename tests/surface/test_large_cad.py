"""STEP and IGES files of thousands of faces: in their units, in one piece, to the last facet."""

import numpy as np
import pytest
from cad_files import iges_patches, step_facets

import geomdrap as gd

pytest.importorskip("cascadio")

STEPS = 30
MM = {"mm": 1.0, "m": 1000.0, "in": 25.4}


@pytest.fixture(scope="module")
def dish():
    """A dish of 400 mm x 400 mm: its points (n, 3) mm, and the corners of its quads (k, 4), counter-clockwise."""
    line = np.linspace(-200.0, 200.0, STEPS + 1)
    x, y = np.meshgrid(line, line, indexing="ij")
    points = np.stack([x, y, (x * x + 0.5 * y * y) / 600.0], axis=-1).reshape(-1, 3)
    number = np.arange(len(points)).reshape(x.shape)
    return points, np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], -1).reshape(-1, 4)


def assert_is_the_dish(surface, points, quads):
    halves = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    a, b, c = points[halves].swapaxes(0, 1)
    assert surface.n_components == 1
    assert len(surface.triangles) == 2 * STEPS**2
    assert len(surface.boundary_loops) == 1
    assert len(surface.boundary_loops[0]) == 4 * STEPS
    np.testing.assert_allclose(surface.bounds, [points.min(axis=0), points.max(axis=0)], atol=1e-4)
    assert surface.areas.sum() == pytest.approx(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum(), rel=1e-4)
    result = gd.evaluate(gd.drape(surface, "centroid", 30.0, 20.0))
    assert result.area.coverage == pytest.approx(1.0, abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("unit", ["mm", "m"])
def test_a_step_file_of_1800_faces_is_read_whole(dish, unit, tmp_path):
    points, quads = dish
    halves = [*map(tuple, quads[:, [0, 1, 2]]), *map(tuple, quads[:, [0, 2, 3]])]
    (tmp_path / "dish.step").write_text(step_facets(points / MM[unit], halves, unit))
    assert_is_the_dish(gd.read_surface(tmp_path / "dish.step"), points, quads)


@pytest.mark.slow
@pytest.mark.parametrize("unit", ["mm", "in"])
def test_an_iges_file_of_900_patches_is_read_whole(dish, unit, tmp_path):
    points, quads = dish
    (tmp_path / "dish.igs").write_text(iges_patches(points[quads[:, [0, 1, 3, 2]]] / MM[unit], unit))
    assert_is_the_dish(gd.read_surface(tmp_path / "dish.igs"), points, quads)
