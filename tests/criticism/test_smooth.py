"""The smooth tool that facets stand for, against spheres, cylinders and parts with edges."""

from __future__ import annotations

import numpy as np
import pytest
from made_parts import cube

import geomdrap as gd
from geomdrap.criticism import smooth
from geomdrap.criticism.layup import Layup
from geomdrap.criticism.prepare import prepare
from geomdrap.criticism.smooth import smoothed


def off_sphere(surface, radius):
    """How far the middles of the facets lie inside a sphere about the origin, mm."""
    return radius - np.linalg.norm(surface.points[surface.triangles].mean(axis=1), axis=1)


def cap(n=24, radius=60.0, half=40.0):
    """The top of a sphere over a square, on a grid of n × n."""
    line = np.linspace(-half, half, n)
    x, y = np.meshgrid(line, line, indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), np.sqrt(radius**2 - x**2 - y**2).ravel()])
    number = np.arange(n * n).reshape(n, n)
    a, b, c, d = (m.ravel() for m in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    return gd.Surface(points, np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])]))


def test_the_gap_between_facets_and_sphere_falls_to_about_a_quarter():
    before, after = off_sphere(cap(), 60.0), off_sphere(smoothed(cap()), 60.0)
    assert len(after) == 4 * len(before)
    assert np.median(after) < 0.35 * np.median(before)
    # beside the rim normals lean, as facets are missing on one side: there it falls by less, but falls
    assert after.max() < 0.8 * before.max()
    assert after.min() > -0.02 * before.max()


def test_corners_stay_where_they_are():
    part = cap()
    fine = smoothed(part)
    places = {tuple(p) for p in np.round(fine.points, 9)}
    assert {tuple(p) for p in np.round(part.points, 9)} <= places


def test_flats_stay_flat_up_to_their_edges():
    box = cube()
    assert smoothed(box) is box


@pytest.mark.parametrize(("half", "same"), [(5.0, True), (6.5, False)])
def test_a_curved_part_whose_facets_lie_within_a_micron_of_it_is_left_alone(half, same):
    # a chord c of the sphere lies c²/8R below it: 0.0008 mm for the longest of the first part, 0.0013 of the second
    fine = cap(half=half)
    assert (smoothed(fine) is fine) == same


@pytest.mark.parametrize(("most", "same"), [(4, False), (3, True)])
def test_a_part_that_would_have_too_many_facets_is_left_as_it_is(monkeypatch, most, same):
    part = cap()
    monkeypatch.setattr(smooth, "MOST_FACETS", most * len(part.triangles))
    assert (smoothed(part) is part) == same


@pytest.mark.parametrize(("most", "said"), [(4, False), (3, True)])
def test_a_part_that_is_not_smoothed_for_its_many_facets_is_named_in_a_note(monkeypatch, most, said):
    part = cap()
    monkeypatch.setattr(smooth, "MOST_FACETS", most * len(part.triangles))
    net = gd.drape(part, (0.0, 0.0, 60.0), 0.0, 5.0)
    points = net.points[np.isfinite(net.points).all(axis=-1)]
    notes = prepare(part, gd.Measurement("made", points), Layup((0.0, 0.0, 60.0), 0.0), sigma_xyz=0.1)[1]
    assert any(f"on the {len(part.triangles)} facets of the part itself" in note for note in notes) == said


def test_the_smooth_part_looks_the_same_way():
    part = cap()
    assert smoothed(part).normals[:, 2].min() > 0.0
    assert smoothed(part.flipped()).normals[:, 2].max() < 0.0


@pytest.mark.parametrize("heading", [0.0, 30.0])
def test_a_net_on_few_facets_comes_nearer_to_that_on_many(heading):
    seed = (3.1, -2.3, 60.0)
    parts = (cap(), smoothed(cap()), cap(160))
    nets = [gd.drape(part, seed, heading, 5.0, reach=(25.0, 25.0), project=True) for part in parts]
    u, v = (a.ravel() for a in np.meshgrid([-20.0, -10.0, 10.0, 20.0], [-20.0, 10.0, 20.0], indexing="ij"))
    places = [net.interpolate(u, v)[0] for net in nets]
    before, after = (np.sqrt(np.mean((p - places[2]) ** 2)) for p in places[:2])
    assert after < 0.5 * before


def test_the_same_facets_with_their_vertices_elsewhere_are_not_split_anew():
    part, splits = cap(), []
    smoothed(part, splits)
    moved = part.moved(part.points * 1.1)
    again = smoothed(moved, splits)
    assert len(splits) == 1
    np.testing.assert_array_equal(again.points, smoothed(moved).points)
    np.testing.assert_array_equal(again.triangles, smoothed(moved).triangles)
    assert smoothed(cap(n=20), splits).triangles.shape == (4 * 2 * 19 * 19, 3)  # other facets are
    assert len(splits) == 2


def test_a_cut_stays_open():
    """Beside a cut, vertices lie twice at one place; a surface made of them would weld them."""
    cut = cap().cut([(-20.0, 0.0, 56.0), (20.0, 0.0, 56.0)])
    assert smoothed(cut) is cut
    assert "cut" in smooth.note_on(cut)[0]


def test_a_hint_on_the_unit_is_kept():
    assert smoothed(cap().doubted("in inches?")).findings.unit_hint == "in inches?"


@pytest.mark.parametrize("effects", [(), ("bridging",)], ids=["smoothed", "split for bridging"])
def test_a_vertex_of_the_input_is_the_same_one_on_the_smooth_tool(effects):
    part = cap(n=16).flipped()  # a bowl, whose facets are too large for a ball of 55 mm and less
    doubled = np.vstack([part.points[::-1], part.points])  # numbers of the input are not those of the vertices
    n = len(part.points)
    bowl = gd.Surface(doubled, part.triangles + n)
    meant = bowl.points[bowl.vertex_of_input[n + 100]]
    layup = Layup(f"vertex:{n + 100}", 0.0)
    net = gd.drape(bowl, "centroid", 0.0, 4.0)
    marks = gd.Measurement("made", net.points[::4, ::4][np.isfinite(net.points[::4, ::4, 0])])
    experiment = prepare(bowl, marks, layup, sigma_xyz=0.1)[0]
    acting = [gd.effects.make(name, radius=5.0) for name in effects]
    assert np.linalg.norm(experiment.draped(acting, 4.0).origin - meant) < 0.5
