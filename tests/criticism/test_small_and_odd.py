"""Few points, coincident points, wild values: a comparison, or a sentence."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import geomdrap as gd
from geomdrap.criticism.compare import compare_net
from geomdrap.criticism.layup import Layup
from geomdrap.criticism.prepare import prepare
from geomdrap.export.compare_json import as_dict
from geomdrap.export.compare_table import as_text
from geomdrap.surface import shapes


@pytest.fixture(scope="module")
def net():
    return gd.drape(shapes.sphere_cap(80.0, 60.0, 4.0), "centroid", 20.0, 8.0)


def _all_of(c):
    document = as_dict(c)
    assert document["used"] + document["unmatched"] == document["points"]
    assert len(as_text(c).splitlines()) == document["points"] + 1
    return document


@pytest.mark.parametrize("n", [1, 2, 3, 7, 8, 20])
@pytest.mark.parametrize("same", [True, False])
@pytest.mark.parametrize("labelled", [True, False])
def test_few_and_coincident_points_are_compared(net, n, same, labelled):
    u, v = np.random.default_rng(n).uniform(-30.0, 30.0, (2, n))
    if same:
        u[:], v[:] = 10.0, 5.0
    points, shear = net.interpolate(u, v)
    labels = {"u": u, "v": v} if labelled else {}
    document = _all_of(compare_net(net, gd.Measurement("few", points, shear=shear, **labels)))
    assert document["used"] == n
    assert document["position"]["rms"] == pytest.approx(0.0, abs=1e-6)


FLOATS = st.floats(-120.0, 120.0)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.lists(
        st.tuples(FLOATS, FLOATS, FLOATS, FLOATS, FLOATS, st.one_of(st.just(np.nan), st.floats(-89.0, 89.0))),
        min_size=1,
        max_size=30,
    ),
    st.booleans(),
)
def test_any_points_are_compared_or_refused(net, rows, labelled):
    table = np.array(rows)
    labels = {"u": table[:, 3], "v": table[:, 4]} if labelled else {}
    measurement = gd.Measurement("any", table[:, :3], shear=table[:, 5], **labels)
    try:
        c = compare_net(net, measurement, sigma_xyz=0.2)
    except gd.GeomdrapError as error:
        assert "any" in str(error)
        return
    document = _all_of(c)
    assert document["position"]["rms"] >= 0.0


def test_a_table_is_asked_for_as_many_values_as_a_fit_has_unknowns():
    from geomdrap.measurement.measurement import require_values

    m = gd.Measurement("few.csv", np.zeros((2, 3)), u=np.arange(2.0), v=np.zeros(2))
    require_values(m, 3, "the placement")
    with pytest.raises(gd.MeasurementError, match=r"few.csv holds 2 points with 6 .* 6 unknowns"):
        require_values(m, 6, "the placement")


@pytest.mark.parametrize(("n", "same"), [(1, False), (5, False), (6, False), (9, True)])
def test_fewer_than_six_places_are_too_few_for_a_diagnosis_and_their_number_is_said(net, n, same):
    u, v = np.random.default_rng(n).uniform(-30.0, 30.0, (2, n))
    if same:  # readings of one mark again and again are one place
        u[:], v[:] = 10.0, 5.0
    points, shear = net.interpolate(u, v)
    m = gd.Measurement("few.csv", points, u=u, v=v, shear=shear)
    layup, noise = Layup("centroid", 20.0), {"sigma_xyz": 0.5, "sigma_shear": 1.0}
    if n == 6:
        assert prepare(net.surface, m, layup, **noise)[0].mask.any(axis=1).sum() == 6
        return
    places = 1 if same else n
    with pytest.raises(gd.MeasurementError, match=rf"few.csv: points at {places} places? can .* at 6 places or more"):
        prepare(net.surface, m, layup, **noise)


@pytest.mark.parametrize("swapped", [False, True])
def test_swapped_labels_are_a_warning_of_a_diagnosis_and_no_note(net, swapped):
    u, v = np.random.default_rng(2).uniform(-30.0, 30.0, (2, 40))
    points = net.interpolate(u, v)[0] + np.random.default_rng(3).normal(0.0, 0.5, (40, 3))
    m = gd.Measurement("marks.csv", points, u=v if swapped else u, v=u if swapped else v)
    experiment, notes = prepare(net.surface, m, Layup("centroid", 20.0), sigma_xyz=0.5)
    assert ["u and v are swapped" in warning for warning in experiment.warnings] == [True] * swapped
    assert not any("swapped" in note for note in notes)


@pytest.mark.parametrize("told", [0.5, 20.0])
def test_a_noise_that_neighbours_contradict_is_a_warning_of_a_diagnosis(net, told):
    u, v = np.random.default_rng(2).uniform(-30.0, 30.0, (2, 40))
    points = net.interpolate(u, v)[0] + np.random.default_rng(3).normal(0.0, 0.5, (40, 3))
    m = gd.Measurement("marks.csv", points, u=u, v=v)
    warnings = prepare(net.surface, m, Layup("centroid", 20.0), sigma_xyz=told)[0].warnings
    assert ["--sigma-xyz" in said and "far too large" in said for said in warnings] == [True] * (told == 20.0)


def test_an_effect_without_parameters_is_not_tried_and_that_is_said(monkeypatch, net):
    class Nothing(gd.Effect):
        name = "nothing"
        stage = "net"

    monkeypatch.setattr("geomdrap.effects.registry._REGISTERED", {})
    gd.effects.register(Nothing)
    known = np.isfinite(net.points[::2, ::2, 0])
    u, v = (a[::2, ::2][known] for a in np.meshgrid(net.u, net.v, indexing="ij"))
    m = gd.Measurement("made", net.points[::2, ::2][known], u=u, v=v)
    d = gd.diagnose(net.surface, m, origin="centroid", angle=20.0, sigma_xyz=0.2, effects=["nothing", "weave-skew"])
    assert [t.name for t in d.tried] == ["weave-skew"]
    assert "nothing has no parameters to fit, and was not tried" in d.notes
