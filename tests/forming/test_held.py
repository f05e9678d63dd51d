"""A fit runs all cloths with the same masses and steps, so that its cost is a smooth function of the parameters."""

from __future__ import annotations

import numpy as np
import pytest

from geomdrap.forming import Cloth, Resin
from geomdrap.forming.coupon import uniaxial
from geomdrap.forming.held import FINER, MARGIN, WILD, Held, stiffer, stiffer_of
from geomdrap.forming.identify import ResizedError, identify
from geomdrap.forming.parameters import with_values
from geomdrap.forming.simulated import predict

SMALL = {"cells": 4, "length": 60.0, "width": 30.0}


def _with_yarns(times: float, resin: float = 1.0) -> Cloth:
    return with_values(Cloth(), {"fibre-modulus": times * 130_000.0, "resin-modulus": resin * 45.0})


def test_cloths_up_to_the_margin_run_with_the_same_masses_and_steps() -> None:
    held = Held("uniaxial", SMALL, Cloth())
    models = []
    for times in (0.3, 1.0, 0.99 * MARGIN):
        cloth = _with_yarns(times, times)
        assert held.takes(cloth)
        models.append(uniaxial(cloth, displacement=1.0, frames=4, **held.settings).result.run.model)
    assert all(m.step == models[0].step and np.array_equal(m.mass, models[0].mass) for m in models)
    own = uniaxial(_with_yarns(0.3), displacement=1.0, frames=4, **SMALL).result.run.model
    assert own.mass.sum() != pytest.approx(models[0].mass.sum(), rel=0.1)


def test_a_stiffer_cloth_enlarges_what_is_held_and_then_runs() -> None:
    held = Held("uniaxial", SMALL, Cloth())
    before = held.stiffest
    with pytest.raises(ResizedError):
        held.takes(_with_yarns(1.1 * MARGIN, MARGIN))
    assert held.takes(_with_yarns(1.1 * MARGIN, MARGIN))
    assert held.takes(before)


def test_a_cloth_whose_resin_is_too_soft_for_the_steps_asks_for_more_of_them() -> None:
    held = Held("uniaxial", {**SMALL, "cells": 20}, Cloth())
    before = held.steps
    assert held.takes(_with_yarns(1.0, 1.01 / FINER**2))
    with pytest.raises(ResizedError):
        held.takes(_with_yarns(1.0, 0.9 / FINER**2))
    assert held.steps == pytest.approx(before * np.sqrt(FINER**2 / 0.9), rel=1e-3)


def test_steps_that_are_given_stay_and_a_cloth_out_of_all_proportion_is_not_run() -> None:
    held = Held("biaxial", {"cells": 4, "steps": 800}, Cloth())
    with pytest.raises(ResizedError):
        held.takes(_with_yarns(4.0, 0.01))
    assert held.steps == 800
    assert not held.takes(_with_yarns(4.1 * MARGIN * WILD))
    assert Held("picture-frame", {}, Cloth()).settings == {}


def test_the_stiffer_of_two_cloths_has_the_larger_of_each_modulus() -> None:
    a, b = Cloth(resin=Resin(modulus=10.0)), stiffer(Cloth(resin=Resin(modulus=90.0)), 0.5)
    both = stiffer_of(a, b)
    assert (both.warp.modulus, both.weft.modulus, both.resin.modulus) == (130_000.0, 130_000.0, 45.0)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["fibre-modulus", "resin-modulus"])
def test_the_cost_along_a_parameter_is_smooth_in_steps_of_a_thousandth(name: str) -> None:
    """Its second differences are one number, to a hundredth: with sizes of their own they differ by more than it."""
    d, settings = np.linspace(1.25, 50.0, 40), {"cells": 6}
    truth = {"fibre-modulus": 130_000.0, "undulation": 0.005, "resin-modulus": 45.0}
    held = Held("uniaxial", settings, with_values(Cloth(), {**truth, "fibre-modulus": 90_000.0})).settings
    force = predict("uniaxial", Cloth(), settings, d, ("force",))["force"]
    noisy = force * (1.0 + 0.01 * np.random.default_rng(0).normal(size=40))

    def cost(shift: float) -> float:
        cloth = with_values(Cloth(), {**truth, name: truth[name] * np.exp(shift)})
        run = predict("uniaxial", cloth, held, d, ("force",))["force"]
        return float(np.sum(((run - noisy) / np.maximum(noisy, 0.01 * noisy.max())) ** 2))

    second = np.diff([cost(0.05 + 1e-3 * k) for k in range(9)], 2)
    assert np.std(second) < 0.01 * np.mean(second)


def test_a_fit_whose_simulation_was_resized_starts_over_from_the_best_and_says_so() -> None:
    x, calls, size = np.arange(1.0, 30.0), [], [2.0]
    noisy = {"force": 6.0 * x**0.7 * (1.0 + 0.01 * np.random.default_rng(0).normal(size=len(x)))}

    def simulate(p: dict[str, float]) -> dict[str, np.ndarray]:
        if p["a"] > size[0]:
            size[0] = 2.0 * p["a"]
            raise ResizedError
        calls.append((size[0], p["a"]))
        return {"force": (1.0 + 1e-3 * size[0]) * p["a"] * x ** p["b"]}

    found = identify(simulate, noisy, {"a": 1.0, "b": 2.0})
    assert found.converged
    assert found.resized == len({s for s, _ in calls}) - 1 > 0
    assert found.runs == len(calls)
    again = identify(lambda p: {"force": (1.0 + 1e-3 * size[0]) * p["a"] * x ** p["b"]}, noisy, {"a": 1.0, "b": 2.0})
    assert found.values == pytest.approx(again.values, rel=1e-3)
    for smaller, larger in zip(sorted({s for s, _ in calls}), sorted({s for s, _ in calls})[1:], strict=False):
        assert next(a for s, a in calls if s == larger) in [a for s, a in calls if s == smaller]
