"""A drape by a commercial tool (Composites Modeler, geodesic axes) of a blade-like mould, node by node."""

import gzip
from pathlib import Path

import numpy as np
import pytest

import geomdrap as gd

FOLDER = Path(__file__).parents[1] / "data" / "cma"
PITCH = 12.5
START = 5  # the seed: nodes into the warp course, since its first node lies on the mould's edge


@pytest.fixture(scope="module")
def reference():
    """Warp and weft number (n,), points (n, 3) mm, shear (n,) degrees and thickness (n,) mm."""
    text = gzip.decompress((FOLDER / "GeoCourse.vfp.gz").read_bytes()).decode()
    rows = [r.split() for r in text.split("*PLY")[1].splitlines() if r and not r.startswith("*")]
    table = np.array([r[:10] for r in rows], dtype=float)
    warp, weft = table[:, :2].T.astype(int)
    return warp, weft, 1e3 * table[:, 2:5], np.degrees(table[:, 8]), 1e3 * table[:, 9]


@pytest.fixture(scope="module")
def net(reference, tmp_path_factory):
    warp, weft, points, _, _ = reference
    part = tmp_path_factory.mktemp("cma") / "blade_like.stl"
    part.write_bytes(gzip.decompress((FOLDER / "blade_like.stl.gz").read_bytes()))
    surface = gd.read_surface(part, unit="m")
    seed, onward = (points[(warp == n) & (weft == 0)][0] for n in (START, START + 1))
    return gd.drape(surface, seed, 0.0, PITCH, reference=onward - seed)


def matched(net, reference):
    """Where the tool's nodes are in our net: its weft runs toward -x, which is our -v."""
    warp, weft, *_ = reference
    i = np.rint(warp - START - net.u[0] / PITCH).astype(int)
    j = np.rint(-weft - net.v[0] / PITCH).astype(int)
    within = (i >= 0) & (i < len(net.u)) & (j >= 0) & (j < len(net.v))
    found = within.copy()
    found[within] = np.isfinite(net.points[i[within], j[within], 0])
    return found, i[found], j[found]


def test_nearly_every_node_of_the_tool_is_found(net, reference):
    found, _, _ = matched(net, reference)
    assert len(found) == 13_070
    assert found.mean() >= 0.98


def test_nodes_lie_where_the_tool_puts_them(net, reference):
    found, i, j = matched(net, reference)
    miss = np.linalg.norm(net.points[i, j] - reference[2][found], axis=1)
    assert np.percentile(miss, 95) <= 0.3
    assert miss.max() <= 0.6


def test_shear_is_what_the_tool_says(net, reference):
    found, i, j = matched(net, reference)
    miss = -net.shear[i, j] - reference[3][found]  # our v runs against its weft
    assert np.isfinite(miss).mean() > 0.99
    assert np.sqrt(np.nanmean(miss**2)) <= 0.2


def test_thickness_follows_from_the_shear_as_in_the_tool(net, reference):
    found, i, j = matched(net, reference)
    shear, thickness = reference[3], reference[4]
    nominal = (thickness * np.cos(np.radians(shear)))[found]
    np.testing.assert_allclose(nominal, np.median(nominal), rtol=1e-4)
    ours = np.median(nominal) / np.cos(np.radians(net.shear[i, j]))
    miss = ours / thickness[found] - 1.0
    assert np.nanpercentile(abs(miss), 95) < 1e-3
    assert np.nanmax(abs(miss)) < 5e-3
