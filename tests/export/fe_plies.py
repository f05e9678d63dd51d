"""Plies whose every number is known, and the files that go in and come out."""

from __future__ import annotations

import numpy as np

from geomdrap.export.fe_read import read_fe_mesh

RADIUS, HEADING = 100.0, 25.0
WARP = np.array([np.cos(np.radians(HEADING)), np.sin(np.radians(HEADING)), 0.0])


def dome(x, y):
    """Height of the cap's sphere."""
    return np.sqrt(RADIUS**2 - x**2 - y**2)


def written(tmp_path, name, text):
    path = tmp_path / name
    path.write_text(text)
    return read_fe_mesh(path)


def out(module, ply, tmp_path, thickness=None):
    module.write(ply, tmp_path / "out", thickness)
    return (tmp_path / "out").read_text()
