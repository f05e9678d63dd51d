"""A net that never ends must end the test run, not stand for hours."""

import faulthandler

import pytest

PATIENCE = 300.0  # seconds; more than the kernels need to be compiled


@pytest.fixture(autouse=True)
def _ends():
    faulthandler.dump_traceback_later(PATIENCE, exit=True)
    yield
    faulthandler.cancel_dump_traceback_later()
