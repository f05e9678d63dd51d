"""T1: the law of the undulated yarn, in closed form, compiled, and in energy."""

from __future__ import annotations

import numpy as np
import pytest
from laws import yarns_alone
from scipy.integrate import quad

from geomdrap.forming import Fibre, fibre_law, make_model, start
from geomdrap.forming.ledger import fibre_energy
from geomdrap.forming.sheet import rectangle
from geomdrap.forming.state import add_forces

TABLE = {0.001: 12.17, 0.005: 239.12, 0.01: 737.97, 0.02: 1961.91, 0.03: 3251.61}
STRAINS = np.array([-0.4, -0.02, -1e-5, 0.0, 1e-6, 1e-4, 0.001, 0.005, 0.02, 0.1, 0.5])


@pytest.mark.parametrize(("strain", "stress"), TABLE.items())
def test_stress_has_the_tabulated_values(strain: float, stress: float) -> None:
    assert fibre_law.stress(Fibre(), np.array([strain]))[0] == pytest.approx(stress, abs=0.005)


@pytest.mark.parametrize("undulation", [0.0, 0.005, 0.2])
def test_the_compiled_force_is_the_closed_form(undulation: float) -> None:
    fibre = Fibre(undulation=undulation)
    model = make_model(rectangle(1, 1, 10.0), yarns_alone(fibre))
    state = start(model)
    section = model.section[0]
    for strain in STRAINS:
        state.x[:] = (model.sheet.points * [np.exp(strain), 1.0, 1.0]).ravel()
        add_forces(model, state)
        pull = -(state.f.reshape(-1, 3)[2:, 0].sum()) / 2.0
        exact = section * fibre_law.stress(fibre, np.array([strain]))[0]
        assert pull == pytest.approx(exact, rel=1e-12, abs=1e-12 * section * fibre.modulus * 0.005)


def test_the_tangent_is_the_slope_of_the_stress_and_vanishes_where_an_undulated_yarn_is_slack() -> None:
    fibre, strain, h = Fibre(), np.array([-0.01, 0.0005, 0.004, 0.05]), 1e-7
    slope = (fibre_law.stress(fibre, strain + h) - fibre_law.stress(fibre, strain - h)) / (2 * h)
    assert fibre_law.tangent(fibre, strain) == pytest.approx(slope, rel=1e-6)
    assert fibre_law.tangent(fibre, np.array([0.0]))[0] == 0.0
    assert fibre_law.tangent(fibre, np.array([0.1]))[0] == pytest.approx(fibre.modulus, rel=1e-8)


def test_an_undulated_yarn_lags_behind_a_straight_one_by_its_undulation() -> None:
    late, straight = Fibre(undulation=0.005), Fibre(undulation=0.0)
    strain = np.array([0.2])
    assert fibre_law.stress(late, strain) == pytest.approx(fibre_law.stress(straight, strain - 0.005), rel=1e-12)


@pytest.mark.parametrize("strain", [-0.3, -0.001, 0.001, 0.005, 0.03, 0.4])
@pytest.mark.parametrize("undulation", [0.0, 0.005, 1.0])
def test_energy_is_the_work_of_the_force_along_the_length(strain: float, undulation: float) -> None:
    fibre = Fibre(undulation=undulation)
    work, _ = quad(
        lambda e: float(fibre_law.stress(fibre, np.array([e]))[0]) * np.exp(e), 0.0, strain, epsabs=0, epsrel=1e-13
    )
    energy = fibre_law.energy(fibre, np.array([strain]))[0]
    straight = fibre_law.energy(Fibre(undulation=0.0), np.array([strain]))[0]  # crimp is taken from it: rounding is its
    assert energy == pytest.approx(work, rel=1e-12, abs=1e-12 * straight)


def test_yarn_energy_of_a_sheet_counts_every_yarn_once() -> None:
    model = make_model(rectangle(3, 2, 10.0), yarns_alone(Fibre()))
    state = start(model)
    state.x[:] = (model.sheet.points * [np.exp(0.01), 1.0, 1.0]).ravel()
    volume_of_warp = 30.0 * 20.0 * 2.0 * 0.25
    assert fibre_energy(model, state) == pytest.approx(
        volume_of_warp * fibre_law.energy(Fibre(), np.array([0.01]))[0], rel=1e-12
    )
