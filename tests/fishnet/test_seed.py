"""Where the net starts and which way its yarns leave: every sign has a test."""

import numpy as np
import pytest
from made_parts import bumpy_sheet, cube, plate_with_holes, pyramid

import geomdrap as gd
from geomdrap.errors import DrapeError
from geomdrap.fishnet import Fabric
from geomdrap.surface import Surface, samples, shapes

PLANE = shapes.plane(200.0, 200.0, 10.0)
SPHERE = shapes.icosphere(50.0, 4)


def first_steps(net):
    """Unit directions from the origin to the first nodes along +u, +v, -u, -v."""
    i, j = int(np.argmin(abs(net.u))), int(np.argmin(abs(net.v)))
    ends = net.points[[i + 1, i, i - 1, i], [j, j + 1, j, j - 1]] - net.points[i, j]
    return ends / np.linalg.norm(ends, axis=1, keepdims=True)


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0, -45.0, 400.0])
def test_a_positive_angle_turns_the_warp_counter_clockwise_about_the_normal(angle):
    net = gd.drape(PLANE, (3.0, 4.0, 0.0), angle, 5.0)
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    exact = [[c, s, 0.0], [-s, c, 0.0], [-c, -s, 0.0], [s, -c, 0.0]]
    np.testing.assert_allclose(first_steps(net), exact, atol=1e-9)
    np.testing.assert_allclose([net.warp0, net.weft0, net.normal0], [exact[0], exact[1], [0, 0, 1]], atol=1e-12)


def test_on_a_part_turned_over_the_angle_turns_about_the_other_normal():
    net = gd.drape(PLANE.flipped(), (3.0, 4.0, 0.0), 30.0, 5.0)
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    np.testing.assert_allclose(net.normal0, [0.0, 0.0, -1.0], atol=1e-12)
    # about -z counter-clockwise is clockwise from above, for the warp as for the weft
    np.testing.assert_allclose(first_steps(net)[:2], [[c, -s, 0.0], [-s, -c, 0.0]], atol=1e-9)


def test_the_weft_leaves_ninety_degrees_counter_clockwise_of_the_warp():
    for seed in ((50.0, 1.0, 2.0), (-20.0, 40.0, 25.0), (3.0, -2.0, -50.0)):
        net = gd.drape(SPHERE, seed, 25.0, 3.0, (20.0, 20.0), project=True)
        np.testing.assert_allclose(np.cross(net.normal0, net.warp0), net.weft0, atol=1e-12)
        steps = first_steps(net)
        assert np.cross(steps[0], steps[1]) @ net.normal0 == pytest.approx(1.0, abs=0.01)
        np.testing.assert_allclose(steps[0], net.warp0, atol=0.06)


def test_the_heading_counts_from_x_seen_along_the_normal():
    net = gd.drape(SPHERE, (20.0, 30.0, 35.0), 0.0, 3.0, (20.0, 20.0), project=True)
    n = net.normal0
    exact = np.array([1.0, 0.0, 0.0]) - n[0] * n
    np.testing.assert_allclose(net.warp0, exact / np.linalg.norm(exact), atol=1e-12)


@pytest.mark.parametrize(("tilt", "axis"), [(4.0, 1), (6.0, 0)])
def test_where_x_is_within_five_degrees_of_the_normal_the_heading_counts_from_y(tilt, axis):
    turn = np.radians(90.0 - tilt)  # a plane whose normal is `tilt` degrees from x
    rotation = np.array([[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]])
    surface = Surface(PLANE.points @ rotation.T, PLANE.triangles)
    net = gd.drape(surface, (0.0, 0.0, 0.0), 0.0, 5.0)
    direction = np.eye(3)[axis]
    exact = direction - (direction @ net.normal0) * net.normal0
    np.testing.assert_allclose(net.warp0, exact / np.linalg.norm(exact), atol=1e-9)


def test_another_reference_direction_turns_the_net():
    net = gd.drape(PLANE, (3.0, 4.0, 0.0), 10.0, 5.0, reference=(0.0, 2.0, 7.0))
    same = gd.drape(PLANE, (3.0, 4.0, 0.0), 100.0, 5.0)
    np.testing.assert_allclose(net.points, same.points, atol=1e-9)


