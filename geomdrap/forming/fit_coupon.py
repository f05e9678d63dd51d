"""Fit the cloth of one or several test specimens to their measured curves, and say which further test would help."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError
from geomdrap.forming.cloth import Cloth
from geomdrap.forming.coupon import enough_steps
from geomdrap.forming.further import UNNAMED, Advice, Made, advise, where_read
from geomdrap.forming.held import Held, specimen_of
from geomdrap.forming.identify import Curves, Identified, Simulate, check_enough, identify
from geomdrap.forming.parameters import TESTS, fitted_names, start_of, with_values
from geomdrap.forming.simulated import held_run, usual
from geomdrap.forming.starts import are_alike, cost, minima

Array = NDArray[np.float64]
Say = Callable[[str], None]

COARSE = {"uniaxial": 4, "bias-extension": 4, "biaxial": 6}
"""Cells across in the runs that look for a start."""
HASTY, MOST = 0.5, 12_000
"""Their steps over those of a slow run, and the most of them: a per cent or so of the energy is kinetic then."""


@dataclass(frozen=True, eq=False)
class Measured:
    """A measured ``test``: ``readings`` by column (one series of `read_test`), ``settings`` that it was made with."""

    test: str
    readings: Mapping[str, Array]
    settings: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class FittedCurve:
    """A test of a fit: ``measured`` and ``fitted`` columns at ``displacement`` (n,) mm; ``rms`` of each column."""

    test: str
    settings: dict[str, Any]
    displacement: Array
    measured: dict[str, Array]
    fitted: dict[str, Array]
    rms: dict[str, float]

    @property
    def label(self) -> str:
        """The test in words."""
        units = {"angle": "{:g} deg", "ratio": "ratio {:g}"}
        shown = {k: self.settings.get(k, v) for k, v in UNNAMED.get(self.test, {}).items()}
        return ", ".join([self.test, *(units[k].format(v) for k, v in shown.items())])


@dataclass(frozen=True, eq=False)
class CouponFit:
    """Fitted tests: their ``curves``, the ``cloth`` and its ``identified`` parameters, further tests that would help.

    ``rivals``: other values that fit about as well, from other starts.
    """

    curves: tuple[FittedCurve, ...]
    cloth: Cloth
    identified: Identified
    advice: tuple[Advice, ...] = ()
    rivals: tuple[dict[str, float], ...] = ()


def fit_coupon(
    test: str,
    readings: Mapping[str, Array],
    cloth: Cloth,
    settings: Mapping[str, Any] | None = None,
    names: tuple[str, ...] | None = None,
    progress: Say | None = None,
) -> CouponFit:
    """Fit ``names`` of ``cloth`` to ``readings`` of one ``test``; see `fit_coupons`."""
    return fit_coupons([Measured(test, readings, settings or {})], cloth, names, progress)


def fit_coupons(
    tests: Sequence[Measured], cloth: Cloth, names: tuple[str, ...] | None = None, progress: Say | None = None
) -> CouponFit:
    """Fit ``names`` of one ``cloth`` to all ``tests`` at once.

    ``names`` None: what the tests and their readings can show. The fit starts at the best of what fits on a coarse
    mesh come to, from the given cloth and from places scattered about it. ``progress`` is told in words. FormingError
    where readings do not suit their test, or a parameter is not one that the tests show.
    """
    joint = _Joint(tests, cloth)
    chosen = fitted_names(
        [(t.test, columns) for t, columns in zip(joint.tests, joint.columns, strict=True)], names
    )
    start = {name: start_of(cloth, name) for name in chosen}
    check_enough(joint.measured, chosen)
    fits = [
        identify(joint.simulation(values), joint.measured, values, _counted(progress))
        for values in joint.starts(start, progress)
    ]
    fits.sort(key=lambda one: cost(one.curves, joint.measured))
    best, *others = fits
    rivals = tuple(other.named for other in others if are_alike(best, other, joint.measured))
    made = [(t.test, t.settings) for t in joint.tests]
    advice = advise(best, made, lambda number, other: joint.further(best, number, other))
    return CouponFit(joint.fitted(best), with_values(cloth, best.named), best, advice, rivals)


def _counted(progress: Say | None) -> Callable[[int], None] | None:
    return None if progress is None else (lambda runs: progress(f"{runs} runs"))


class _Joint:
    """Tests as one: the columns of the second and later ones are named with their number."""

    def __init__(self, tests: Sequence[Measured], cloth: Cloth):
        self.tests, self.cloth = list(tests), cloth
        usable = [_usable(t.test, t.readings) for t in tests]
        self.columns = [tuple(columns) for columns in usable]
        self.measured = {
            _key(c, number): v for number, columns in enumerate(usable) for c, v in columns.items()
        }

    def starts(self, start: Mapping[str, float], progress: Say | None) -> list[dict[str, float]]:
        """Where fits start: at minima of a coarse mesh, and at ``start`` alone where the tests have no mesh."""
        if all(t.test not in COARSE for t in self.tests):
            return [dict(start)]
        if progress:
            progress("looking for a start on a coarse mesh")
        return minima(lambda values: self.simulation(values, is_coarse=True), self.measured, start)

    def simulation(self, values: Mapping[str, float], is_coarse: bool = False) -> Simulate:
        """All tests with masses and steps that are held, at first for ``values``."""
        cloth = with_values(self.cloth, values)
        held = [Held(t.test, self._settings(t, cloth, is_coarse), cloth) for t in self.tests]

        def simulate(v: dict[str, float]) -> Curves:
            made = with_values(self.cloth, v)
            curves: dict[str, Array] = {}
            for number, (one, test) in enumerate(zip(held, self.tests, strict=True)):
                run = held_run(one, made, test.readings["displacement"], self.columns[number])
                curves |= {_key(c, number): values for c, values in run.items()}
            return curves

        return simulate

    def _settings(self, test: Measured, cloth: Cloth, is_coarse: bool) -> dict[str, Any]:
        asked = {**usual(test.test), **test.settings}
        if not is_coarse or test.test not in COARSE:
            return asked
        asked["cells"] = min(asked.get("cells", 20), COARSE[test.test])
        few = min(MOST, HASTY * enough_steps(specimen_of(test.test, asked, cloth)))
        asked["steps"] = int(min(asked.get("steps") or few, few))
        return asked

    def further(self, found: Identified, number: int, other: Made) -> Simulate:
        """The simulation of a further test, made as the test ``number`` was but for what differs."""
        test, differs = other
        asked = {**usual(test), **self.tests[number].settings, **differs}
        held = Held(test, asked, with_values(self.cloth, found.named))
        where = where_read(self.tests[number].readings["displacement"], test, asked)
        columns = ("force",) if test != "biaxial" else ("force_warp", "force_weft")
        return lambda v: held_run(held, with_values(self.cloth, v), where, columns)

    def fitted(self, found: Identified) -> tuple[FittedCurve, ...]:
        """Each test beside what was fitted to it."""
        return tuple(self._fitted(found, number) for number in range(len(self.tests)))

    def _fitted(self, found: Identified, number: int) -> FittedCurve:
        test, columns = self.tests[number], self.columns[number]
        measured, fitted = (
            {c: curves[_key(c, number)] for c in columns} for curves in (self.measured, found.curves)
        )
        rms = {c: found.rms[_key(c, number)] for c in columns}
        return FittedCurve(test.test, dict(test.settings), test.readings["displacement"], measured, fitted, rms)


def _key(column: str, number: int) -> str:
    return column if number == 0 else f"{column} {number + 1}"


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
