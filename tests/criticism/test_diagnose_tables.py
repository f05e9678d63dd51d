"""Diagnosis of tables that hold less: shear alone, directions alone, positions alone; and of changes that matter not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.blind import make, unseal
from geomdrap.criticism.before_after import before_and_after
from geomdrap.criticism.layup import Layup
from geomdrap.criticism.prepare import prepare
from geomdrap.criticism.story import placement_sentence, table_rows

CHEAP = ("yarn-extension", "weave-skew", "springback")


def told_of(folder):
    """Part, measurement, and the keywords of the set-up of a blind set."""
    setup = gd.read_setup(folder / "setup.toml")
    told = {name: getattr(setup, name) for name in ("origin", "angle", "sigma_xyz", "sigma_shear")}
    return gd.read_surface(folder / "part.stl"), gd.read_measurement(folder / "measured.csv"), told


def skewed(folder, columns="all"):
    make(3, effect="weave-skew", part="saddle", points=120, scatter=0.0, outliers=0.0, columns=columns, folder=folder)
    return told_of(folder)


def row(diagnosis, name):
    return next(t for t in diagnosis.tried if t.name == name)


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    surface, measurement, told = skewed(tmp_path_factory.mktemp("plain"))
    return surface, measurement, told, gd.diagnose(surface, measurement, **told, effects=CHEAP)


@pytest.mark.parametrize("columns", ["shear", "directions", "positions"])
def test_a_skew_is_found_whatever_was_recorded(tmp_path, plain, columns):
    surface, measurement, told = skewed(tmp_path, columns)
    d = gd.diagnose(surface, measurement, **told, effects=CHEAP)
    assert d.verdict == "weave-skew"
    (part,), (all_,) = row(d, "weave-skew").values, row(plain[3], "weave-skew").values
    assert abs(part.value - all_.value) < 4.0 * np.hypot(part.sigma, all_.sigma)
    assert part.sigma > all_.sigma
    # and what such a table cannot show is said
    assert any("no u, v" in hint for hint in d.hints) == (columns != "positions")
    assert any("no shear" in hint for hint in d.hints) == (columns != "shear")
    if columns != "positions":
        assert all(amount is None or amount > 0.01 for _, amount, _ in row(d, "yarn-extension").visible)
    # an interval wider than all that there can be is none
    tried = [(v, p) for t in d.tried for v, p in zip(t.values, gd.effects.make(t.name).parameters, strict=True)]
    assert all(v.sigma == np.inf or 2.0 * 1.96 * v.sigma < p.high - p.low for v, p in tried)


def test_the_noise_of_directions_may_be_given_or_stand_in_the_table(tmp_path):
    surface, measurement, told = skewed(tmp_path, "directions")
    n = len(measurement)
    told.pop("sigma_shear")
    first = gd.diagnose(surface, measurement, **told, sigma_direction=0.5, effects=CHEAP)
    column = replace(measurement, sigma_direction=np.full(n, 0.5))
    second = gd.diagnose(surface, column, **told, effects=CHEAP)
    third = gd.diagnose(surface, measurement, **told, sigma_direction=1.0, effects=CHEAP)
    a, b, c = (row(d, "weave-skew").values[0] for d in (first, second, third))
    assert (a.value, a.sigma) == pytest.approx((b.value, b.sigma), rel=1e-9)
    assert c.sigma > 1.5 * a.sigma
    # the pictures of a diagnosis and its words on what is left stand on the same noise
    for d, told in ((first, 0.5), (third, 1.0)):
        for comparison in before_and_after(d):
            for noise in (comparison.noise_warp, comparison.noise_weft):
                assert (noise.source, noise.typical) == ("given", pytest.approx(told))


def test_compare_and_diagnose_take_the_same_noise_of_directions(tmp_path):
    surface, measurement, told = skewed(tmp_path, "directions")
    compared = gd.compare(surface, measurement, **told)
    layup = Layup(told["origin"], told["angle"])
    experiment, notes = prepare(surface, measurement, layup, told["sigma_xyz"], told["sigma_shear"])
    channel = np.array(experiment.channels)[experiment.channel_of()]
    # the nets have other pitches, and with them the residuals whose neighbours are compared
    for name, noise in (("warp", compared.noise_warp), ("weft", compared.noise_weft)):
        assert np.unique(experiment.noise[channel == name]) == pytest.approx(noise.typical, rel=0.05)
        assert noise.typical == pytest.approx(told["sigma_shear"] / np.sqrt(2.0), rel=0.3)
        assert noise.source == "neighbour differences of the residual"
    assert any("noise of the direction" in note and "neighbour" in note for note in notes)


def assert_same(first, second, close):
    """The same verdict, and values that differ by a small share of their standard deviations."""
    assert first.verdict == second.verdict
    for a, b in zip(row(first, "weave-skew").values, row(second, "weave-skew").values, strict=True):
        assert abs(a.value - b.value) < close * a.sigma
        assert b.sigma == pytest.approx(a.sigma, rel=close)


def test_part_and_measurement_moved_together_give_the_same_diagnosis(plain):
    surface, m, told, first = plain
    turn, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    shift = np.array([300.0, -200.0, 150.0])
    second = gd.diagnose(
        gd.Surface(surface.points @ turn.T + shift, surface.triangles),
        replace(m, points=m.points @ turn.T + shift),
        **{**told, "origin": tuple(turn @ np.array(told["origin"]) + shift)},
        reference=tuple(turn @ np.array([1.0, 0.0, 0.0])),
        effects=CHEAP,
    )
    assert_same(first, second, 0.05)


def test_the_numbering_of_the_mesh_makes_no_difference(plain):
    surface, m, told, first = plain
    rng = np.random.default_rng(2)
    number = rng.permutation(len(surface.points))
    points = np.empty_like(surface.points)
    points[number] = surface.points
    faces = number[surface.triangles][rng.permutation(len(surface.triangles))]
    assert_same(first, gd.diagnose(gd.Surface(points, faces), m, **told, effects=CHEAP), 0.05)


def test_a_table_in_inches_gives_the_same_diagnosis(plain, tmp_path):
    surface, m, told, first = plain
    table = np.column_stack([m.u / 25.4, m.v / 25.4, m.points / 25.4, m.shear])
    path = tmp_path / "inches.csv"
    np.savetxt(path, table, delimiter=",", header="u,v,x,y,z,shear", comments="", fmt="%.12f")
    assert_same(first, gd.diagnose(surface, gd.read_measurement(path, unit="in"), **told, effects=CHEAP), 0.01)


def test_an_effect_that_takes_long_is_looked_at_once_where_there_is_nothing_for_it(plain, monkeypatch):
    from geomdrap.effects.shear_stiffness import ShearStiffness

    surface, m, told, _ = plain
    drapes = []
    relaxing = ShearStiffness.on_fabric
    monkeypatch.setattr(ShearStiffness, "on_fabric", lambda self, fabric: drapes.append(1) or relaxing(self, fabric))
    d = gd.diagnose(surface, m, **told, effects=("weave-skew", "shear-stiffness"))
    assert d.verdict == "weave-skew"
    assert len(drapes) <= 4  # two values, from where the ply lies and from where it was meant to
    # and both the table and the JSON say so of it, and of it alone
    assert [(t.name, t.looked_at_only) for t in d.tried] == [("weave-skew", False), ("shear-stiffness", True)]
    assert [row[1] == "looked at only" for row in table_rows(d)[1:]] == [False, True]
    found = d.as_dict()["effects"]
    assert [e["looked_at_only"] for e in found] == [False, True]
    assert [e["parameters"][name]["sigma"] is None for e, name in zip(found, ("skew", "ratio"), strict=True)] == [
        False,
        True,
    ]


def test_locking_would_be_seen_at_no_angle_that_the_ply_does_not_reach(plain):
    surface, measurement, told, _ = plain
    d = gd.diagnose(surface, measurement, **told, effects=("weave-skew", "locking"))
    ((name, amount, unit),) = row(d, "locking").visible
    assert (name, unit) == ("angle", "deg")
    assert amount is not None
    assert 1.0 < 90.0 - amount <= d.experiment.top_shear


def test_a_ply_that_seems_to_lie_centimetres_away_is_looked_for_where_it_was_meant_to_lie(tmp_path):
    """Directions do not say where a ply lies: without the steering they fitted best 26 mm off, and with it stayed."""
    make(11, effect="steering", part="valley", columns="directions", points=120, folder=tmp_path)
    surface, measurement, told = told_of(tmp_path)
    d = gd.diagnose(surface, measurement, **told, effects=("steering", "weave-skew"))
    true = unseal(tmp_path)["effect"]["steering"]
    assert d.verdict == "steering"
    assert all(abs(v.value) < 10.0 for v in d.placement)
    assert all(abs(v.value - true[v.name]) < 3.0 * v.sigma for v in row(d, "steering").values)


def test_labels_that_are_off_by_a_mark_lay_the_ply_elsewhere_and_that_is_said(plain):
    surface, measurement, told, right = plain
    d = gd.diagnose(surface, replace(measurement, u=measurement.u + 16.0), **told, effects=CHEAP)
    said = [hint for hint in d.hints if "off its place" in hint]
    assert len(said) == 1
    assert "du = -" in said[0]  # labels too large: the ply seems to begin further back
    assert "no label is off by a mark" in said[0]
    assert not any("off its place" in hint for hint in right.hints)
    # and where the ply lies is told beside an effect, too
    assert "dangle" in placement_sentence(d)
