"""Changes of a measurement that change nothing, or what they should and nothing else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from analytic_tools import measured

import geomdrap as gd
from geomdrap.criticism.compare_regions import unmeasured, worst_regions
from geomdrap.export.compare_json import as_dict


@pytest.fixture(scope="module")
def case():
    surface, m, laid = measured("steering")
    points = m.points.copy()
    points[100] += [4.0, 0.0, 0.0]  # an outlier, so that there is one to find
    return surface, replace(m, points=points), {**laid, "pitch": 8.0}


@pytest.fixture(scope="module")
def reference(case):
    surface, m, laid = case
    return gd.compare(surface, m, **laid)


def _numbers(c, *, places=True):
    """What does not depend on the frame, in a list of named numbers."""
    scores = c.scores
    out = {"position": scores.position.rms, "shear": scores.shear.rms, "chi2": scores.chi2_per_dof}
    out |= {f"moran {k}": getattr(c.structure, k).moran for k in ("position", "shear")}
    out |= {f"{t.kind} {t.against} {what}": getattr(t, what) for t in c.trends for what in ("rho", "p")}
    out |= {f"{t.kind} {t.against} {k}": x for t in c.trends for k, x in enumerate(t.rms)}
    out |= {
        f"region {k} {what}": getattr(r, what) for k, r in enumerate(worst_regions(c)) for what in ("size", "u", "v")
    }
    return out | {"gaps": unmeasured(c)[0], "outliers": float(len(c.outliers))}


def _same(first, second, rel):
    a, b = _numbers(first), _numbers(second)
    assert a.keys() == b.keys()
    for name, value in a.items():
        assert b[name] == pytest.approx(value, rel=rel, abs=rel), name


def test_the_order_of_the_rows_does_not_matter(case, reference):
    surface, m, laid = case
    order = np.random.default_rng(0).permutation(len(m))
    c = gd.compare(surface, m.take(order), **laid)
    _same(reference, c, 1e-9)
    np.testing.assert_allclose(c.vector, reference.vector[order], atol=1e-12)
    assert [o.line for o in c.outliers] == [o.line for o in reference.outliers]
    first, second = as_dict(reference), as_dict(c)
    assert sorted(map(str, first["unmatched_points"])) == sorted(map(str, second["unmatched_points"]))


def test_part_and_measurement_moved_together_give_the_same(case, reference):
    surface, m, laid = case
    turn, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    shift = np.array([300.0, -200.0, 150.0])
    moved = gd.Surface(surface.points @ turn.T + shift, surface.triangles)
    c = gd.compare(
        moved,
        replace(m, points=m.points @ turn.T + shift),
        **{**laid, "origin": turn @ np.array(laid["origin"]) + shift},
        reference=turn @ np.array([1.0, 0.0, 0.0]),
    )
    _same(reference, c, 1e-4)  # places of equal curvature but for rounding change their ranks
    np.testing.assert_allclose(c.parts, reference.parts, atol=1e-5)


def test_the_numbering_of_the_mesh_does_not_matter(case, reference):
    surface, m, laid = case
    rng = np.random.default_rng(2)
    number = rng.permutation(len(surface.points))
    points = np.empty_like(surface.points)
    points[number] = surface.points
    faces = number[surface.triangles][rng.permutation(len(surface.triangles))]
    _same(reference, gd.compare(gd.Surface(points, faces), m, **laid), 1e-5)


def test_twice_the_noise_is_a_quarter_of_chi2(case, reference):
    surface, m, laid = case
    clean = m.take(np.delete(np.arange(len(m)), 100))
    first = gd.compare(surface, clean, **laid)
    doubled = {**laid, "sigma_xyz": 2 * laid["sigma_xyz"], "sigma_shear": 2 * laid["sigma_shear"]}
    second = gd.compare(surface, clean, **doubled)
    assert second.scores.chi2_per_dof == pytest.approx(first.scores.chi2_per_dof / 4, rel=1e-12)
    assert second.scores.position.rms == first.scores.position.rms
    assert second.scores.position.noise == pytest.approx(2 * first.scores.position.noise)


def test_inches_with_their_unit_are_millimetres(case, reference, tmp_path):
    surface, m, laid = case
    table = np.column_stack([m.u / 25.4, m.v / 25.4, m.points / 25.4, m.shear])
    path = tmp_path / "inches.csv"
    np.savetxt(path, table, delimiter=",", header="u,v,x,y,z,shear", comments="", fmt="%.12f")
    _same(reference, gd.compare(surface, gd.read_measurement(path, unit="in"), **laid), 1e-6)


def test_a_column_of_the_noise_is_the_noise_given(case, reference):
    surface, m, laid = case
    n = len(m)
    columns = replace(m, sigma_xyz=np.full(n, laid["sigma_xyz"]), sigma_shear=np.full(n, laid["sigma_shear"]))
    c = gd.compare(surface, columns, origin=laid["origin"], angle=laid["angle"], pitch=8.0)
    _same(reference, c, 1e-12)


def test_directions_may_point_either_way(case, reference):
    surface, m, laid = case
    warp, _ = reference.net.directions(m.u, m.v)
    signs = np.random.default_rng(3).choice([-1.0, 1.0], len(m))[:, None]
    c = gd.compare(surface, replace(m, warp=signs * warp), **laid)
    np.testing.assert_allclose(c.warp_turn[c.used], 0.0, atol=1e-6)


def test_a_turn_of_the_fabric_names_takes_warp_to_weft(case, reference):
    """The same ply with warp and weft exchanged: heading 90° on, u → v, v → -u, shear turned in sign."""
    surface, m, laid = case
    c = gd.compare(surface, replace(m, u=m.v, v=-m.u, shear=-m.shear), **{**laid, "angle": laid["angle"] + 90.0})
    used = c.used & reference.used
    assert used.sum() >= reference.used.sum() - 3
    np.testing.assert_allclose(c.parts[used, 0], reference.parts[used, 1], atol=1e-3)
    np.testing.assert_allclose(c.parts[used, 1], -reference.parts[used, 0], atol=1e-3)
    np.testing.assert_allclose(c.shear[used], -reference.shear[used], atol=0.02)
