"""The side of a cell: chosen, checked, and warned about."""

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.errors import DrapeError
from geomdrap.surface import Surface, shapes

PLANE = shapes.plane(200.0, 100.0, 10.0)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 37.0])
def test_a_pitch_is_chosen_from_the_part_and_said(scale):
    surface = Surface(scale * PLANE.points, PLANE.triangles)
    net = gd.drape(surface)
    assert 1000 < np.isfinite(net.points[..., 0]).sum() < 40_000
    assert len(net.notes) == 1
    assert f"pitch {net.pitch:g} mm" in net.notes[0]
    leading = net.pitch / 10 ** np.floor(np.log10(net.pitch) + 1e-9)
    assert min(abs(leading - round_) for round_ in (1.0, 2.0, 2.5, 5.0)) < 1e-9


def test_a_pitch_that_was_given_is_not_commented_on():
    assert gd.drape(PLANE, pitch=5.0).notes == ()


@pytest.mark.parametrize("pitch", [0.0, -1.0, np.nan, np.inf, 300.0, "wide", [1.0, 2.0]])
def test_a_pitch_that_cannot_be_is_refused(pitch):
    with pytest.raises(DrapeError, match="pitch"):
        gd.drape(PLANE, "centroid", 0.0, pitch)


@pytest.mark.parametrize("pitch", [1e-4, 1e-9, 1e-200])
def test_a_pitch_that_needs_more_memory_than_there_is_is_refused(pitch):
    with pytest.raises(DrapeError, match="memory"):
        gd.drape(PLANE, "centroid", 0.0, pitch)


def test_a_tiny_pitch_with_a_small_blank_is_possible():
    net = gd.drape(PLANE, "centroid", 10.0, 1e-4, (0.01, 0.01))
    assert net.points.shape == (201, 201, 3)
    assert np.isfinite(net.points).all()


def test_a_pitch_as_large_as_the_part_gives_what_fits():
    with pytest.raises(DrapeError, match="no cell of 60 mm"):
        gd.drape(PLANE, "centroid", 0.0, 60.0)
    net = gd.drape(PLANE, "centroid", 0.0, 40.0)
    assert net.cell_valid.sum() == 8


def test_a_pitch_below_the_facets_of_a_curved_part_is_warned_about():
    surface = shapes.icosphere(50.0, 3)
    fine = gd.drape(surface, "centroid", 0.0, 1.0, (30.0, 30.0))
    assert len(fine.warnings) == 1
    assert "facets" in fine.warnings[0]
    assert gd.drape(surface, "centroid", 0.0, 10.0).warnings == ()


def test_large_facets_of_a_flat_part_are_not_warned_about():
    points = np.array([[0.0, 0, 0], [100, 0, 0], [100, 100, 0], [0, 100, 0]])
    net = gd.drape(Surface(points, [[0, 1, 2], [0, 2, 3]]), "centroid", 0.0, 2.0)
    assert net.warnings == ()
    assert net.cell_valid.sum() >= 49 * 49


def test_three_triangles_can_be_draped():
    points = np.array([[0.0, 0, 0], [10, 0, 0], [5, 9, 0], [15, 9, 0], [10, 18, 0]])
    net = gd.drape(Surface(points, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]), "centroid", 0.0, 1.0)
    assert net.cell_valid.sum() > 70
    assert np.nanmax(abs(net.cell_shear)) < 1e-6
