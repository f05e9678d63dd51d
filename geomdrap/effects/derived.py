"""Surfaces made from others, kept as long as those: a fit drapes on the same few again and again."""

from __future__ import annotations

from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

if TYPE_CHECKING:
    from collections.abc import Callable

    from geomdrap.surface import Surface

KEPT = 4  # of each surface
_MADE: WeakKeyDictionary[Surface, dict[tuple[str, float], Surface]] = WeakKeyDictionary()


def derived(surface: Surface, effect: str, value: float, make: Callable[[], Surface]) -> Surface:
    """What ``make`` gives for this surface, effect and value; made anew only if it was not among the last few."""
    made = _MADE.setdefault(surface, {})
    key = (effect, value)
    found = made.pop(key) if key in made else make()
    if found is not surface:  # which would keep itself alive
        made[key] = found
    while len(made) > KEPT:
        del made[next(iter(made))]
    return found
