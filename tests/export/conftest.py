"""A browser for the tests of report.html, and two plies for those of finite elements."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))  # exact_nets

from browser import Page, browser, chromium
from fe_plies import HEADING, RADIUS

import geomdrap as gd
from geomdrap.fields import Drape
from geomdrap.surface import shapes


@pytest.fixture(scope="session")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    """A page of a headless Chromium."""
    if chromium() is None:
        pytest.skip("no Chromium on this machine: install one (Debian: apt-get install chromium)")
    with browser(tmp_path_factory.mktemp("chromium")) as opened:
        yield opened


@pytest.fixture(scope="session")
def flat() -> Drape:
    """A plane sheet, 200 × 160 mm, warp at 25°: every number is known."""
    return gd.evaluate(gd.drape(shapes.plane(200.0, 160.0, 8.0), (0, 0, 0), HEADING, 10.0, project=True))


@pytest.fixture(scope="session")
def cap() -> Drape:
    """A cap of a sphere, draped from its pole, warp at 25°."""
    surface = shapes.sphere_cap(RADIUS, 50.0, 4.0)
    return gd.evaluate(gd.drape(surface, (0, 0, RADIUS), HEADING, 4.0, project=True))
