"""T2 and the readings of Table 1: Prony series in closed form, and in the elements."""

from __future__ import annotations

import numpy as np
import pytest
from laws import NO_YARNS

from geomdrap.forming import RELAXATIONS, Cloth, Relaxation, Resin, make_model, rectangle, start
from geomdrap.forming.ledger import resin_energy, resin_loss
from geomdrap.forming.membrane import WIDTH
from geomdrap.forming.state import add_forces

TABLE = RELAXATIONS["table"]
SHEAR = 0.02


def _sheared(points: np.ndarray, angle: float) -> np.ndarray:
    """Trellis shear: sides keep their length; symmetric about the diagonal, so that nothing turns."""
    c, s = np.cos(0.5 * angle), np.sin(0.5 * angle)
    return points @ np.array([[c, s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _stress(state: object) -> float:
    """Shear stress T12 of the first triangle: what lasts of the elastic one, and the terms."""
    history = state.history[0].reshape(-1, 3, WIDTH)  # type: ignore[attr-defined]
    return TABLE.remaining * history[0, 1, 0] + history[2:, 1, 0].sum()


def _model(step: float) -> tuple:
    model = make_model(rectangle(1, 1, 10.0), Cloth(NO_YARNS, NO_YARNS, Resin()), step)
    return model, start(model)


@pytest.mark.parametrize(
    ("time", "left"), [(0.01, 0.9821), (0.1, 0.9527), (1, 0.8878), (10, 0.7802), (100, 0.6445), (1000, 0.4959)]
)
def test_the_table_relaxes_as_tabulated(time: float, left: float) -> None:
    assert TABLE.at(time) == pytest.approx(left, abs=5e-5)


def test_stress_after_a_steady_ramp_is_exact_at_every_step() -> None:
    step = 0.37
    model, state = _model(step)
    elastic: list[float] = []
    for n in range(1, 40):
        # Hencky strain that grows evenly: its 12 is half the logarithm of (1 + s)/(1 - s) over two
        angle = np.arcsin(np.tanh(2.0 * SHEAR * n * step / 15.0))
        state.x[:] = _sheared(model.sheet.points, angle).ravel()
        add_forces(model, state)
        elastic.append(state.history[0].reshape(-1, 3, WIDTH)[0, 1, 0])
        rate = elastic[0] / step
        assert _stress(state) == pytest.approx(rate * TABLE.after_ramp(n * step), rel=1e-12)
    assert np.allclose(np.diff(elastic), rate * step, rtol=1e-11)


def test_stress_after_a_sudden_strain_relaxes_exactly() -> None:
    step = 0.37
    model, state = _model(step)
    state.x[:] = _sheared(model.sheet.points, 0.3).ravel()
    add_forces(model, state)
    first = _stress(state) / (TABLE.after_ramp(step) / step)  # the strain came evenly within the first step
    for n in range(1, 30):
        add_forces(model, state)
        exact = first * (TABLE.after_ramp((n + 1) * step) - TABLE.after_ramp(n * step)) / step
        assert _stress(state) == pytest.approx(exact, rel=1e-12)


def test_what_the_resin_loses_at_rest_is_what_it_dissipates() -> None:
    step = 0.001
    model, state = _model(step)
    state.x[:] = _sheared(model.sheet.points, 0.3).ravel()
    add_forces(model, state)
    before, lost, rate = resin_energy(model, state), 0.0, resin_loss(model, state)
    for _ in range(500):
        add_forces(model, state)
        now = resin_loss(model, state)
        lost, rate = lost + 0.5 * step * (rate + now), now
    assert before - resin_energy(model, state) == pytest.approx(lost, rel=2e-3)


def test_the_ratio_of_speeds_is_that_of_the_steady_ramp() -> None:
    """T3 without a mesh: forces at 20, 40 and 80 mm/min go as the mean relaxation up to the time of the reading."""
    for displacement, ratio in ((3.0, 1.069), (12.0, 1.095), (30.0, 1.108)):
        slow, fast = 60.0 * displacement / 20.0, 60.0 * displacement / 80.0
        assert 4.0 * TABLE.after_ramp(fast) / TABLE.after_ramp(slow) == pytest.approx(ratio, abs=0.0006)


def test_the_creep_reading_is_the_inverse_of_its_compliance() -> None:
    """∫ E(t − s) dJ(s) = 1 for the samples of Table 1, taken straight in ln t between them."""
    from geomdrap.forming.relaxation import TABLE_SHARES, TABLE_TIMES

    creep, modulus = RELAXATIONS["creep"], 1.0 / TABLE_SHARES[0]
    knots = np.log(TABLE_TIMES)
    for time, misfit in (
        (0.1, 0.334),
        (0.2, 0.17),
        (0.3, 0.17),
        (1.0, 0.07),
        (1.5, 0.07),
        (3.0, 0.033),
        (30.0, 0.033),
        (300.0, 0.033),
    ):
        s = np.concatenate([[0.0], np.geomspace(TABLE_TIMES[0], time, 20001)])
        compliance = np.interp(np.log(np.maximum(s, TABLE_TIMES[0])), knots, TABLE_SHARES)
        middle = 0.5 * (s[1:] + s[:-1])
        total = modulus * (creep.at(time) * compliance[0] + np.sum(creep.at(time - middle) * np.diff(compliance)))
        assert total == pytest.approx(1.0, abs=misfit)


@pytest.mark.parametrize(("displacement", "ratio"), [(3.0, 1.26), (12.0, 1.19), (30.0, 1.15)])
def test_the_creep_reading_shows_the_speed_most_at_first(displacement: float, ratio: float) -> None:
    creep = RELAXATIONS["creep"]
    slow, fast = 60.0 * displacement / 20.0, 60.0 * displacement / 80.0
    assert 4.0 * creep.after_ramp(fast) / creep.after_ramp(slow) == pytest.approx(ratio, rel=0.1)


def test_a_relaxation_is_never_below_what_lasts_and_never_rises() -> None:
    times = np.geomspace(1e-4, 1e5, 200)
    for relaxation in RELAXATIONS.values():
        left = relaxation.at(times)
        assert np.all(np.diff(left) <= 1e-15)
        assert np.all(left >= relaxation.remaining - 1e-15)


def test_factors_of_a_step_add_up_over_two_half_steps() -> None:
    r = Relaxation((0.3, 0.2), (0.5, 7.0))
    (keep, take), (half_keep, half_take) = r.factors(0.4), r.factors(0.2)
    assert keep == pytest.approx(half_keep**2, rel=1e-14)
    assert take == pytest.approx(0.5 * half_take * (1.0 + half_keep), rel=1e-13)
