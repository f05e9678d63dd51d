"""Gauss-Bonnet: the shear at a node is the curvature inside the net rectangle between it and the seed."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

import geomdrap as gd
from geomdrap.surface import samples, shapes

STRONG = 60.0  # degrees; beyond, nodes next to each other across the yarns are less than a pitch apart
SPLIT = 4  # sub-cells and sub-facets a side: how finely curvature is counted into cells


def vertex_deficits(surface):
    """Angle deficit (n,) in degrees, NaN on the rim where it is not known, and the faces' angles (m, 3) in degrees."""
    corners = surface.points[surface.triangles]
    angles = np.empty(surface.triangles.shape)
    rim = np.zeros(len(surface.points), bool)
    for k in range(3):
        a, b, c = (corners[:, (k + n) % 3] for n in range(3))
        cosine = ((b - a) * (c - a)).sum(1) / np.linalg.norm(b - a, axis=1) / np.linalg.norm(c - a, axis=1)
        angles[:, k] = np.degrees(np.arccos(cosine))
        open_edge = surface.neighbours[:, k] < 0
        rim[surface.triangles[open_edge, k]] = rim[surface.triangles[open_edge, (k + 1) % 3]] = True
    total = np.bincount(surface.triangles.ravel(), angles.ravel(), len(surface.points))
    return np.where(rim, np.nan, 360.0 - total), angles, total


def curvature_samples(surface):
    """Points (k, 3) spread over the faces and the curvature (k,) in degrees that each stands for.

    A vertex's deficit goes to its faces by their angles, since the mesh stands for a smooth surface.
    """
    deficit, angles, total = vertex_deficits(surface)
    of_face = (deficit[surface.triangles] * angles / total[surface.triangles]).sum(axis=1)
    n = 3 * SPLIT
    weights = np.array([(a, b, n - a - b) for a in range(n) for b in range(n - a) if a % 3 == b % 3 == 1]) / n
    points = np.einsum("kc,mcd->mkd", weights, surface.points[surface.triangles]).reshape(-1, 3)
    return points, np.repeat(of_face / len(weights), len(weights))


def curvature_in_cells(net, surface):
    """Curvature (nu - 1, nv - 1) in degrees inside each cell, found by the nearest point of the finer net."""
    share = (np.arange(SPLIT) + 0.5) / SPLIT
    s, t = np.meshgrid(share, share, indexing="ij")
    p = net.points
    fine = sum(
        w[..., None] * q[:, :, None, None, :]
        for w, q in (
            ((1 - s) * (1 - t), p[:-1, :-1]),
            (s * (1 - t), p[1:, :-1]),
            (s * t, p[1:, 1:]),
            ((1 - s) * t, p[:-1, 1:]),
        )
    )
    i, j = np.nonzero(net.cell_valid)
    tree = cKDTree(fine[i, j].reshape(-1, 3))
    points, curvature = curvature_samples(surface)
    away, at = tree.query(points, distance_upper_bound=net.pitch)
    near = np.isfinite(away)
    cell = at[near] // SPLIT**2
    out = np.zeros(net.cell_valid.shape)
    np.add.at(out, (i[cell], j[cell]), curvature[near])
    return out


def sums_from_seed(net, cells):
    """Sum (nu, nv) over the rectangle between the seed and each node, signed by its quadrant; NaN where open."""
    i0, j0 = int(np.argmin(abs(net.u))), int(np.argmin(abs(net.v)))
    whole = np.where(net.cell_valid, cells, np.nan)
    out = np.zeros((len(net.u), len(net.v)))
    for su, sv in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        part = whole[i0:, :] if su > 0 else whole[:i0, :][::-1, :]
        part = part[:, j0:] if sv > 0 else part[:, :j0][:, ::-1]
        total = np.cumsum(np.cumsum(part, axis=0), axis=1)
        i, j = i0 + su * (1 + np.arange(total.shape[0])), j0 + sv * (1 + np.arange(total.shape[1]))
        out[np.ix_(i, j)] = su * sv * total
    return out


def residual(surface, pitch, angle, seed="centroid", reach=None):
    """Difference (k,) in degrees at the nodes with four cells whose rectangle to the seed is whole."""
    net = gd.drape(surface, seed, angle, pitch, reach, project=True)
    expected = sums_from_seed(net, curvature_in_cells(net, net.surface))
    v = net.cell_valid
    inner = np.zeros(expected.shape, bool)
    inner[1:-1, 1:-1] = v[:-1, :-1] & v[1:, :-1] & v[1:, 1:] & v[:-1, 1:]
    known = inner & np.isfinite(expected) & (abs(net.shear) < STRONG)
    return (net.shear - expected)[known], np.nanmax(abs(net.shear[known]))


SMOOTH = {
    "sphere": (lambda: shapes.sphere_cap(100.0, 70.0, 1.5), 1.5, (70.0, 70.0)),
    "saddle": (lambda: shapes.saddle(150.0, 200.0, 1.5), 2.0, None),
    "ruled saddle": (lambda: shapes.saddle(150.0, 200.0, 1.5, ruled=True), 2.0, None),
    "torus": (lambda: shapes.torus(120.0, 50.0, 1.5, angle=120.0), 2.0, None),
    "crown": (lambda: shapes.l_shape(300.0, 150.0, 200.0, 2.0), 2.0, None),
}


@pytest.mark.parametrize("part", SMOOTH)
@pytest.mark.parametrize("angle", [12.0, 50.0])
def test_shear_is_the_curvature_between_a_node_and_the_seed(part, angle):
    make, pitch, reach = SMOOTH[part]
    miss, most = residual(make(), pitch, angle, reach=reach)
    assert len(miss) > 500
    assert most > 5.0
    assert np.sqrt(np.mean(miss**2)) < 0.05
    assert abs(miss).max() < 0.1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "edge", "pitch"), [("hemisphere", 1.0, 1.0), ("saddle", 1.5, 1.5), ("hood", 4.0, 4.0)]
)
def test_shear_is_the_curvature_on_the_samples_we_ship(name, edge, pitch):
    miss, most = residual(samples.build(name, edge=edge), pitch, 20.0)
    assert len(miss) > 5000
    assert most > 5.0
    assert np.percentile(abs(miss), 99) < 0.1
