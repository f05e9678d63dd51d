"""Whatever the part, evaluating its net neither fails nor promises more than there is."""

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from made_parts import bumpy_sheet

import geomdrap as gd
from geomdrap.fields.contour import signed_area


@given(
    st.integers(0, 10_000),
    st.integers(3, 16),
    st.floats(0.0, 40.0),
    st.floats(1.5, 60.0),
    st.floats(-360.0, 360.0),
    st.one_of(st.none(), st.tuples(st.floats(3.0, 80.0), st.floats(3.0, 80.0))),
)
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_a_random_bumpy_plate_is_draped_within_its_own_bounds(seed, n, height, pitch, angle, reach):
    part = bumpy_sheet(seed, n=n, height=height)
    rng = np.random.default_rng(seed)
    origin = rng.dirichlet(np.ones(3)) @ part.points[part.triangles[rng.integers(len(part.triangles))]]
    try:
        net = gd.drape(part, origin, angle, pitch, reach, project=True)
    except gd.DrapeError as error:  # a blank smaller than a cell, or a seed that no cell can start from
        assert "no cell of" in str(error)
        return
    result = gd.evaluate(net)
    area, net = result.area, result.net
    assert 0.0 <= area.draped <= area.part * (1 + 1e-9)
    assert 0.0 <= area.coverage <= 1.0 + 1e-9
    assert ((result.face_coverage >= 0.0) & (result.face_coverage <= 1.0)).all()
    assert (result.face_coverage * part.areas).sum() <= area.part * (1 + 1e-9)
    listed = sum(b.area for b in result.bare)
    assert listed <= area.part - area.draped + 1e-6 * area.part
    if reach is not None:
        assert all((np.abs(loop) <= np.array(reach) + 1e-6).all() for loop in result.flat.outer)
        assert area.fabric <= 4.0 * reach[0] * reach[1] * (1 + 1e-6) or len(result.flat.outer) > 1
    on = result.face_coverage > 0.0
    assert np.isfinite(result.face_shear[on]).all()
    assert np.isnan(result.face_shear[~on]).all()
    assert (np.abs(result.face_shear[on]) <= 90.0).all()
    assert (result.face_thickness[on] >= 1.0).all()
    assert 0.0 <= result.statistics.mean <= result.statistics.max + 1e-9
    assert result.statistics.p95 <= result.statistics.max + 1e-9
    # the last correction of a cell, 1e-5 of a side, may move a node over an edge of its facet, in the facet's plane
    assert result.checks.off_surface < 1e-9 * part.diagonal + 1e-5 * pitch
    assert all(signed_area(loop) > 0.0 for loop in result.flat.outer)
    assert net.cell_valid.sum() * pitch**2 < 10.0 * area.part
