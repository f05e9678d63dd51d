"""Results that are costly to make, kept up to a number."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

Key = TypeVar("Key")
Value = TypeVar("Value")


def kept(store: dict[Key, Value], key: Key, make: Callable[[], Value], most: int) -> Value:
    """An entry of ``store``, made if it is not there; the one asked for longest ago goes where there are more.

    A cache on methods would hold its object in a circle, and gigabytes with it until that is looked for.
    """
    value = store.pop(key) if key in store else make()
    store[key] = value
    while len(store) > most:
        del store[next(iter(store))]
    return value
