"""Between the last cell and the rim of the part, shear and coordinates stay of second order in the pitch."""

import numpy as np
import pytest
from exact_nets import sphere_shear_at

import geomdrap as gd
from geomdrap.fields.evaluate import unit_directions
from geomdrap.fields.strip import BEYOND, BY_NET
from geomdrap.fields.trim import trim
from geomdrap.surface import shapes

RADIUS = 100.0
STARTS = [((7.0, -11.0, 98.0), 13.0), ((20.0, 5.0, 96.0), 50.0), ((-15.0, 22.0, 96.0), 75.0)]


@pytest.fixture(scope="module")
def misses():
    """Root mean square errors (degrees) of the facets' shear on a cap, by kind, at pitches R/4, R/8, R/16, R/32."""
    part = shapes.sphere_cap(RADIUS, 60.0, 2.0)
    found = {BY_NET: [], BEYOND: []}
    for cells in (4, 8, 16, 32):
        squares = {BY_NET: [], BEYOND: []}
        for origin, angle in STARTS:
            trimmed = trim(gd.drape(part, origin, angle, RADIUS / cells, project=True))
            assert (trimmed.kind > 0).all()
            warp, weft = unit_directions(trimmed)
            shear = np.degrees(np.arcsin((warp * weft).sum(axis=1)))
            miss = shear - sphere_shear_at(*trimmed.at.mean(axis=1).T, RADIUS)
            for kind, kept in squares.items():
                kept.append(miss[trimmed.kind == kind] ** 2)
        for kind, kept in squares.items():
            found[kind].append(np.sqrt(np.mean(np.concatenate(kept))))
    return found


def test_the_shear_of_facets_in_the_strip_converges_at_second_order(misses):
    rms = np.array(misses[BEYOND])
    assert np.polyfit(np.log([1 / 4, 1 / 8, 1 / 16]), np.log(rms[:3]), 1)[0] > 1.8
    assert rms[-1] < 0.04  # the facets themselves are 2 mm long


def test_the_shear_of_facets_in_the_net_is_no_worse_near_its_last_cells(misses):
    rms = np.array(misses[BY_NET])
    assert np.polyfit(np.log([1 / 4, 1 / 8, 1 / 16]), np.log(rms[:3]), 1)[0] > 1.8
    assert rms[-1] < 0.02  # the facets themselves are 2 mm long
