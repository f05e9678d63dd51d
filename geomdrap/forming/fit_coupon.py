"""Fit the cloth of a test specimen to its measured curves, and say which further test would tell more."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError
from geomdrap.forming.cloth import Cloth, changed
from geomdrap.forming.coupon import Coupon, bias_extension, biaxial, picture_frame, uniaxial, usual_displacement
from geomdrap.forming.held import Held
from geomdrap.forming.identify import Curves, Identified, identify, slopes_of, with_more

Array = NDArray[np.float64]

TESTS = ("uniaxial", "bias-extension", "picture-frame", "biaxial")
UNITS = {
    "fibre-modulus": "MPa",
    "warp-modulus": "MPa",
    "weft-modulus": "MPa",
    "resin-modulus": "MPa",
    "undulation": "",
}
PARAMETERS = {
    "uniaxial": ("fibre-modulus", "undulation", "resin-modulus"),
    "bias-extension": ("fibre-modulus", "resin-modulus"),
    "picture-frame": ("resin-modulus",),
    "biaxial": ("warp-modulus", "weft-modulus", "undulation", "resin-modulus"),
}
"""What each test can show, and what is fitted unless told otherwise."""
FURTHER: dict[str, tuple[tuple[str, dict[str, Any]], ...]] = {
    "uniaxial": tuple((f"uniaxial at {a:g} degrees", {"angle": a}) for a in (0.0, 15.0, 30.0, 45.0)),
    "bias-extension": (),
    "picture-frame": (),
    "biaxial": tuple((f"biaxial at a ratio of {r:g}", {"ratio": r}) for r in (0.0, 0.5, 2.0)),
}
"""Tests that may be made on top: their name, and the setting that differs."""
CELLS = 10
"""Cells across in the runs of a fit: four times faster than the usual mesh, and forces within a percent of it."""
BEYOND = 1.0 + 1e-9
"""Runs go so far beyond the last reading, since rounding must not leave it outside of them."""


@dataclass(frozen=True, eq=False)
class Advice:
    """A further test and the standard deviations (k,) that the parameters would then have."""

    test: str
    sigma: Array


@dataclass(frozen=True, eq=False)
class CouponFit:
    """A fitted test: ``measured`` and ``fitted`` columns at ``displacement`` (n,) mm, and the parameters."""

    test: str
    cloth: Cloth
    displacement: Array
    measured: dict[str, Array]
    fitted: dict[str, Array]
    identified: Identified
    advice: tuple[Advice, ...]


def fit_coupon(
    test: str,
    readings: Mapping[str, Array],
    cloth: Cloth,
    settings: Mapping[str, Any] | None = None,
    names: tuple[str, ...] | None = None,
    progress: Callable[[int], None] | None = None,
) -> CouponFit:
    """Fit ``names`` of ``cloth`` to ``readings`` (see `read_test`, one series) of ``test``.

    ``settings`` are those of the test (angle, speed, length, …), ``names`` None: what the test and its readings can
    show. FormingError where the readings do not suit the test, or a parameter is not one that it shows.
    """
    measured = _usable(test, readings)
    chosen = names or _shown(test, measured)
    _check_names(test, chosen, measured)
    displacement = readings["displacement"]
    start = {name: _start(cloth, name) for name in chosen}

    def simulation(values: Mapping[str, float], **other: Any) -> Callable[[dict[str, float]], Curves]:
        asked = {**_usual(test), **dict(settings or {}), **other}
        held = Held(test, asked, with_values(cloth, values))
        where = _reached(displacement, asked) if "angle" in other else displacement
        return lambda v: _held_run(held, with_values(cloth, v), where, tuple(measured))

    found = identify(simulation(start), measured, start, progress)
    advice = _advice(test, found, simulation, dict(settings or {}))
    values = dict(zip(found.names, found.values.tolist(), strict=True))
    return CouponFit(test, with_values(cloth, values), displacement, measured, dict(found.curves), found, advice)


def _held_run(held: Held, cloth: Cloth, displacement: Array, columns: tuple[str, ...]) -> Curves:
    """Columns of a run with masses and steps held; NaN for a cloth that is out of all proportion."""
    if not held.takes(cloth):
        return {c: np.full(len(displacement), np.nan) for c in columns}
    return predict(held.test, cloth, held.settings, displacement, columns)


def _reached(displacement: Array, settings: Mapping[str, Any]) -> Array:
    """Displacements (n,) mm at another angle: no further than a single run goes, or yarns would break."""
    usual = {key: settings[key] for key in ("length", "width") if key in settings}
    furthest = usual_displacement(settings["angle"], **usual)
    return np.asarray(displacement * min(1.0, furthest / float(displacement.max())))


def _usable(test: str, readings: Mapping[str, Array]) -> dict[str, Array]:
    """The columns that the test gives."""
    if test not in TESTS:
        raise FormingError(f"there is no test '{test}'; choose {', '.join(TESTS)}")
    gives: tuple[str, ...] = ("force_warp", "force_weft") if test == "biaxial" else ("force", "shear")
    if test == "picture-frame":
        gives = ("force",)  # its shear is that of the frame
    found = {c: readings[c] for c in gives if c in readings and np.any(np.isfinite(readings[c]))}
    if not found:
        raise FormingError(f"a {test} test is fitted by {' or '.join(gives)}; the table has none of them")
    return found


def _shown(test: str, measured: Mapping[str, Array]) -> tuple[str, ...]:
    """What the readings can show: shear alone depends only on how much stiffer the yarns are than the resin."""
    forces = [c for c in measured if c != "shear"]
    return PARAMETERS[test] if forces else ("fibre-modulus",)


def _check_names(test: str, names: tuple[str, ...], measured: Mapping[str, Array]) -> None:
    able = (*PARAMETERS[test], "undulation") if test == "bias-extension" else PARAMETERS[test]
    for name in names:
        if name not in able:
            raise FormingError(f"a {test} test does not show {name}; choose from {', '.join(able)}")
    if set(measured) == {"shear"} and {"fibre-modulus", "resin-modulus"} <= set(names):
        raise FormingError("shear alone shows only the ratio of fibre-modulus to resin-modulus; fit one of them")


def _start(cloth: Cloth, name: str) -> float:
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


def predict(
    test: str, cloth: Cloth, settings: Mapping[str, Any], displacement: Array, columns: tuple[str, ...]
) -> dict[str, Array]:
    """Columns (n,) of a simulated test at ``displacement`` (n,) mm; NaN beyond where it stopped."""
    from scipy.interpolate import CubicSpline

    furthest = float(np.max(displacement)) * BEYOND
    pulled = _simulated(test, cloth, settings, furthest).result
    given = {**pulled.forces, "shear": pulled.shear}
    if len(pulled.displacement) < 2:
        return {c: np.full(len(displacement), np.nan) for c in columns}
    return {
        c: np.asarray(CubicSpline(pulled.displacement, given[c], extrapolate=False)(displacement)) for c in columns
    }


def _simulated(test: str, cloth: Cloth, settings: Mapping[str, Any], furthest: float) -> Coupon:
    if test == "picture-frame":
        side = settings.get("side", 100.0)
        last = 90.0 - 2.0 * np.rad2deg(np.arccos(min(0.5 * furthest / side + np.sqrt(0.5), 1.0 - 1e-9)))
        asked = {**settings, "shear": np.linspace(last / 40.0, last, 40).tolist(), "steps": 800}
        return picture_frame(cloth, **asked)
    asked = {**settings, "displacement": furthest}
    if test == "biaxial":
        return biaxial(cloth, **asked)
    asked = {**_usual(test), **asked}
    return uniaxial(cloth, **asked) if test == "uniaxial" else bias_extension(cloth, **asked)


def _usual(test: str) -> dict[str, Any]:
    """Settings of the runs of a fit, where they are not those of a single run."""
    return {"cells": CELLS} if test in ("uniaxial", "bias-extension") else {}


def _advice(
    test: str, found: Identified, simulation: Callable[..., Any], settings: dict[str, Any]
) -> tuple[Advice, ...]:
    """What each further test would add, if some parameters are loose or confounded."""
    if not (found.loose or found.confounded):
        return ()
    scatter = float(np.mean(list(found.scatter.values())))
    given = []
    for name, other in FURTHER[test]:
        if all(settings.get(k) == v for k, v in other.items()):
            continue
        runs = simulation(dict(zip(found.names, found.values.tolist(), strict=True)), **other)
        given.append(Advice(name, with_more(found, slopes_of(runs, found, scatter))))
    return tuple(given)
