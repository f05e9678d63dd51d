"""A vertex that lies far away is found before the part is cut into pieces without end."""

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.errors import DrapeError
from geomdrap.fields.pieces import require_few_pieces
from geomdrap.fields.refine import refine
from geomdrap.surface import Surface, shapes

PLANE = shapes.plane(200.0, 200.0, 10.0)


def with_one_vertex_at(far, vertex=220):
    points = PLANE.points.copy()
    points[vertex] = far * np.array([1.0, 0.3, 0.1])
    return Surface(points, PLANE.triangles)


@pytest.mark.parametrize("far", [3e6, 1e7])
def test_a_part_with_one_vertex_far_away_is_refused_with_its_place(far):
    net = gd.drape(with_one_vertex_at(far), (33.0, 44.0, 0.0), 10.0, 5.0, (20.0, 20.0))
    with pytest.raises(DrapeError, match=r"pieces.*larger pitch.*facet"):
        gd.evaluate(net)


@pytest.mark.parametrize(("far", "longest"), [(1e3, 10.0), (3e3, 7.0)])
def test_the_count_of_pieces_is_foretold_within_a_factor_of_three(far, longest, monkeypatch):
    part = with_one_vertex_at(far)
    real = len(refine(part.points, part.triangles, part.neighbours, part.neighbour_edge, longest).triangles)
    for most, refused in ((3 * real, False), (real // 3, True)):
        monkeypatch.setattr("geomdrap.fields.pieces.MOST_PIECES", most)
        if refused:
            with pytest.raises(DrapeError):
                require_few_pieces(part, longest)
        else:
            require_few_pieces(part, longest)
