"""A drape does not depend on where the part lies, in which unit it is, or how it is numbered."""

import numpy as np
import pytest
from made_parts import bumpy_sheet

import geomdrap as gd
from geomdrap.surface import Surface, shapes

PARTS = {
    "bumps": (bumpy_sheet(21, n=40, height=25.0), (3.3, -4.1, 0.0), 3.0),
    "bracket": (shapes.bracket(edge=6.0), (40.3, 11.7, 0.0), 6.0),
    "double dome": (shapes.double_dome(), (10.3, 5.7, 60.0), 7.0),
    "hood": (shapes.car_hood(edge=25.0), (40.3, 25.7, 30.0), 30.0),
    "sphere": (shapes.icosphere(50.0, 4), (11.0, 23.0, 41.0), 4.1),
    "tube": (shapes.cylinder(30.0, 120.0, 6.0), (7.0, 3.0, 29.0), 4.3),
    "cone too steep": (shapes.cone(1.0, 90.0, 4.0), (-30.0, -24.0, -38.0), 4.0),
    "L": (shapes.l_shape(edge=12.0), (-80.3, -60.7, 0.0), 12.0),
}


def the_same(a, b, atol, shear=1e-6):
    assert a.points.shape == b.points.shape
    np.testing.assert_array_equal(a.status, b.status)
    np.testing.assert_allclose(a.points, b.points, atol=atol)
    np.testing.assert_allclose(a.cell_shear, b.cell_shear, atol=shear)
    np.testing.assert_allclose(a.shear, b.shear, atol=shear)


@pytest.fixture(params=PARTS)
def part(request):
    surface, seed, pitch = PARTS[request.param]
    seed = surface.nearest(np.array([seed])).point[0]
    reference = np.array([1.0, 0.2, 0.3])
    return surface, seed, pitch, reference, gd.drape(surface, seed, 25.0, pitch, reference=reference)


def test_a_rigid_motion_of_the_part_moves_the_net_with_it(part):
    surface, seed, pitch, reference, net = part
    turn, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    shift = np.array([120.0, -340.0, 560.0])
    moved = Surface(surface.points @ turn.T + shift, surface.triangles)
    there = gd.drape(moved, turn @ seed + shift, 25.0, pitch, reference=turn @ reference)
    np.testing.assert_array_equal(net.status, there.status)
    np.testing.assert_allclose(net.points @ turn.T + shift, there.points, atol=1e-6)
    np.testing.assert_allclose(net.cell_shear, there.cell_shear, atol=1e-4)


@pytest.mark.parametrize("scale", [1e-3, 25.4, 1e4])
def test_a_larger_part_with_a_larger_pitch_gives_a_larger_net(part, scale):
    surface, seed, pitch, reference, net = part
    larger = Surface(scale * surface.points, surface.triangles)
    there = gd.drape(larger, scale * seed, 25.0, scale * pitch, reference=reference)
    np.testing.assert_array_equal(net.status, there.status)
    np.testing.assert_allclose(scale * net.points, there.points, atol=1e-8 * scale * surface.diagonal)
    np.testing.assert_allclose(net.cell_shear, there.cell_shear, atol=1e-4)


def test_a_part_in_metres_read_with_its_unit_gives_the_net_of_the_same_part_in_mm(tmp_path):
    meshio = pytest.importorskip("meshio")
    surface, seed, pitch = PARTS["bracket"]
    for name, unit in (("mm", 1.0), ("m", 1e3)):
        mesh = meshio.Mesh(surface.points / unit, [("triangle", surface.triangles)])
        mesh.write(tmp_path / f"{name}.vtu")
    nets = [
        gd.drape(gd.read_surface(tmp_path / f"{unit}.vtu", unit=unit), seed, 25.0, pitch) for unit in ("mm", "m")
    ]
    the_same(*nets, atol=1e-9, shear=1e-6)


def test_the_numbering_of_the_mesh_does_not_matter(part):
    surface, seed, pitch, reference, net = part
    rng = np.random.default_rng(3)
    order = rng.permutation(len(surface.points))  # new number -> old number
    number = np.argsort(order)
    faces = number[surface.triangles[rng.permutation(len(surface.triangles))]]
    faces = np.stack([np.roll(f, k) for f, k in zip(faces, rng.integers(0, 3, len(faces)), strict=True)])
    shuffled = Surface(surface.points[order], faces)
    there = gd.drape(shuffled, seed, 25.0, pitch, reference=reference)
    np.testing.assert_array_equal(net.status, there.status)
    np.testing.assert_allclose(net.points, there.points, atol=1e-6)
    np.testing.assert_allclose(net.cell_shear, there.cell_shear, atol=1e-4)


def test_on_the_other_side_of_the_part_the_net_is_its_mirror_image(part):
    surface, seed, pitch, reference, net = part
    there = gd.drape(surface.flipped(), seed, -25.0, pitch, reference=reference)
    # the warp is the same, the weft runs the other way
    np.testing.assert_allclose(there.warp0, net.warp0, atol=1e-9)
    np.testing.assert_allclose(there.weft0, -net.weft0, atol=1e-9)
    np.testing.assert_allclose(there.v, -net.v[::-1], atol=1e-9)
    np.testing.assert_array_equal(net.status, there.status[:, ::-1])
    np.testing.assert_allclose(net.points, there.points[:, ::-1], atol=1e-6)
    np.testing.assert_allclose(net.cell_shear, -there.cell_shear[:, ::-1], atol=1e-4)


def test_warp_and_weft_may_change_their_roles(part):
    surface, seed, pitch, reference, net = part
    # 90 degrees on, the new warp is the old weft, and the new weft the old warp backward
    there = gd.drape(surface, seed, 115.0, pitch, reference=reference)
    np.testing.assert_allclose(there.u, net.v, atol=1e-9)
    np.testing.assert_allclose(there.v, -net.u[::-1], atol=1e-9)
    back = there.points.transpose(1, 0, 2)[::-1]
    np.testing.assert_array_equal(net.status, there.status.T[::-1])
    np.testing.assert_allclose(net.points, back, atol=1e-6)
    np.testing.assert_allclose(net.cell_shear, -there.cell_shear.T[::-1], atol=1e-4)


def test_a_part_and_its_mirror_image_have_mirrored_nets(part):
    surface, seed, pitch, reference, net = part
    mirror = np.array([1.0, -1.0, 1.0])
    other = Surface(surface.points * mirror, surface.triangles[:, ::-1])
    there = gd.drape(other, seed * mirror, -25.0, pitch, reference=reference * mirror)
    np.testing.assert_allclose(net.points, there.points[:, ::-1] * mirror, atol=1e-6)
    np.testing.assert_allclose(net.cell_shear, -there.cell_shear[:, ::-1], atol=1e-4)


def test_the_same_call_gives_the_same_bits_again(part):
    surface, seed, pitch, reference, net = part
    again = gd.drape(surface, seed, 25.0, pitch, reference=reference)
    for name in ("points", "face", "status", "cell_shear", "shear", "u", "v"):
        assert getattr(net, name).tobytes() == getattr(again, name).tobytes()
