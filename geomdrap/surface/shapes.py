"""Analytic surfaces for tests, examples and users: each is a formula, and each returns a Surface.

All sizes are in mm, all angles in degrees. Facets are near-equilateral and about ``edge`` long; normals
point up (+z), or outward on parts that close round an axis. The same call gives the same mesh.
"""

from __future__ import annotations

from geomdrap.surface.shape_bracket import bracket
from geomdrap.surface.shape_parts import car_hood, double_dome
from geomdrap.surface.shape_round import (
    cone,
    cylinder,
    hemisphere,
    hemisphere_on_flange,
    icosphere,
    sphere_cap,
    torus,
)
from geomdrap.surface.shape_sheet import extrude, grid_surface, hat_stringer, l_shape, plane, saddle

__all__ = [
    "bracket",
    "car_hood",
    "cone",
    "cylinder",
    "double_dome",
    "extrude",
    "grid_surface",
    "hat_stringer",
    "hemisphere",
    "hemisphere_on_flange",
    "icosphere",
    "l_shape",
    "plane",
    "saddle",
    "sphere_cap",
    "torus",
]