@pytest.mark.parametrize("reference", [(0, 0, 1), (0, 0, 0), (np.nan, 0, 0), (1, 0), "x", (0.05, 0, 1)])
def test_a_reference_direction_that_gives_no_heading_is_refused(reference):
    with pytest.raises(DrapeError, match="reference"):
        gd.drape(PLANE, (0.0, 0.0, 0.0), 0.0, 5.0, reference=reference)


def test_the_centroid_is_that_of_the_area_projected_onto_the_part():
    surface = shapes.hemisphere(50.0, 3.0)
    net = gd.drape(surface, "centroid", 0.0, 4.0)
    np.testing.assert_allclose(net.origin, [0.0, 0.0, 50.0], atol=1.0)
    sheet = bumpy_sheet(1)
    net = gd.drape(sheet, "centroid", 0.0, 4.0)
    corners = sheet.points[sheet.triangles]
    middle = (corners.mean(axis=1) * sheet.areas[:, None]).sum(axis=0) / sheet.area
    np.testing.assert_allclose(net.origin, sheet.nearest(middle[None]).point[0], atol=1e-9)


@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_the_centroid_of_a_double_dome_is_laid_onto_its_plane_of_symmetry(angle):
    turn = np.array([[1.0, 0, 0], [0, np.cos(angle), -np.sin(angle)], [0, np.sin(angle), np.cos(angle)]])
    dome = samples.build("double-dome", edge=8.0)
    net = gd.drape(Surface(dome.points @ turn.T, dome.triangles), "centroid", 0.0, 10.0)
    back = net.origin @ turn
    np.testing.assert_allclose(back[:2], 0.0, atol=1e-6)
    assert any("straight across from it" in note for note in net.notes)


def test_the_centroid_of_a_helmet_is_laid_onto_its_crown_though_its_flanks_are_nearer():
    dome = shapes.hemisphere(50.0, 3.0)
    surface = Surface(dome.points * [1.3, 0.6, 1.1], dome.triangles)
    assert abs(surface.nearest(surface.centroid[None]).point[0, 1]) > 20.0
    net = gd.drape(surface, "centroid", 0.0, 4.0)
    np.testing.assert_allclose(net.origin, [0.0, 0.0, 55.0], atol=0.1)


def test_the_centroid_of_a_cone_is_laid_onto_its_tip_though_single_precision_moves_it_aside():
    cone = samples.build("cone", edge=10.0)
    rounded = Surface(cone.points.astype(np.float32).astype(float), cone.triangles)
    tip = rounded.points[rounded.points[:, 2].argmax()]
    net = gd.drape(rounded, "centroid", 0.0, 10.0)
    np.testing.assert_array_equal(net.origin, tip)
    i, j = int(np.argmin(abs(net.u))), int(np.argmin(abs(net.v)))
    halves = ((slice(None, i), slice(i, None)), (slice(None, j), slice(j, None)))
    quarters = [np.nanmean(net.cell_shear[a, b]) for a in halves[0] for b in halves[1]]
    np.testing.assert_allclose(np.abs(quarters), np.mean(np.abs(quarters)), rtol=0.1)


def test_a_centroid_over_a_hole_or_in_a_closed_part_says_that_other_points_are_as_near():
    square = plate_with_holes()  # its centroid is in a hole
    for surface, pitch in ((square, 4.0), (SPHERE, 10.0)):
        (note,) = gd.drape(surface, "centroid", 0.0, pitch).notes
        assert "are as near: choose one with --origin x,y,z" in note
        lies = np.linalg.norm(surface.nearest(surface.centroid[None]).point[0] - surface.centroid)
        assert f"the centroid lies {lies:.4g} mm off the part" in note


@pytest.mark.parametrize("origin", [220, "vertex:220", np.int64(220)])
def test_a_vertex_number_is_that_of_the_input(origin):
    points = np.vstack([PLANE.points[:1] + 1e3, PLANE.points])  # a point that no triangle uses comes first
    surface = Surface(points, PLANE.triangles + 1)
    net = gd.drape(surface, origin, 0.0, 5.0)
    np.testing.assert_allclose(net.origin, points[220], atol=1e-12)


@pytest.mark.parametrize("origin", ["vertex:100000", 100000, -1, "vertex:-1"])
def test_a_vertex_that_the_part_does_not_have_is_refused(origin):
    with pytest.raises(DrapeError):
        gd.drape(PLANE, origin, 0.0, 5.0)


