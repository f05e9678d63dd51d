"""A small finished drape with round numbers, for tests of the exporters: a square of 40 mm, one corner bare.

The net has pitch 10 on a plane; fields are made up, so that each of them can be told from the others.
"""

from __future__ import annotations

from types import SimpleNamespace as Record

import numpy as np

from geomdrap.fishnet import Status
from geomdrap.surface import Surface


def square(half: float = 20.0) -> Surface:
    """Two triangles."""
    points = [[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0]]
    return Surface(points, [[0, 1, 2], [0, 2, 3]], source="square.stl")


def square_ply(cells: int = 4, pitch: float = 10.0, facets: Surface | None = None) -> Record:
    """A result like `geomdrap.fields.Drape` whose last node (top right) lies off the part."""
    surface = facets or square()
    line = pitch * (np.arange(cells + 1) - cells // 2)
    x, y = np.meshgrid(line, line, indexing="ij")
    points = np.stack([x, y, np.zeros_like(x)], axis=2)
    status = np.full(x.shape, Status.PRESENT, np.uint8)
    shear = x / 10.0
    cell_shear = (shear[:-1, :-1] + shear[1:, 1:]) / 2
    points[-1, -1], shear[-1, -1], status[-1, -1], cell_shear[-1, -1] = (
        np.nan,
        np.nan,
        Status.OFF_PART,
        np.nan,
    )
    net = Record(
        surface=surface,
        origin=np.zeros(3),
        normal0=np.array([0.0, 0.0, 1.0]),
        angle=30.0,
        pitch=pitch,
        effects=(),
        u=line,
        v=line,
        points=points,
        shear=shear,
        status=status,
        cell_shear=cell_shear,
        cell_valid=~np.isnan(cell_shear),
        warnings=("a warning",),
        notes=("pitch 10 mm was chosen",),
    )
    return _evaluated(net)


def _evaluated(net: Record) -> Record:
    m = len(net.surface.triangles)
    shear = np.linspace(-30.0, 60.0, m)
    shear[-1] = np.nan if m > 2 else shear[-1]
    return Record(
        net=net,
        warnings=net.warnings,
        roll=None,
        limit_angle=50.0,
        face_shear=shear,
        face_warp=np.tile([1.0, 0.0, 0.0], (m, 1)),
        face_weft=np.tile([0.0, 1.0, 0.0], (m, 1)),
        face_thickness=1 / np.cos(np.radians(shear)),
        face_fibre_volume=1 / np.cos(np.radians(shear)),
        face_coverage=np.linspace(0.5, 1.0, m),
        face_reason=np.full(m, Status.PRESENT, np.uint8),
        area=Record(part=1600.0, draped=1550.0, fabric=1550.0000004, coverage=0.96875),
        bare=(Record(area=50.0, center=np.array([18.0, 18.0, -1e-9]), reason="off the part"),),
        statistics=Record(max=2.0, p95=1.9, mean=1.0, over_half_limit=0.25, over_limit=0.0),
        checks=Record(edge_error=2e-13, off_surface=0.0, curvature_residual=None),
    )
