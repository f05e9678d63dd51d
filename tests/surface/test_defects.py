import numpy as np
import pytest
from raw_meshes import box, bumpy, fin, ribbon

from geomdrap.errors import SurfaceError
from geomdrap.surface import Surface


def beside(one, other, shift=(500.0, 0.0, 0.0)):
    """Two meshes in one."""
    return np.vstack([one[0], other[0] + shift]), np.vstack([one[1], other[1] + len(one[0])])


@pytest.mark.parametrize("mesh", [bumpy, box, ribbon])
def test_proper_surfaces_may_be_draped(mesh):
    Surface(*mesh()).require_drapable()


def test_a_fin_is_refused_with_its_place():
    with pytest.raises(SurfaceError, match=r"more than two faces, at \(50, 25, 0\): remove the fin"):
        Surface(*fin(), source="fin.stl").require_drapable()


def test_a_moebius_strip_is_refused():
    with pytest.raises(SurfaceError, match="only one side"):
        Surface(*ribbon(twist=1.0)).require_drapable()


@pytest.mark.parametrize("order", [[0, 1, 2], [0, 2, 1]], ids=["same way", "back to back"])
def test_a_shell_that_is_there_twice_is_refused(order):
    points, triangles = bumpy(5)
    twice = np.vstack([triangles, triangles[:, order] + len(points)])
    surface = Surface(np.vstack([points, points + 1e-7]), twice)
    assert len(surface.triangles) == len(triangles)
    with pytest.raises(SurfaceError, match="delete one of the two shells"):
        surface.require_drapable()


@pytest.mark.parametrize("bad", [fin, lambda: ribbon(twist=1.0)], ids=["fin", "strip"])
def test_only_the_component_that_is_draped_need_be_sound(bad):
    surface = Surface(*beside(bumpy(4), bad()))
    with pytest.raises(SurfaceError):
        surface.require_drapable()
    surface.only_component(0).require_drapable()
    with pytest.raises(SurfaceError):
        surface.only_component(len(surface.triangles) - 1).require_drapable()


def test_the_place_of_a_fin_does_not_depend_on_how_its_faces_are_turned():
    points, triangles = fin()
    for face in range(len(triangles)):
        for first in range(3):
            turned = triangles.copy()
            turned[face] = np.roll(turned[face], first)[[0, 2, 1]]
            assert Surface(points, turned).findings.non_manifold == ((50.0, 25.0, 0.0),)


def test_a_flipped_part_names_the_same_edges():
    with pytest.raises(SurfaceError, match=r"\(50, 25, 0\)"):
        Surface(*fin()).flipped().require_drapable()
