"""Facets split in four."""

from __future__ import annotations

import numpy as np
from made_parts import bumpy_sheet

from geomdrap.surface.quarter import quartered


def test_quarters_cover_their_facet_in_equal_parts_and_look_the_same_way():
    part = bumpy_sheet()
    edges, side, split = quartered(part.triangles, len(part.points))
    points = np.vstack([part.points, part.points[edges].mean(axis=1)])
    a, b, c = points[split].transpose(1, 0, 2)
    areas = np.cross(b - a, c - a).reshape(-1, 4, 3) / 2.0
    np.testing.assert_allclose(areas, np.repeat((part.normals * part.areas[:, None])[:, None] / 4.0, 4, axis=1), atol=1e-9)
    # side k runs from corner k to the next, and both facets beside an edge have the same middle
    ends = np.stack([part.triangles, np.roll(part.triangles, -1, axis=1)], axis=2)
    np.testing.assert_array_equal(edges[side], np.sort(ends, axis=2))
    assert len(np.unique(split)) == len(part.points) + len(edges)
