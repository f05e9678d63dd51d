"""Areas: of the part, of the fabric on it, of its flat pattern; exact where the part unrolls, second order elsewhere."""

from dataclasses import replace

import numpy as np
import pytest
from made_parts import cube, open_box, pan, plate_with_holes, square_tube

import geomdrap as gd
from geomdrap.fields.contour import is_simple, signed_area
from geomdrap.fields.evaluate import doubts, stretch
from geomdrap.surface import Surface, shapes

TWO_TRIANGLES = Surface([[0, 0, 0], [100, 0, 0], [100, 60, 0], [0, 60, 0]], [[0, 1, 2], [0, 2, 3]])


def draped(surface, origin, angle, pitch, **options):
    return gd.evaluate(gd.drape(surface, origin, angle, pitch, **options))


def assert_fabric_is_the_part(result, within):
    area = result.area
    assert area.draped == pytest.approx(area.part, rel=1e-12)
    assert area.coverage == pytest.approx(1.0, abs=1e-12)
    assert area.fabric == pytest.approx(area.part, rel=within)
    assert result.flat.area == pytest.approx(area.fabric, rel=1e-6)
    assert result.bare == ()


@pytest.mark.parametrize("angle", [0.0, 13.0, 45.0, 77.7, 200.0])
@pytest.mark.parametrize("origin", ["centroid", (149.0, -99.0, 0.0), (-150.0, 20.0, 0.0)])
def test_a_plane_takes_its_own_area_of_fabric_from_any_seed_at_any_heading(origin, angle):
    result = draped(shapes.plane(300.0, 200.0, 10.0), origin, angle, 7.0)
    assert_fabric_is_the_part(result, 1e-9)
    assert len(result.flat.outer) == 1
    assert result.flat.inner == ()


@pytest.mark.parametrize("angle", [0.0, 20.0, 45.0, 100.0])
@pytest.mark.parametrize("origin", [(0.0, 0.0, 100.0), (-140.0, 90.0, 30.0)])
def test_a_cylinder_takes_its_own_area_of_fabric(origin, angle):
    result = draped(shapes.cylinder(100.0, 300.0, 5.0, 180.0), origin, angle, 5.0, project=True)
    assert_fabric_is_the_part(result, 1e-4)


@pytest.mark.parametrize("angle", [0.0, 33.0, 45.0])
@pytest.mark.parametrize("origin", [(-100.0, -100.0, 0.0), (150.0, -150.0, 0.0), (-40.0, 200.0, 0.0)])
def test_a_flat_l_takes_its_own_area_of_fabric(origin, angle):
    result = draped(shapes.l_shape(radius=np.inf), origin, angle, 7.0)
    assert_fabric_is_the_part(result, 1e-9)
    assert len(result.flat.outer) == 1


@pytest.mark.parametrize(("angle", "pitch"), [(0.0, 5.0), (31.0, 5.0), (31.0, 0.8), (10.0, 17.0)])
def test_a_plate_of_two_triangles_is_draped_at_any_pitch(angle, pitch):
    result = draped(TWO_TRIANGLES, (30.0, 30.0, 0.0), angle, pitch)
    assert_fabric_is_the_part(result, 1e-9)
    outline = result.flat.outer[0]
    size = np.sort(np.linalg.norm(outline - np.roll(outline, 1, axis=0), axis=1))[::-1]
    assert size[:4] == pytest.approx([100.0, 100.0, 60.0, 60.0], abs=0.01) or len(outline) > 4
    assert np.abs(outline).max() < np.hypot(70.0, 30.0) + 1e-6


def test_a_very_fine_mesh_is_draped_like_a_coarse_one():
    fine = draped(shapes.plane(100.0, 60.0, 0.7), "centroid", 31.0, 5.0)
    coarse = draped(shapes.plane(100.0, 60.0, 30.0), "centroid", 31.0, 5.0)
    assert fine.area.fabric == pytest.approx(coarse.area.fabric, rel=1e-9)
    assert signed_area(fine.flat.outer[0]) == pytest.approx(6000.0, rel=1e-6)


def test_holes_are_inner_contours_of_their_own_area():
    part = plate_with_holes(((0.0, 0.0, 30.0), (60.0, 60.0, 20.0)))
    result = draped(part, (-60.0, -50.0, 0.0), 17.0, 5.0)
    assert_fabric_is_the_part(result, 1e-6)
    assert len(result.flat.outer) == 1
    holes = sorted(-signed_area(hole) for hole in result.flat.inner)
    assert holes == pytest.approx([40.0**2, 60.0**2], rel=1e-5)
    assert signed_area(result.flat.outer[0]) == pytest.approx(200.0**2, rel=1e-6)


@pytest.mark.parametrize("origin", [(30.0, 0.0, 0.0), (31.0, 3.0, 0.0), (100.0, 3.0, 0.0)])
def test_a_seed_on_the_rim_or_at_a_hole_drapes_all(origin):
    assert_fabric_is_the_part(draped(plate_with_holes(), origin, 17.0, 5.0), 1e-6)


@pytest.mark.parametrize(("angle", "half"), [(0.0, (20.0, 10.0)), (31.0, (20.0, 10.0)), (31.0, (12.3, 8.7))])
def test_a_blank_on_a_plate_is_draped_in_its_own_size(angle, half):
    result = draped(TWO_TRIANGLES, (50.0, 30.0, 0.0), angle, 5.0, reach=half)
    blank = 4.0 * half[0] * half[1]
    assert result.area.fabric == pytest.approx(blank, rel=1e-9)
    assert result.area.draped == pytest.approx(blank, rel=1e-6)
    assert result.flat.area == pytest.approx(blank, rel=1e-9)
    outline = np.concatenate(result.flat.outer)
    assert np.abs(outline).max(axis=0) == pytest.approx(half, abs=1e-6)
    assert sum(b.area for b in result.bare) == pytest.approx(6000.0 - blank, rel=1e-6)