@pytest.mark.parametrize(
    "origin", [(np.nan, 0, 0), (np.inf, 0, 0), (1.0, 2.0), "middle", "1,2,3,4", (1, 2, 3, 4), None, ("a", 0, 0)]
)
def test_an_origin_that_is_no_point_is_refused(origin):
    with pytest.raises(DrapeError, match="origin"):
        gd.drape(PLANE, origin, 0.0, 5.0)


@pytest.mark.parametrize("angle", [np.nan, np.inf, 1e308, -1.1e6])
def test_a_heading_that_is_no_number_is_refused(angle):
    with pytest.raises(DrapeError, match="heading"):
        gd.drape(PLANE, "centroid", angle, 5.0)


def test_an_origin_further_off_than_a_pitch_is_refused_unless_it_may_be_projected():
    near = gd.drape(PLANE, (3.0, 4.0, 4.9), 0.0, 5.0)
    np.testing.assert_allclose(near.origin, [3.0, 4.0, 0.0], atol=1e-12)
    with pytest.raises(DrapeError, match="project"):
        gd.drape(PLANE, (3.0, 4.0, 5.1), 0.0, 5.0)
    far = gd.drape(PLANE, (3.0, 4.0, 500.0), 0.0, 5.0, project=True)
    np.testing.assert_allclose(far.points, near.points, atol=1e-12)


@pytest.mark.parametrize("seed", [(0.0, 0.0, 0.0), (5.0, 0.0, 0.0), (5.0, 5.0, 0.0), (5.0 + 1e-9, 5.0, 0.0)])
def test_a_seed_on_a_vertex_or_an_edge_gives_the_same_net_as_one_beside_it(seed):
    for angle in (0.0, 45.0, 17.0):
        net = gd.drape(PLANE, seed, angle, 7.3)
        warp = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0.0])
        flat = np.asarray(seed) + net.u[:, None, None] * warp
        flat = flat + net.v[None, :, None] * np.array([-warp[1], warp[0], 0.0])
        present = np.isfinite(net.points[..., 0])
        assert present.sum() > 600
        np.testing.assert_allclose(net.points[present], flat[present], atol=1e-6)


def test_a_vertex_written_with_four_decimals_is_that_vertex():
    part = bumpy_sheet()
    number = int(np.linalg.norm(part.points - part.centroid, axis=1).argmin())
    written = np.round(part.points[number], 4)
    assert not np.array_equal(written, part.points[number])
    exact, near = gd.drape(part, f"vertex:{number}", 20.0, 4.0), gd.drape(part, written, 20.0, 4.0)
    np.testing.assert_allclose(near.points, exact.points, atol=1e-9)  # the fans are counted from other facets
    np.testing.assert_array_equal(near.origin, part.points[number])


def test_at_the_tip_of_a_cone_opposite_yarns_are_one_straightest_line():
    surface = pyramid(12, 0.5, 100.0, 20)
    net = gd.drape(surface, (0.0, 0.0, 0.0), 20.0, 4.0, (40.0, 40.0))
    i, j = len(net.u) // 2, len(net.v) // 2
    axes = [net.points[i + 5, j], net.points[i, j + 5], net.points[i - 5, j], net.points[i, j - 5]]
    turns = np.unwrap(np.arctan2([p[1] for p in axes], [p[0] for p in axes]))
    # four quarters of the tip's angle: a twelve-sided pyramid seen from above shows them within a degree
    np.testing.assert_allclose(np.degrees(np.diff(turns)), 90.0, atol=1.5)


@pytest.mark.parametrize(
    ("seed", "what"),
    [((-100.0, 3.0, 0.0), "rim"), ((-100.0, -100.0, 0.0), "corner"), ((-100.0, 10.0, 0.0), "vertex of the rim")],
)
@pytest.mark.parametrize("angle", [0.0, 20.0, 200.0])
def test_a_seed_on_the_rim_drapes_the_whole_part(seed, what, angle):
    net = gd.drape(PLANE, seed, angle, 5.0)
    assert net.cell_valid.sum() * 25.0 > 0.9 * PLANE.area, what
    assert np.nanmax(abs(net.cell_shear)) < 1e-4


