"""Parameters of a cloth by name: which of them a test shows, where a fit of them starts, a cloth with other ones."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from geomdrap.errors import FormingError
from geomdrap.forming.cloth import Cloth, changed

TESTS = ("uniaxial", "bias-extension", "picture-frame", "biaxial")
UNITS = {
    "fibre-modulus": "MPa",
    "warp-modulus": "MPa",
    "weft-modulus": "MPa",
    "undulation": "",
    "resin-modulus": "MPa",
}
"""All parameters, in the order in which they are told."""
PARAMETERS = {
    "uniaxial": ("fibre-modulus", "undulation", "resin-modulus"),
    "bias-extension": ("fibre-modulus", "resin-modulus"),
    "picture-frame": ("resin-modulus",),
    "biaxial": ("warp-modulus", "weft-modulus", "undulation", "resin-modulus"),
}
"""What each test can show, and what is fitted unless told otherwise."""
SIDES = ("warp-modulus", "weft-modulus")
ABLE = {
    **PARAMETERS,
    "uniaxial": (*PARAMETERS["uniaxial"], *SIDES),
    "bias-extension": ("fibre-modulus", "undulation", "resin-modulus"),
}
"""What can be fitted to each test where it is asked for."""


def fitted_names(tests: Sequence[tuple[str, Iterable[str]]], asked: tuple[str, ...] | None) -> tuple[str, ...]:
    """The parameters that are fitted to ``tests`` (name, columns), those ``asked`` for or what all of them show.

    FormingError where one that is asked for is shown by none of the tests, or cannot be told from another.
    """
    only_shear = all(set(columns) == {"shear"} for _, columns in tests)
    if asked is None:
        found = {name for test, columns in tests for name in _shown(test, columns)}
        if set(SIDES) <= found:
            found.discard("fibre-modulus")
        return tuple(name for name in UNITS if name in found)
    able = [name for name in UNITS if any(name in ABLE[test] for test, _ in tests)]
    for name in asked:
        if name not in able:
            many = " and ".join(dict.fromkeys(test for test, _ in tests))
            raise FormingError(f"a {many} test does not show {name}; choose from {', '.join(able)}")
    if only_shear and {"fibre-modulus", "resin-modulus"} <= set(asked):
        raise FormingError("shear alone shows only the ratio of fibre-modulus to resin-modulus; fit one of them")
    if "fibre-modulus" in asked and set(SIDES) & set(asked):
        raise FormingError("fibre-modulus is that of warp and weft; fit it, or warp-modulus and weft-modulus")
    return asked


def _shown(test: str, columns: Iterable[str]) -> tuple[str, ...]:
    """What readings can show: shear alone depends only on how much stiffer the yarns are than the resin."""
    return PARAMETERS[test] if set(columns) - {"shear"} else ("fibre-modulus",)


def start_of(cloth: Cloth, name: str) -> float:
    """The value of a parameter at which a fit starts; FormingError if it is 0."""
    values = {
        "fibre-modulus": cloth.warp.modulus,
        "warp-modulus": cloth.warp.modulus,
        "weft-modulus": cloth.weft.modulus,
        "resin-modulus": cloth.resin.modulus,
        "undulation": cloth.warp.undulation or 0.005,
    }
    if not values[name] > 0.0:
        raise FormingError(f"a fit of {name} must start above 0; got {values[name]:g}")
    return values[name]


def with_values(cloth: Cloth, values: Mapping[str, float]) -> Cloth:
    """``cloth`` with parameters by name."""
    both = {"undulation": values.get("undulation"), "modulus": values.get("fibre-modulus")}
    yarns = {side: changed(getattr(cloth, side), **{**both, **_own(values, side)}) for side in ("warp", "weft")}
    return changed(cloth, resin=changed(cloth.resin, modulus=values.get("resin-modulus")), **yarns)


def _own(values: Mapping[str, float], side: str) -> dict[str, float]:
    return {"modulus": values[f"{side}-modulus"]} if f"{side}-modulus" in values else {}
