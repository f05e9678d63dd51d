"""Strips cut at an angle: sides on yarns, area and yarn kept, positive shear when pulled."""

from __future__ import annotations

import numpy as np
import pytest

from geomdrap.errors import FormingError
from geomdrap.forming import Cloth
from geomdrap.forming.clipped import strip
from geomdrap.forming.specimen import gradients, middle_shear, shear_of
from geomdrap.forming.uniaxial import kinematic_lock, strip_specimen

ANGLES = (0.0, 7.0, 15.0, 30.0, 45.0, 60.0, 90.0)


@pytest.mark.parametrize("angle", ANGLES)
def test_area_and_yarn_of_both_families_are_those_of_the_strip(angle: float) -> None:
    sheet = strip(150.0, 30.0, angle, 3.0)
    length = np.linalg.norm(np.diff(sheet.fabric[sheet.pieces], axis=1)[:, 0], axis=1)
    assert sheet.areas.sum() == pytest.approx(4500.0, rel=5e-4)
    for family in (0, 1):
        assert (length * sheet.width)[sheet.family == family].sum() == pytest.approx(sheet.areas.sum(), rel=2e-3)


@pytest.mark.parametrize("angle", ANGLES)
def test_pieces_of_yarn_run_along_warp_and_weft(angle: float) -> None:
    sheet = strip(150.0, 30.0, angle, 3.0)
    way = np.diff(sheet.fabric[sheet.pieces], axis=1)[:, 0]
    across = way[np.arange(len(way)), 1 - sheet.family]
    assert np.abs(across).max() < 1e-4
    place = np.diff(sheet.points[sheet.pieces], axis=1)[:, 0]
    turned = np.rad2deg(np.arctan2(place[:, 1], place[:, 0])) % 180.0
    wanted = np.where(sheet.family == 0, 90.0 - angle, 180.0 - angle) % 180.0
    off = np.abs((turned - wanted + 90.0) % 180.0 - 90.0)
    assert off.max() < 0.5  # snapped points


@pytest.mark.parametrize("angle", ANGLES)
def test_triangles_are_all_turned_the_same_way_and_none_lies_on_another(angle: float) -> None:
    sheet = strip(150.0, 30.0, angle, 3.0)
    a, b, c = np.moveaxis(sheet.points[sheet.triangles][:, :, :2], 1, 0)
    signed = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert signed.min() > 0.0
    edges = np.sort(sheet.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    assert counts.max() == 2


def test_at_45_degrees_the_borders_cut_cells_along_their_diagonals() -> None:
    sheet = strip(150.0, 30.0, 45.0, 1.5 * np.sqrt(2.0))
    assert len(sheet.points) == 1061
    assert sheet.areas.min() == pytest.approx(2.25, rel=1e-9)


def test_clamps_hold_all_nodes_on_both_ends() -> None:
    for angle in ANGLES:
        specimen = strip_specimen(Cloth(), angle=angle, cells=10)
        held = specimen.sheet.points[specimen.held]
        assert set(np.round(held[:, 1], 6)) == {-75.0, 75.0}
        for end in (-75.0, 75.0):
            x = np.sort(held[np.isclose(held[:, 1], end), 0])
            assert x[0] == pytest.approx(-15.0, abs=1e-6)
            assert x[-1] == pytest.approx(15.0, abs=1e-6)


def test_stretching_a_strip_along_its_length_is_positive_shear() -> None:
    sheet = strip(150.0, 30.0, 30.0, 3.0)
    stretched = sheet.points * [0.95, 1.05, 1.0]
    assert middle_shear(sheet, stretched) > 3.0
    assert np.ptp(shear_of(gradients(sheet, stretched))) < 0.01


@pytest.mark.parametrize(("angle", "lock"), [(0.0, 0.0), (10.0, 0.0), (15.0, 9.655), (30.0, 39.216), (45.0, 49.706)])
def test_the_kinematic_lock_has_its_known_values(angle: float, lock: float) -> None:
    assert kinematic_lock(150.0, 30.0, angle) == pytest.approx(lock, abs=6e-4)


def test_a_strip_that_cannot_be_is_refused() -> None:
    with pytest.raises(FormingError, match="length, width and pitch above 0 mm"):
        strip(0.0, 30.0, 45.0, 3.0)
    with pytest.raises(FormingError, match="angle from 0 to 90"):
        strip(150.0, 30.0, 100.0, 3.0)
    with pytest.raises(FormingError, match="at least 2 cells"):
        strip_specimen(Cloth(), cells=1)