@pytest.mark.parametrize("angle", [0.0, 27.0, 45.0])
def test_a_seed_on_the_rim_of_a_hole_drapes_the_whole_part(angle):
    surface = plate_with_holes()
    for seed in ("centroid", (30.0, 4.0, 0.0), (30.0, 30.0, 0.0), (-30.0, 30.0, 0.0)):
        net = gd.drape(surface, seed, angle, 4.0)
        assert net.cell_valid.sum() * 16.0 > 0.85 * surface.area
        assert np.nanmax(abs(net.cell_shear)) < 1e-3


def spiked_frame(tip=-30.0):
    """A square frame, open at the top, with a spike from below whose tip is nearest to the centroid."""
    outer = [(-100, -100), (100, -100), (100, 100), (-100, 100)]
    inner = [(-60, -60), (60, -60), (60, 60), (-60, 60)]
    points = np.array([(x, y, 0.0) for x, y in [*outer, *inner, (-15, -60), (15, -60), (0.0, tip)]])
    triangles = [(0, 1, 5), (0, 5, 9), (0, 9, 8), (0, 8, 4), (1, 2, 6), (1, 6, 5), (3, 0, 4), (3, 4, 7), (8, 9, 10)]
    return Surface(points, np.array(triangles))


@pytest.mark.parametrize("angle", [0.0, 30.0, 45.0])
def test_a_centroid_on_a_narrow_corner_of_the_rim_is_moved_inward_and_it_says_so(angle):
    part = spiked_frame()
    net = gd.drape(part, "centroid", angle, 4.0)
    np.testing.assert_allclose(net.origin, [0.0, -34.0, 0.0], atol=1e-9)
    assert any("moved 4 mm inward" in note for note in net.notes)
    assert net.cell_valid.sum() * 16.0 > 0.7 * part.area
    small = gd.drape(spiked_frame(-57.0), "centroid", angle, 4.0)  # a corner wider than 90 degrees is a good seed
    assert not any("moved" in note for note in small.notes)


def test_a_seed_of_the_users_own_on_a_narrow_corner_is_not_moved():
    with pytest.raises(DrapeError, match="corner"):
        gd.drape(spiked_frame(), (0.0, -30.0, 0.0), 45.0, 4.0)


def test_a_seed_on_the_corner_of_a_box_is_draped():
    net = gd.drape(cube(60.0, 6), (30.0, 30.0, 30.0), 0.0, 4.0, (25.0, 25.0))
    assert net.cell_valid.any()
    assert np.nanmax(abs(net.cell_shear)) < 90.0


def test_only_the_piece_with_the_origin_is_draped_and_it_says_so():
    shift = np.array([500.0, 0.0, 0.0])
    n = len(PLANE.points)
    both = Surface(
        np.vstack([PLANE.points, PLANE.points + shift]), np.vstack([PLANE.triangles, PLANE.triangles + n])
    )
    net = gd.drape(both, (495.0, 3.0, 0.0), 10.0, 5.0)
    alone = gd.drape(PLANE, (-5.0, 3.0, 0.0), 10.0, 5.0)
    np.testing.assert_allclose(net.points - shift, alone.points, atol=1e-9)
    assert any("2 separate pieces" in note for note in net.notes)
    assert not alone.notes
    net = gd.drape(both, f"vertex:{n + 100}", 10.0, 5.0)
    np.testing.assert_allclose(net.origin, PLANE.points[100] + shift, atol=1e-9)


def test_the_weft_angle_of_the_fabric_is_the_angle_between_the_yarns():
    net = gd.drape(PLANE, (0.0, 0.0, 0.0), 0.0, 5.0, fabric=Fabric(weft_angle=70.0))
    steps = first_steps(net)
    assert np.degrees(np.arctan2(steps[1][1], steps[1][0])) == pytest.approx(70.0, abs=1e-9)
    np.testing.assert_allclose(net.cell_shear[net.cell_valid], 20.0, atol=1e-6)


@pytest.mark.parametrize("arguments", [{"limit_angle": 0.0}, {"limit_angle": 91.0}, {"limit_angle": np.nan},
                                       {"weft_angle": 0.0}, {"weft_angle": 180.0}])  # fmt: skip
def test_fabrics_that_cannot_be_are_refused(arguments):
    with pytest.raises(DrapeError):
        Fabric(**arguments)
