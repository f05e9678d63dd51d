"""Nets whose shear is known exactly, and how far a computed one is from them."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

DATA = Path(__file__).parent / "data"


@cache
def _sphere_table():
    from scipy.interpolate import CubicSpline

    s, shear = np.loadtxt(DATA / "exact" / "sphere_shear.csv", delimiter=",", comments=["#", "s"]).T
    return CubicSpline(s, shear)


def sphere_shear(u, v, radius):
    """Shear (nu, nv) in degrees on a sphere whose generators are great circles through the seed."""
    return sphere_shear_at(np.asarray(u)[:, None], np.asarray(v)[None, :], radius)


def sphere_shear_at(u, v, radius):
    """The same at fabric coordinates u and v of one shape, or shapes that numpy makes one."""
    s = np.asarray(u) * np.asarray(v) / radius**2
    return np.sign(s) * _sphere_table()(np.abs(s))


def middles(nodes):
    """Fabric coordinates of the middles of the cells."""
    return 0.5 * (nodes[1:] + nodes[:-1])


def sphere_errors(net, radius):
    """Root mean square and largest error (degrees) of the shear of the valid cells."""
    miss = net.cell_shear - sphere_shear(middles(net.u), middles(net.v), radius)
    return np.sqrt(np.nanmean(miss**2)), np.nanmax(abs(miss))


def anywhere_on_a_sphere(rng, radius):
    """A seed (3,) and a heading in degrees in general position."""
    way = rng.normal(size=3)
    return radius * way / np.linalg.norm(way), rng.uniform(0.0, 360.0)
