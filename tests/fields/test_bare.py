"""What stays bare, and why; parts in several pieces; walls that nearly touch."""

import numpy as np
import pytest
from made_parts import square_tube

import geomdrap as gd
from geomdrap.fields.contour import is_simple
from geomdrap.fields.trim import trim
from geomdrap.fishnet import Status
from geomdrap.surface import Surface, samples, shapes


def plate_with_tab():
    """A plate with a tab of 3 mm x 40 mm on its side."""
    lines = np.linspace(0.0, 100.0, 101)
    return shapes.grid_surface(lambda x, y: 0 * x, lines, lines, keep=lambda x, y: (x < 60) | ((y > 49) & (y < 52)))


@pytest.mark.parametrize("angle", [0.0, 20.0])
def test_a_tab_narrower_than_the_pitch_is_named(angle):
    result = gd.evaluate(gd.drape(plate_with_tab(), (30.0, 30.0, 0.0), angle, 8.0))
    (tab,) = result.bare
    assert tab.reason == Status.TOO_NARROW.reason
    assert "smaller" in tab.reason
    assert 60.0 < tab.area < 110.0
    assert tab.center[0] > 60.0
    assert 49.0 < tab.center[1] < 52.0
    assert tab.area == pytest.approx(result.area.part - result.area.draped, rel=1e-9)


def test_the_same_tab_is_draped_at_a_finer_pitch():
    result = gd.evaluate(gd.drape(plate_with_tab(), (30.0, 30.0, 0.0), 20.0, 1.0))
    assert result.bare == ()
    assert result.area.coverage == pytest.approx(1.0, abs=1e-9)


def test_what_lies_beyond_the_blank_is_said_to():
    result = gd.evaluate(gd.drape(shapes.plane(300.0, 200.0, 10.0), "centroid", 30.0, 6.0, reach=(40.0, 30.0)))
    (around,) = result.bare
    assert around.reason == Status.BLANK.reason
    assert around.area + result.area.draped == pytest.approx(result.area.part, rel=1e-12)
    assert set(result.face_reason[result.face_coverage == 0.0]) == {Status.BLANK}
    turn = np.radians(30.0)
    flat = around.center @ np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)], [0.0, 0.0]])
    assert (np.abs(flat) > [35.0, 25.0]).any()  # in it, or in the middle of a facet that its edge crosses


def test_behind_a_fold_the_part_is_bare_and_a_dart_is_called_for():
    part = samples.build("double-dome")
    result = gd.evaluate(gd.drape(part, "centroid", 30.0, 10.0))
    if not result.bare:
        pytest.skip("draped to the end at this heading")
    assert result.bare[0].reason in {Status.FOLDED.reason, Status.BEHIND_FOLD.reason}
    assert "fold" in result.bare[0].reason
    assert sum(b.area for b in result.bare) == pytest.approx(result.area.part - result.area.draped, rel=0.02)


def test_a_cone_too_steep_for_a_ply_opens_in_a_slit_behind_its_tip():
    net = gd.drape(shapes.cone(1.0, 150.0, 3.0), (-50.0, -41.0, -65.0), 0.0, 3.0, (100.0, 100.0))
    result = gd.evaluate(net)
    assert (net.status == Status.FOLDED).any()
    assert (net.status == Status.BEHIND_FOLD).sum() > 50
    assert result.area.fabric < 0.99 * 200.0**2  # what would lie behind the tip is not counted
    assert result.area.fabric == pytest.approx(result.area.draped, rel=5e-3)


@pytest.mark.parametrize("seed", [(-30.0, -24.0, 0.0), (-50.0, -41.0, 0.0)])
@pytest.mark.parametrize("angle", [0.0, 20.0])
def test_the_slit_behind_the_tip_of_a_steep_cone_is_bare_and_calls_for_a_dart(seed, angle):
    result = gd.evaluate(gd.drape(shapes.cone(1.0, 150.0, 3.0), seed, angle, 3.0, project=True))
    slit = result.bare[0]
    assert slit.reason == Status.SLIT.reason
    assert "dart" in slit.reason
    assert slit.center[:2] @ seed[:2] < 0.0  # on the other side of the tip
    slant = 150.0 * np.sqrt(2.0)
    assert 0.8 * slant < slit.area / 3.0 < 4.0 * slant  # from about the tip to the rim, one to four cells wide
    assert result.area.coverage < 0.995
    assert is_simple((*result.flat.outer, *result.flat.inner))


