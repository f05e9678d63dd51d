"""Sides that pivot at a vertex of negative deficit: no node in the middle of a saddle is missing."""

import importlib

import numpy as np
import pytest
from made_parts import bumpy_sheet
from retraced import side_misses

import geomdrap as gd
from geomdrap.fishnet import Status
from geomdrap.fishnet.grid import STATUS
from geomdrap.surface import Surface, shapes

SADDLE = shapes.saddle(200.0, 240.0, 2.5)


@pytest.fixture
def not_closed(monkeypatch):
    """Nodes that the quadrants of the seed could not close, counted before other yarns fill their places."""
    module = importlib.import_module("geomdrap.fishnet.drape")
    counts, carry_on = [], module.carry_front_on

    def count(mesh, grid, i0, j0):
        counts.append(int((grid.marks[..., STATUS] == Status.NOT_CLOSED).sum()))
        return carry_on(mesh, grid, i0, j0)

    monkeypatch.setattr(module, "carry_front_on", count)
    return counts


@pytest.mark.parametrize("pitch", [0.7, 1.25])
def test_on_a_saddle_every_cell_closes_where_the_pitch_is_below_the_facets(not_closed, pitch):
    gd.drape(SADDLE, (-15.0, 22.0, 0.0), 75.0, pitch, project=True)
    assert sum(not_closed) == 0


def test_on_random_bumps_every_cell_closes(not_closed):
    rng = np.random.default_rng(4)
    for n in range(10):
        part = bumpy_sheet(n, 24, 100.0, 25.0, 0.3)
        gd.drape(part, (*rng.uniform(-30.0, 30.0, 2), 0.0), rng.uniform(0.0, 360.0), 1.5, project=True)
    assert sum(not_closed) == 0


def saddle_cone(sectors=8, rise=0.6, radius=50.0):
    """A fan about the origin whose rim goes up and down: more than 360 degrees of faces, all in one vertex."""
    turn = 2.0 * np.pi * np.arange(sectors) / sectors
    rim = radius * np.stack([np.cos(turn), np.sin(turn), rise * (-1.0) ** np.arange(sectors)], axis=1)
    return Surface(np.vstack([np.zeros((1, 3)), rim]), np.array([(0, 1 + k, 1 + (k + 1) % sectors) for k in range(sectors)]))


@pytest.mark.parametrize("angle", [0.0, 20.0, 70.0])
def test_sides_behind_a_vertex_of_negative_deficit_have_their_length(angle):
    part = saddle_cone()
    assert part.deficits[0] < -0.3
    net = gd.drape(part, (-11.3, -8.1, 0.0), angle, 3.1, (25.0, 25.0), project=True)
    near = np.linalg.norm(net.points, axis=2) < 15.0
    assert near.sum() > 40
    assert (net.status != Status.NOT_CLOSED).all()
    assert side_misses(net).max() < 1e-5 * net.pitch