def test_a_blank_that_hangs_over_is_cut_at_the_part():
    result = draped(TWO_TRIANGLES, (50.0, 30.0, 0.0), 0.0, 4.0, reach=(20.0, 80.0))
    assert result.area.fabric == pytest.approx(40.0 * 60.0, rel=1e-9)


@pytest.mark.parametrize("angle", [0.0, 30.0, 45.0])
def test_a_tube_is_covered_once(angle):
    for part in (square_tube(), shapes.cylinder(25.0, 200.0, 4.0)):
        result = draped(part, part.points[0], angle, 4.0)
        assert result.area.coverage > 0.999
        assert result.area.fabric == pytest.approx(result.area.draped, rel=2e-3)


def test_a_closed_sphere_is_not_covered_twice():
    result = draped(shapes.icosphere(100.0, 4), (3.0, 7.0, 99.0), 45.0, 5.0, project=True)
    area = result.area
    assert area.coverage > 0.95
    # each piece of fabric lies on a piece of the part that is smaller by the cosine of its shear
    assert area.draped <= area.fabric <= area.part / np.cos(np.radians(result.statistics.max))
    lay = result.face_coverage * result.net.surface.areas
    thicker = np.nansum(lay * result.face_thickness)
    assert area.fabric == pytest.approx(thicker, rel=0.02)


def test_a_cube_is_draped_to_its_darts_and_no_more():
    result = draped(cube(), (3.0, 7.0, 30.0), 20.0, 4.0)
    assert 0.8 < result.area.coverage <= 1.0  # behind a corner that takes 90 degrees a ply needs a dart: bare
    assert result.area.fabric < 1.1 * result.area.draped
    assert is_simple((*result.flat.outer, *result.flat.inner))


@pytest.mark.parametrize("part", ["cap", "saddle"])
def test_the_fabric_area_is_second_order_in_the_pitch(part):
    surface = shapes.sphere_cap(100.0, 60.0, 2.0) if part == "cap" else shapes.saddle(200.0, 240.0, 2.0)
    starts = [((7.0, -11.0, 98.0), 13.0), ((20.0, 5.0, 96.0), 50.0), ((-15.0, 22.0, 96.0), 75.0)]
    pitches = np.array([20.0, 10.0, 5.0, 2.5])
    errors = []
    for origin, angle in starts:
        area = [draped(surface, origin, angle, p, project=True).area.fabric for p in (*pitches, 1.7)]  # finer than 2 mm, the facets show
        errors.append(np.array(area[:-1]) / area[-1] - 1.0)
    rms = np.sqrt(np.mean(np.square(errors), axis=0))
    assert (rms < 0.03 * (pitches / 100.0) ** 2).all()  # the radius of the cap is 100 mm


@pytest.mark.parametrize("origin", [(0.0, 0.0, 30.0), (7.0, -4.0, 30.0)])
@pytest.mark.parametrize("edge", [4.0, 8.0])
def test_a_box_takes_as_much_fabric_as_it_is_covered(origin, edge):
    result = gd.evaluate(gd.drape(open_box(edge), origin, 0.0, 4.0))
    assert result.statistics.max < 1e-6
    assert result.area.fabric == pytest.approx(result.area.draped, rel=2e-4)


@pytest.mark.parametrize(("origin", "angle"), [((15.0, 0.0, 0.0), 45.0), ((40.0, 40.0, 0.0), 0.0)])
def test_the_rim_of_a_pan_is_smooth_in_the_flat_pattern(origin, angle):
    result = gd.evaluate(gd.drape(pan(), origin, angle, 5.0, project=True))
    assert result.area.coverage == pytest.approx(1.0, abs=1e-9)
    for loop in (*result.flat.outer, *result.flat.inner):
        ways = np.roll(loop, -1, axis=0) - loop
        headings = np.degrees(np.arctan2(ways[:, 1], ways[:, 0]))
        turns = (headings - np.roll(headings, 1) + 180.0) % 360.0 - 180.0
        assert np.abs(turns).max() < 35.0


@pytest.mark.parametrize("strains", [(0.01, 0.02), (-0.01, 0.0)])
def test_strained_yarns_cover_more_or_less_than_flat_ones_and_that_can_be(strains):
    plane = shapes.plane(200.0, 150.0, 10.0)
    given = dict(zip(("strain_warp", "strain_weft"), strains, strict=True))
    net = gd.drape(plane, (0.0, 0.0, 0.0), 0.0, 10.0, effects=[gd.effects.make("yarn-extension", **given)])
    assert stretch(net) == pytest.approx((1.0 + strains[0]) * (1.0 + strains[1]), rel=1e-6)
    result = gd.evaluate(net)
    assert not any("cannot be" in warning for warning in result.warnings)
    # the strip between the last cell and the rim, a tenth of this plate, is taken as unstrained
    assert result.area.draped / result.area.fabric == pytest.approx(stretch(net), abs=0.15 * abs(stretch(net) - 1.0))


@pytest.mark.parametrize(("stretched", "said"), [(1.0, True), (1.02, True), (1.04, False)])
def test_a_fabric_smaller_than_what_it_covers_is_doubted(stretched, said):
    result = draped(shapes.plane(200.0, 150.0, 10.0), (0.0, 0.0, 0.0), 0.0, 10.0)
    area = replace(result.area, fabric=0.97 * result.area.draped)
    assert any("cannot be" in sentence for sentence in doubts(result.flat, result.checks, area, stretched)) == said
