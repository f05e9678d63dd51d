"""Several starts: a fit finds the better of two minima from a start near the other, and says where they are alike."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import pytest

from geomdrap.forming.further import further_tests
from geomdrap.forming.identify import Curves, identify
from geomdrap.forming.parameters import fitted_names
from geomdrap.forming.starts import SPREAD, are_alike, are_apart, cost, minima, scattered

X = np.linspace(1.0, 3.0, 30)
WRONG = 8.0


def _two_valleys(depth: float) -> Callable[[Mapping[str, float]], Callable[[dict[str, float]], Curves]]:
    """A model with a minimum at a = 1, and one at a = `WRONG` that is ``depth`` worse; a crest lies between them."""

    def simulate(p: dict[str, float]) -> Curves:
        z = np.log(p["a"])
        second = np.log(WRONG)
        off = z if z < 0.5 * second else z - second
        return {"force": 5.0 * X * (1.0 + off) * (1.0 + (depth if z >= 0.5 * second else 0.0) * np.sin(40.0 * X))}

    return lambda _: simulate


def _noisy(share: float = 0.01) -> dict[str, np.ndarray]:
    return {"force": 5.0 * X * (1.0 + share * np.random.default_rng(1).normal(size=len(X)))}


def test_starts_lie_within_their_spread_and_in_all_corners_of_it() -> None:
    start = {"a": 3.0, "b": 0.01}
    logs = np.array([[np.log(v[n] / start[n]) / np.log(SPREAD) for n in start] for v in scattered(start)])
    assert np.abs(logs).max() <= 1.0
    for corner in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        assert np.any(np.all(logs * corner > 0.2, axis=1))


@pytest.mark.parametrize("begin", [0.7, 1.0, 4.0, 8.0])
def test_the_better_of_two_minima_comes_first_whichever_the_start_is_nearer_to(begin: float) -> None:
    model, measured = _two_valleys(0.3), _noisy()
    found = minima(model, measured, {"a": begin})
    assert found[0]["a"] == pytest.approx(1.0, abs=0.02)
    assert len(found) == 1  # the other costs more than a rival may
    if begin > 3.0:
        alone = identify(model({}), measured, {"a": begin})
        assert alone.values[0] == pytest.approx(WRONG, rel=0.2)  # a single fit is caught there


def test_minima_that_fit_alike_are_both_kept_and_called_alike() -> None:
    model, measured = _two_valleys(0.0), _noisy()
    first, second = (identify(model({}), measured, {"a": a}) for a in (1.0, WRONG))
    assert are_apart(first, second)
    assert are_alike(first, second, measured)
    worse = identify(_two_valleys(0.05)({}), measured, {"a": WRONG})
    assert cost(worse.curves, measured) > 3.0 * cost(first.curves, measured)
    assert not are_alike(first, worse, measured)
    assert not are_alike(first, identify(model({}), measured, {"a": 1.1}), measured)  # the same minimum


def test_moduli_are_brought_to_the_level_of_the_forces() -> None:
    """Starts a thousand times too soft: the level is found at once, since forces go with it."""

    def simulate(p: dict[str, float]) -> Curves:
        return {"force": p["fibre-modulus"] * X**2 + p["resin-modulus"] * X}

    measured = simulate({"fibre-modulus": 4000.0, "resin-modulus": 9000.0})
    found = minima(lambda _: simulate, measured, {"fibre-modulus": 5.0, "resin-modulus": 5.0})
    assert found[0] == pytest.approx({"fibre-modulus": 4000.0, "resin-modulus": 9000.0}, rel=0.02)


def test_a_further_test_is_none_of_those_that_were_made() -> None:
    assert [other for _, other in further_tests([("uniaxial", {}), ("uniaxial", {"angle": 0.0})])] == [
        ("uniaxial", {"angle": 15.0}),
        ("uniaxial", {"angle": 30.0}),
    ]
    assert (1, ("biaxial", {"ratio": 0.5})) in further_tests([("bias-extension", {}), ("biaxial", {})])
    assert further_tests([("picture-frame", {})]) == []


def test_what_is_fitted_to_several_tests_is_what_any_of_them_shows() -> None:
    strip, shear, knit = ("uniaxial", ["force"]), ("bias-extension", ["shear"]), ("biaxial", ["force_warp"])
    assert fitted_names([strip, strip], None) == ("fibre-modulus", "undulation", "resin-modulus")
    assert fitted_names([shear], None) == ("fibre-modulus",)
    assert fitted_names([shear, ("picture-frame", ["force"])], None) == ("fibre-modulus", "resin-modulus")
    assert fitted_names([strip, knit], None) == ("warp-modulus", "weft-modulus", "undulation", "resin-modulus")
    assert fitted_names([("picture-frame", ["force"]), strip], ("undulation",)) == ("undulation",)
