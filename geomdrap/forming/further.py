"""Which further test would tell apart what the readings at hand do not."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.forming.coupon import usual_displacement
from geomdrap.forming.identify import Curves, Identified, slopes_of, with_more

Array = NDArray[np.float64]
Made = tuple[str, dict[str, Any]]
"""A test and its settings."""

UNNAMED = {"uniaxial": {"angle": 45.0}, "biaxial": {"ratio": 1.0}}
"""The settings that tell tests of a kind apart, where they are not named."""
_STRIPS: tuple[Made, ...] = tuple(("uniaxial", {"angle": a}) for a in (0.0, 15.0, 30.0, 45.0))
FURTHER: dict[str, tuple[Made, ...]] = {
    "uniaxial": _STRIPS,
    "bias-extension": _STRIPS[:1],
    "picture-frame": (),
    "biaxial": tuple(("biaxial", {"ratio": r}) for r in (0.0, 0.5, 2.0)),
}
"""Tests that may be made on top of each."""


@dataclass(frozen=True, eq=False)
class Advice:
    """A further test with the ``settings`` that differ, and the deviations (k,) that the parameters would have."""

    test: str
    settings: dict[str, Any]
    sigma: Array

    @property
    def name(self) -> str:
        """The test in words."""
        words = {"angle": "at {:g} degrees", "ratio": "at a ratio of {:g}"}
        return " ".join([self.test, *(words[k].format(v) for k, v in self.settings.items())])


def further_tests(made: Sequence[tuple[str, Mapping[str, Any]]]) -> list[tuple[int, Made]]:
    """Tests that are not among those ``made`` (name, settings), each with the number of the one that it adds to."""
    done = [(test, {k: settings.get(k, v) for k, v in UNNAMED.get(test, {}).items()}) for test, settings in made]
    found: list[tuple[int, Made]] = []
    for number, (test, _) in enumerate(made):
        found += [
            (number, other) for other in FURTHER[test] if other not in done and other not in [f for _, f in found]
        ]
    return found


def where_read(displacement: Array, test: str, settings: Mapping[str, Any]) -> Array:
    """Displacements (n,) mm of a further test: a strip goes no further than a single run, or yarns would break."""
    if test != "uniaxial":
        return displacement
    sizes = {key: settings[key] for key in ("length", "width") if key in settings}
    furthest = usual_displacement(settings["angle"], **sizes)
    return np.asarray(displacement * min(1.0, furthest / float(displacement.max())))


def advise(
    found: Identified,
    made: Sequence[tuple[str, Mapping[str, Any]]],
    simulate: Callable[[int, Made], Callable[[dict[str, float]], Curves]],
) -> tuple[Advice, ...]:
    """What each further test would add, if some parameters are loose or confounded.

    ``simulate`` makes the simulation of a further test from the number of the one that it adds to.
    """
    if not (found.loose or found.confounded):
        return ()
    scatter = float(np.mean(list(found.scatter.values())))
    return tuple(
        Advice(*other, with_more(found, slopes_of(simulate(number, other), found, scatter)))
        for number, other in further_tests(made)
    )