@pytest.mark.parametrize("angle", [0.0, 30.0, 45.0])
def test_the_seam_of_a_tube_is_no_slit(angle):
    for part in (square_tube(), shapes.cylinder(25.0, 200.0, 4.0)):
        result = gd.evaluate(gd.drape(part, part.points[0], angle, 4.0))
        assert Status.SLIT.reason not in {b.reason for b in result.bare}
        assert result.area.coverage > 0.999


def test_a_part_on_which_no_cell_closes_is_refused_and_says_what_to_do():
    part = Surface([[0, 0, 0], [100, 0, 0], [100, 60, 0], [0, 60, 0]], [[0, 1, 2], [0, 2, 3]])
    with pytest.raises(gd.DrapeError, match=r"no cell of 110 mm closes.*use a smaller pitch"):
        gd.drape(part, (50.0, 30.0, 0.0), 31.0, 110.0)


def test_only_the_piece_with_the_origin_is_draped_and_measured():
    a, b = shapes.plane(100.0, 60.0, 10.0), shapes.plane(200.0, 100.0, 10.0)
    points = np.vstack([a.points, b.points + [300.0, 0.0, 40.0]])
    both = Surface(points, np.vstack([a.triangles, b.triangles + len(a.points)]))
    for origin, area in (((0.0, 0.0, 0.0), 6000.0), ((300.0, 0.0, 40.0), 20000.0)):
        result = gd.evaluate(gd.drape(both, origin, 20.0, 5.0))
        assert result.area.part == pytest.approx(area)
        assert result.area.fabric == pytest.approx(area, rel=1e-9)
        assert len(result.face_shear) == len(result.net.surface.triangles) < len(both.triangles)
        assert any("2 separate pieces" in note for note in result.net.notes)


def roof(gap, top=60.0, edge=5.0):
    """Two parallel walls, ``gap`` mm apart, that a roof joins at the top; its profile."""
    levels, half = np.linspace(0.0, top, round(top / edge) + 1), 0.5 * gap
    left = np.column_stack([np.full_like(levels, -half), levels])
    right = np.column_stack([np.full_like(levels, half), levels[::-1]])
    return np.vstack([left, [[0.0, top + half]], right])


@pytest.mark.parametrize("gap", [1.0, 4.0])
@pytest.mark.parametrize("angle", [0.0, 25.0, 45.0, 70.0])
def test_two_walls_that_nearly_touch_keep_their_own_fabric(gap, angle):
    pitch, half, seed_z = 4.0, 0.5 * gap, 30.0
    part = shapes.extrude(roof(gap), 100.0, 5.0)
    net = gd.drape(part, (0.0, -half, seed_z), angle, pitch)
    trimmed = trim(net)
    corners = trimmed.mesh.points[trimmed.mesh.triangles]
    side = np.sign(corners.mean(axis=1, keepdims=True)[..., 1])
    below = 60.0 - corners[..., 2] + np.sqrt(2) * half
    on_roof = np.sqrt(2) * np.abs(corners[..., 1])
    from_ridge = np.where(corners[..., 2] <= 60.0, below, on_roof)
    ridge = 60.0 + np.sqrt(2) * half - seed_z
    flat = np.stack([corners[..., 0], ridge + side * from_ridge], axis=-1)
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    exact = np.stack([flat @ [c, s], flat @ [-s, c]], axis=-1)
    miss = np.abs(trimmed.at - exact).max(axis=(1, 2))
    assert (trimmed.kind > 0).all()
    assert miss.max() < 0.3 * pitch  # a cell astride the ridge is far from flat
    assert miss[(from_ridge > 2.0 * pitch).all(axis=1)].max() < 1e-6
    result = gd.evaluate(net)
    assert result.area.fabric == pytest.approx(result.area.part, rel=2e-4)
    assert len(result.flat.outer) == 1
