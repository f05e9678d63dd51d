"""Checks on every run: side lengths, distance to the part, and Gauss-Bonnet."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fields.result import Checks
from geomdrap.fishnet.laid_down import SPREAD
from geomdrap.geodesic.compiled import kernel
from geomdrap.geodesic.mesh import BEND, mesh_of

if TYPE_CHECKING:
    from geomdrap.fields.trim import Trimmed
    from geomdrap.fishnet import Net


def check_net(net: Net, trimmed: Trimmed) -> Checks:
    """Check a net against the lengths it was made of, the part it lies on and the part's curvature."""
    return Checks(edge_error(net), off_surface(net), curvature_residual(net, trimmed))


def edge_error(net: Net) -> float:
    """Largest amount by which a side of a valid cell, measured straight, is longer than it may be, relative.

    Straight, a side can only be shorter than along the surface, by its bending; longer it must never be.
    """
    if not net.cell_valid.any():
        return 0.0
    long, wide = net.sides or (np.diff(net.u)[:, None], np.diff(net.v)[None, :])
    warp = np.linalg.norm(np.diff(net.points, axis=0), axis=2) / long
    weft = np.linalg.norm(np.diff(net.points, axis=1), axis=2) / wide
    ok = net.cell_valid
    sides = np.concatenate([warp[:, :-1][ok], warp[:, 1:][ok], weft[:-1][ok], weft[1:][ok]])
    return float(max(sides.max() - 1.0, 0.0))


def off_surface(net: Net) -> float:
    """Largest distance of a node from the plane and the outline of its facet, mm."""
    here = net.face >= 0
    faces, points = net.face[here], net.points[here]
    part = net.surface
    corners = part.points[part.triangles[faces]]
    normal = part.normals[faces]
    worst = np.abs(((points - corners[:, 0]) * normal).sum(axis=1))
    for k in range(3):
        a, b = corners[:, k], corners[:, (k + 1) % 3]
        inward = np.cross(normal, b - a)
        inward /= np.linalg.norm(inward, axis=1, keepdims=True)
        worst = np.maximum(worst, -((points - a) * inward).sum(axis=1))
    return float(max(worst.max(initial=0.0), 0.0))


def curvature_residual(net: Net, trimmed: Trimmed) -> float | None:
    """95th percentile of |shear at a node - deficits inside its net rectangle|, degrees.

    Between geodesic generators the shear at (u, v) is the Gaussian curvature inside the rectangle from the seed to
    (u, v), integrated (Gauss-Bonnet). On a mesh that is the angle deficits of its vertices, where the net's lines
    have them: at the vertex, or spread along its edges. Counted are the nodes inside the net whose rectangle is
    whole; None where there are none.
    """
    i0, j0 = (int(np.argmin(np.abs(x))) for x in (net.u, net.v))
    if net.u[i0] != 0.0 or net.v[j0] != 0.0 or min(net.lattice_valid.shape) < 2 or not net.is_geodesic:
        return None
    total = _from_seed(_deficit_per_cell(net, trimmed), i0, j0)
    valid = net.cell_valid
    whole = np.zeros(net.status.shape, bool)
    whole[1:-1, 1:-1] = valid[:-1, :-1] & valid[1:, :-1] & valid[:-1, 1:] & valid[1:, 1:]
    whole &= _from_seed((~net.lattice_valid).astype(float), i0, j0) == 0.0
    if not whole.any():
        return None
    sign = np.sign(net.u)[:, None] * np.sign(net.v)[None, :]
    return float(np.percentile(np.abs(net.shear - np.degrees(total) * sign)[whole], 95))


ON_LINE = 0.02  # cells: curvature this close to a yarn counts half on either side of it
PER_EDGE = 4  # points that stand for the curvature along an edge


def _deficit_per_cell(net: Net, trimmed: Trimmed) -> np.ndarray:
    """Angle deficits (radians) in the cells (nu - 1, nv - 1) of the net."""
    part = net.surface
    at = np.full((len(part.points), 2), np.nan)
    corners = trimmed.mesh.triangles
    own = (corners < len(at)) & (trimmed.kind > 0)[:, None]
    at[corners[own]] = (trimmed.at[own] - [net.u[0], net.v[0]]) / net.pitch
    whole = part.lidded
    bend = mesh_of(whole, SPREAD * net.pitch).row[:, BEND:].reshape(-1, 3, 2)
    cells = np.zeros(net.lattice_valid.shape)
    deposit(cells, at, whole.triangles, bend, whole.deficits.copy())
    return cells


@kernel
def deposit(cells: np.ndarray, at: np.ndarray, triangles: np.ndarray, bend: np.ndarray, deficit: np.ndarray) -> None:
    """Add deficits to the cells that hold them: what ``bend`` spreads along edges there, the rest at the vertices.

    ``at`` (n, 2) are the vertices' coordinates in cells, NaN where unknown. An edge stands in two facets, half each.
    """
    for f in range(len(triangles)):
        for k in range(3):
            both = bend[f, k, 1]
            if both == 0.0 and bend[f, k, 0] == 0.0:
                continue
            a, b = triangles[f, k], triangles[f, (k + 1) % 3]
            deficit[a] -= 0.5 * bend[f, k, 0]
            deficit[b] -= 0.5 * (both - bend[f, k, 0])
            for n in range(PER_EDGE):
                t = (n + 0.5) / PER_EDGE
                p, q = (1.0 - t) * at[a, 0] + t * at[b, 0], (1.0 - t) * at[a, 1] + t * at[b, 1]
                add_around(cells, p, q, 0.5 * both / PER_EDGE)
    for v in range(len(at)):
        add_around(cells, at[v, 0], at[v, 1], deficit[v])


@kernel
def add_around(cells: np.ndarray, p: float, q: float, mass: float) -> None:
    """Add a mass to the cell of (p, q), shared with the next one where it lies on the yarn between them."""
    if math.isnan(p) or math.isnan(q):
        return
    for a in (-ON_LINE, ON_LINE):
        for b in (-ON_LINE, ON_LINE):
            i, j = int(math.floor(p + a)), int(math.floor(q + b))
            if 0 <= i < cells.shape[0] and 0 <= j < cells.shape[1]:
                cells[i, j] += 0.25 * mass


def _from_seed(cells: np.ndarray, i0: int, j0: int) -> np.ndarray:
    """Sum of the cells in the rectangle between the seed's node and each node (nu, nv)."""
    total = np.zeros((cells.shape[0] + 1, cells.shape[1] + 1))
    total[1:, 1:] = cells.cumsum(axis=0).cumsum(axis=1)
    i, j = np.indices(total.shape)
    signed = total - total[i0][None, :] - total[:, j0][:, None] + total[i0, j0]
    return signed * np.sign(i - i0) * np.sign(j - j0)
