"""The analytic tools on which the measurements in data/measured were made, as fine meshes."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from made_parts import sheet

import geomdrap as gd

DATA = Path(__file__).parent / "data" / "measured"


def _sheet(height, half, step):
    line = np.arange(-half, half + 0.5 * step, step)
    x, y = np.meshgrid(line, line, indexing="ij")
    return sheet(np.stack([x, y, height(x, y)], axis=-1))


@cache
def bump():
    """z = 85 exp(-(r / 85)²) on a square of 320 mm; whole millimetres in pairs are vertices."""
    return _sheet(lambda x, y: 85.0 * np.exp(-(x**2 + y**2) / 85.0**2), 160.0, 2.0)


@cache
def saddle():
    """z = (x² - y²) / 320 on a square of 280 mm."""
    return _sheet(lambda x, y: (x**2 - y**2) / 320.0, 140.0, 2.0)


SURFACES = {"none": bump, "steering": bump, "weave-skew": saddle, "springback": saddle}


def measured(name):
    """Surface, measurement and the keywords of its set-up."""
    setup = gd.read_setup(DATA / name / "setup.toml")
    laid = {key: getattr(setup, key) for key in ("origin", "angle", "sigma_xyz", "sigma_shear")}
    return SURFACES[name](), gd.read_measurement(DATA / name / "measured.csv"), laid
