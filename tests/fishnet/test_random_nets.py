"""Whatever part, seed, heading and pitch come: a net that keeps its promises, or an error that says why not."""

import warnings

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from made_parts import bumpy_sheet, face_point
from retraced import side_misses

import geomdrap as gd
from geomdrap.errors import GeomdrapError
from geomdrap.fishnet import Status
from geomdrap.surface import Surface

SETTINGS = settings(max_examples=30, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))



@st.composite
def bumpy_parts(draw):
    size = draw(st.sampled_from([1.0, 100.0, 1e4]))
    return bumpy_sheet(
        draw(st.integers(0, 10_000)),
        draw(st.integers(2, 24)),
        size,
        size * draw(st.floats(0.0, 1.5)),
        draw(st.floats(0.0, 0.45)),
    )


@st.composite
def seeds(draw, surface):
    """A vertex, or a point on an edge or in a face."""
    if draw(st.booleans()):
        return draw(st.integers(0, len(surface.points) - 1))
    face = draw(st.integers(0, len(surface.triangles) - 1))
    weights = np.array(draw(st.tuples(*[st.sampled_from([0.0, 0.2, 0.5, 1.0])] * 3))) + 1e-300
    return face_point(surface, face, weights / weights.sum())


def assert_promises(net, retrace=True):
    present = np.isfinite(net.points[..., 0])
    np.testing.assert_array_equal(net.status == Status.PRESENT, present)
    np.testing.assert_array_equal(net.face >= 0, present)
    assert set(np.unique(net.status_around)) <= {int(s) for s in Status}
    np.testing.assert_array_equal(np.isfinite(net.cell_shear), net.cell_valid)
    if net.cell_valid.any():
        assert np.nanmax(abs(net.cell_shear)) < 90.0
    i, j = int(np.argmin(abs(net.u))), int(np.argmin(abs(net.v)))
    assert present[i, j]
    assert net.surface.nearest(net.points[present]).distance.max() < 1e-5 * net.pitch
    if retrace and net.cell_valid.any():
        # on wild meshes a few sides in a million pass a vertex so closely that they are off by more than 1e-5
        misses = side_misses(net)
        assert misses.max() < 2e-3 * net.pitch
        assert np.median(misses) < 1e-6 * net.pitch


@SETTINGS
@given(st.data(), bumpy_parts(), st.floats(-360.0, 360.0), st.floats(0.02, 0.6))
def test_a_bumpy_part_is_draped_with_sides_of_the_pitch(data, surface, angle, share):
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        origin = data.draw(seeds(surface))
        try:
            net = gd.drape(surface, origin, angle, share * 0.5 * surface.diagonal)
        except GeomdrapError as error:  # a large pitch near the rim
            assert share > 0.1, error
            return
    assert_promises(net)


@SETTINGS
@given(st.data(), bumpy_parts(), st.floats(0.02, 0.4))
def test_a_part_with_holes_is_draped(data, surface, share):
    count = data.draw(st.integers(1, 12))
    gone = data.draw(st.lists(st.integers(0, len(surface.triangles) - 1), min_size=count, max_size=count))
    kept = np.delete(np.arange(len(surface.triangles)), gone)
    if len(kept) == 0:
        return
    try:
        holed = Surface(surface.points, surface.triangles[kept])
        net = gd.drape(holed, data.draw(seeds(holed)), 30.0, share * 0.5 * holed.diagonal, project=True)
    except GeomdrapError as error:
        assert "\n" not in str(error)
        return
    assert_promises(net)


@SETTINGS
@given(st.data(), st.integers(0, 10_000), st.floats(0.0, 360.0))
def test_a_crumpled_part_is_draped_or_refused(data, seed, angle):
    rng = np.random.default_rng(seed)
    sheet = bumpy_sheet(seed, 8)
    crumpled = sheet.points + rng.normal(scale=data.draw(st.floats(0.0, 20.0)), size=sheet.points.shape)
    try:
        surface = Surface(crumpled, sheet.triangles)
        net = gd.drape(surface, data.draw(seeds(surface)), angle, data.draw(st.floats(1.0, 30.0)))
    except GeomdrapError as error:
        assert "\n" not in str(error)
        return
    assert_promises(net)


anything = st.one_of(
    st.floats(),
    st.integers(-10, 10),
    st.none(),
    st.text(max_size=5),
    st.tuples(st.floats(), st.floats(), st.floats()),
)
size = st.one_of(st.floats(), st.none())


@SETTINGS
@given(anything, st.floats(), size, st.one_of(st.none(), st.tuples(st.floats(), st.floats())))
def test_whatever_the_arguments_there_is_a_net_or_one_clear_sentence(origin, angle, pitch, reach):
    surface = bumpy_sheet(1, 6)
    if pitch is not None and 0.0 < pitch < 0.1:
        pitch = None  # a million nodes are possible, but not a matter of this test
    try:
        net = gd.drape(surface, origin, angle, pitch, reach)
    except GeomdrapError as error:
        assert "\n" not in str(error)
        return
    assert_promises(net, retrace=False)
