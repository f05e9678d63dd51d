"""What all tests share: this folder is on the path, so that ``made_parts`` can be imported."""

import pytest


@pytest.fixture(autouse=True)
def effects_of_a_test_end_with_it():
    """Effects that a test registers or loads from a plugin are not known to the next one."""
    from geomdrap.effects import registry

    before = dict(registry._REGISTERED)
    yield
    registry._REGISTERED.clear()
    registry._REGISTERED.update(before)
