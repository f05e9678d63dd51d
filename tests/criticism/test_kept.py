"""What is costly to make is made once while it is in use."""

from __future__ import annotations

from geomdrap.criticism.kept import kept


def test_what_was_asked_for_longest_ago_goes_first():
    store: dict[str, int] = {}
    made = []
    for key in "abacab":  # a is in use throughout
        assert kept(store, key, lambda key=key: made.append(key) or ord(key), 2) == ord(key)
    assert made == ["a", "b", "c", "b"]
    assert set(store) == {"a", "b"}
