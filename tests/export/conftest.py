"""One drape and one browser for the tests of report.html."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))  # exact_nets

from browser import Page, browser, chromium


@pytest.fixture(scope="session")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    """A page of a headless Chromium."""
    if chromium() is None:
        pytest.skip("no Chromium on this machine: install one (Debian: apt-get install chromium)")
    with browser(tmp_path_factory.mktemp("chromium")) as opened:
        yield opened
