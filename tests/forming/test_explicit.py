"""T10, T11 and the kernel against numpy: stability, order, energy, momentum, positions."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from laws import STRAIGHT, resin_alone, yarns_alone
from numpy_step import NumpyStep

from geomdrap.errors import FormingError
from geomdrap.forming import ELASTIC, Cloth, Fibre, Resin, ledger_of, make_model, rectangle, start, take_steps

CLOTH = Cloth(STRAIGHT, STRAIGHT, Resin(relaxation=ELASTIC))


@pytest.mark.parametrize("diagonals", ["alternate", "both"])
def test_positions_are_those_of_the_numpy_version(diagonals: str) -> None:
    model = make_model(rectangle(9, 7, 10.0, diagonals), Cloth())
    velocity = np.random.default_rng(2).normal(0.0, 1500.0, model.sheet.points.shape)
    state, other = start(model, velocity), NumpyStep(model, velocity)
    take_steps(model, state, 50)
    for _ in range(50):
        other.step()
    assert np.abs(state.points - model.sheet.points).max() > 0.05
    assert state.points == pytest.approx(other.x, abs=1e-10)


def _bar(cells: int, share: float) -> tuple:
    """A bar of yarn pieces with fixed ends, at ``share`` of its limit 2/ω; its modes are known."""
    fibre = Fibre(modulus=1000.0, undulation=0.0, compression=1.0)
    sheet = rectangle(cells, 1, 10.0, "both")
    ends = np.flatnonzero((sheet.fabric[:, 0] == 0.0) | (sheet.fabric[:, 0] == 10.0 * cells))
    probe = make_model(sheet, yarns_alone(fibre), driven=list(ends))
    inner = probe.mass[2]
    stiffness = probe.section[probe.family == 0][0] * fibre.modulus / 10.0
    fastest = 2.0 * np.sqrt(stiffness / inner) * np.sin(0.5 * np.pi * (cells - 1) / cells)
    model = make_model(sheet, yarns_alone(fibre), share * 2.0 / fastest, list(ends), scale_mass=False, safety=1.0)
    return model, stiffness / inner


def _mode(model: object, cells: int, number: int) -> np.ndarray:
    along = model.sheet.fabric[:, 0] / 10.0  # type: ignore[attr-defined]
    return np.column_stack([np.sin(number * np.pi * along / cells), 0.0 * along, 0.0 * along])


@pytest.mark.parametrize(("share", "grows"), [(0.999, False), (1.001, True)])
def test_a_bar_is_stable_just_below_its_limit_and_not_just_above(
    share: float, grows: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("geomdrap.forming.model.stable_step", lambda *_: np.inf)  # the bound is safer than the limit
    model, _ = _bar(8, share)
    state = start(model, 1e-6 * _mode(model, 8, 7))
    take_steps(model, state, 2000)
    assert (np.abs(state.v).max() > 1e-4) == grows


@pytest.mark.parametrize("number", [1, 3, 7])
def test_the_modes_of_a_bar_have_the_frequencies_of_the_scheme(number: int) -> None:
    """ω_k = 2 √(k/m) sin(kπ/2N), and sin(ω_d Δt/2) = ω Δt/2."""
    model, ratio = _bar(8, 0.5)
    omega = 2.0 * np.sqrt(ratio) * np.sin(0.5 * np.pi * number / 8)
    discrete = 2.0 * np.arcsin(0.5 * omega * model.step) / model.step
    shape = _mode(model, 8, number)
    state, seen = start(model, 1e-4 * shape), []
    for _ in range(60):
        take_steps(model, state, 1)
        seen.append(float(np.sum((state.points - model.sheet.points) * shape) / np.sum(shape * shape)))
    steps = model.step * np.arange(1, 61)
    # half a step before the start the velocity was 1e-4: the displacement is a sine through the origin
    assert seen == pytest.approx(
        1e-4 * np.sin(discrete * steps) * model.step / np.sin(discrete * model.step), abs=1e-10
    )


def test_the_bound_is_below_the_limit_of_the_fastest_vibration() -> None:
    """Against the stiffness matrix by differences of the forces."""
    from geomdrap.forming.state import add_forces

    model = make_model(rectangle(4, 3, 10.0), CLOTH)
    count, h = model.sheet.points.size, 1e-6
    matrix = np.empty((count, count))
    for k in range(count):
        sides = []
        for sign in (1.0, -1.0):
            state = start(model)
            state.x[k] += sign * h
            add_forces(model, state)
            sides.append(state.f.copy())
        matrix[k] = -(sides[0] - sides[1]) / (2 * h)
    root = 1.0 / np.sqrt(np.repeat(model.mass, 3))
    fastest = np.sqrt(np.linalg.eigvalsh(root[:, None] * matrix * root).max())
    assert 0.5 * (2.0 / fastest) < model.limit <= 2.0 / fastest


@pytest.mark.parametrize(("cells", "error"), [(10, 2.95e-3), (20, 7.4e-4), (40, 1.85e-4), (80, 4.6e-5)])
def test_a_hanging_chain_swings_as_bessel_says(cells: int, error: float) -> None:
    """ω₁ = j₀₁/2 √(g/L), to second order in the piece, from forces of the model about its stretched rest."""
    from scipy.linalg import eigh

    from geomdrap.forming.state import add_forces

    length, gravity = 100.0, 9810.0
    sheet = rectangle(cells, 1, length / cells, "both")
    fibre = Fibre(modulus=1e5, undulation=0.0, compression=1.0)
    model = make_model(sheet, yarns_alone(fibre), driven=[0, 1])
    mass = model.mass.reshape(-1, 2).sum(axis=1)  # of the two yarns, which swing as one
    tension = gravity * np.cumsum(mass[::-1])[::-1][1:]  # N in each piece: what hangs below it
    section = 0.25 * 2.0 * length / cells  # mm² of both yarns
    stretched = length / cells * np.exp(tension / (fibre.modulus * section))
    hung = np.column_stack(
        [np.repeat(np.r_[0.0, np.cumsum(stretched)], 2), sheet.fabric[:, 1], 0.0 * sheet.fabric[:, 1]]
    )

    def forces(aside: np.ndarray) -> np.ndarray:
        """Forces (n, 3) on the crossings with both yarns moved aside."""
        state = start(model)
        state.x[:] = (hung + np.repeat(aside, 2)[:, None] * [0.0, 0.0, 1.0]).ravel()
        add_forces(model, state)
        return state.f.reshape(-1, 2, 3).sum(axis=1)

    assert forces(np.zeros(cells + 1))[1:, 0] == pytest.approx(-gravity * mass[1:], rel=1e-5)  # at rest
    aside = 1e-7 * length / cells  # tension turns, nothing stretches
    k = np.stack([-forces(aside * row)[1:, 2] / aside for row in np.eye(cells + 1)[1:]])
    assert k == pytest.approx(k.T, abs=1e-6 * np.abs(k).max())
    omega = np.sqrt(eigh(0.5 * (k + k.T), np.diag(mass[1:]), eigvals_only=True)[0])
    exact = 2.404825557695773 / 2.0 * np.sqrt(gravity / length)
    assert abs(omega / exact - 1.0) == pytest.approx(error, rel=0.05)


def test_a_hanging_bar_stretches_by_its_weight() -> None:
    """u = ρ g L² / 2E for small strains."""
    length, gravity, modulus, cells = 100.0, 9810.0, 50.0, 10
    fibre = Fibre(modulus=modulus, undulation=0.0, compression=1.0, share=1.0)
    model = make_model(rectangle(cells, 1, length / cells, "both"), yarns_alone(fibre), driven=[0, 1], damping=400.0)
    state = start(model)
    load = model.mass[:, None] * [gravity, 0.0, 0.0]
    take_steps(model, state, 20_000, load=load)
    density = model.mass.sum() / (length * 2.0 * 10.0)
    tip = (state.points - model.sheet.points)[-1, 0]
    assert tip == pytest.approx(density * gravity * length**2 / (2.0 * modulus), rel=2e-3)


def test_a_chain_between_two_walls_hangs_as_a_catenary() -> None:
    cells, length, span = 60, 120.0, 100.0
    fibre = Fibre(modulus=100.0, undulation=0.0, compression=1.0)
    sheet = rectangle(cells, 1, length / cells, "both")
    along = sheet.fabric[:, 0] / length
    depth = 0.5 * np.sqrt(length**2 - span**2)  # two straight halves: no piece is strained at first
    place = np.column_stack([span * along, sheet.fabric[:, 1], -depth * (1.0 - np.abs(2.0 * along - 1.0))])
    ends = np.flatnonzero((along == 0.0) | (along == 1.0))
    model = make_model(sheet.moved(place), yarns_alone(fibre), driven=list(ends), damping=20.0)
    state = start(model)
    take_steps(model, state, 100_000, load=model.mass[:, None] * [0.0, 0.0, -9810.0])
    from scipy.optimize import brentq

    a = brentq(lambda a: 2 * a * np.sinh(0.5 * span / a) - length, 20.0, 500.0)
    x, z = state.points[::2, 0], state.points[::2, 2]
    assert z == pytest.approx(a * (np.cosh((x - 0.5 * span) / a) - np.cosh(0.5 * span / a)), abs=0.03)


def _shaken(cloth: Cloth, safety: float, damping: float = 0.0) -> tuple[float, float, np.ndarray]:
    """Largest balance error of the first and the second half of a free vibration, and the change of momentum."""
    model = make_model(rectangle(10, 10, 10.0), cloth, safety=safety, damping=damping)
    way = np.random.default_rng(0).normal(size=model.sheet.points.shape)
    velocity = 1e4 * way / np.linalg.norm(way, axis=1)[:, None]  # 10 m/s at every node
    state = start(model, velocity)
    first, momentum = ledger_of(model, state), model.mass @ state.v.reshape(-1, 3)
    errors = []
    for _ in range(200):
        take_steps(model, state, 50)
        errors.append(ledger_of(model, state).balance_error(first))
    change = model.mass @ state.v.reshape(-1, 3) - momentum
    return max(errors[:100]), max(errors[100:]), change / np.sum(model.mass[:, None] * np.abs(velocity))


@pytest.mark.parametrize(("safety", "error"), [(0.15, 1.0e-3), (0.3, 4.2e-3), (0.5, 1.0e-2), (0.9, 3.3e-2)])
def test_a_net_shaken_hard_keeps_its_energy(safety: float, error: float) -> None:
    early, late, momentum = _shaken(CLOTH, safety)
    assert max(early, late) < error
    assert late < 2.0 * early  # it does not grow
    assert np.abs(momentum).max() < 1e-15


@pytest.mark.parametrize(("safety", "error"), [(0.15, 1.9e-4), (0.3, 1.8e-3), (0.5, 2.1e-3), (0.9, 1.3e-2)])
def test_a_net_of_undulated_yarns_that_go_slack_keeps_its_energy(safety: float, error: float) -> None:
    yarns = Fibre(undulation=0.005, compression=0.0)
    early, late, momentum = _shaken(Cloth(yarns, yarns, Resin(relaxation=ELASTIC)), safety)
    assert max(early, late) < error
    assert late < 2.0 * early
    assert np.abs(momentum).max() < 1e-15


def test_energy_is_kept_to_third_order_and_to_second_without_what_the_scheme_adds() -> None:
    """A smooth fabric, large strains: without it the books are off by a share of the square of the step."""
    errors: list[list[float]] = [[], []]
    for safety in (0.1, 0.05):
        model = make_model(rectangle(6, 6, 10.0), resin_alone(), safety=safety, scale_mass=False)
        way = np.random.default_rng(0).normal(0.0, 3e3, model.sheet.points.shape) * [1.0, 1.0, 0.0]
        state = start(model, way)
        first, seen = ledger_of(model, state), []
        for _ in range(40):
            take_steps(model, state, round(5 / safety))
            last = ledger_of(model, state)
            seen.append((last.balance - first.balance, last.balance - last.scheme - first.balance + first.scheme))
        for k in (0, 1):
            errors[k].append(max(abs(pair[k]) for pair in seen) / first.kinetic)
    assert np.log2(errors[0][0] / errors[0][1]) == pytest.approx(3.0, abs=0.3)
    assert np.log2(errors[1][0] / errors[1][1]) == pytest.approx(2.0, abs=0.3)
    assert errors[0][1] < 0.1 * errors[1][1]


def test_what_damping_takes_is_in_the_books() -> None:
    model = make_model(rectangle(6, 6, 10.0), CLOTH, safety=0.2, damping=2e4)
    state = start(model, np.random.default_rng(0).normal(0.0, 3e3, model.sheet.points.shape))
    first = ledger_of(model, state)
    take_steps(model, state, 5000)
    last = ledger_of(model, state)
    assert last.kinetic < 0.1 * first.kinetic
    assert last.balance_error(first) < 1e-3


def _relaxing(relaxation: str, step: float) -> tuple[float, float]:
    """Share of the energy that the resin dissipates, and share that is unaccounted for, with the same masses always."""
    from dataclasses import replace

    from geomdrap.forming import RELAXATIONS
    from geomdrap.forming.ledger import book_resin_loss

    sheet, cloth = rectangle(6, 6, 10.0), resin_alone(relaxation=RELAXATIONS[relaxation])
    heavy = make_model(sheet, cloth, 2e-3, safety=0.3).mass
    model = replace(make_model(sheet, cloth, step, safety=0.3), mass=heavy)
    velocity = np.random.default_rng(0).normal(0.0, 3.0, model.sheet.points.shape) * [1.0, 1.0, 0.0]
    state = start(model, velocity)
    first = ledger_of(model, state)
    for _ in range(round(0.5 / step)):
        take_steps(model, state, 1)
        book_resin_loss(model, state, model.step)
    last = ledger_of(model, state)
    return last.viscous / first.kinetic, last.balance_error(first)


@pytest.mark.parametrize("relaxation", ["table", "creep"])
def test_what_the_resin_dissipates_is_in_the_books_to_second_order(relaxation: str) -> None:
    (_, coarse), (lost, fine) = _relaxing(relaxation, 5e-4), _relaxing(relaxation, 1.25e-4)
    assert lost > 0.1
    assert fine < 2e-4
    assert coarse / fine == pytest.approx(16.0, rel=0.25)


def test_the_error_falls_with_the_square_of_the_step() -> None:
    ends = []
    for refine in (1, 2, 4, 8):
        model = make_model(rectangle(4, 4, 10.0), Cloth(), 1e-6 / refine, scale_mass=False, safety=1.0)
        state = start(model, np.random.default_rng(4).normal(0.0, 300.0, model.sheet.points.shape))
        take_steps(model, state, 100 * refine)
        ends.append(state.points.copy())
    apart = [np.abs(a - b).max() for a, b in pairwise(ends)]
    assert np.log2(apart[0] / apart[1]) == pytest.approx(2.0, abs=0.2)
    assert np.log2(apart[1] / apart[2]) == pytest.approx(2.0, abs=0.2)


def test_a_step_over_the_stable_limit_is_refused_and_the_limit_is_named() -> None:
    sheet = rectangle(3, 3, 10.0)
    limit = make_model(sheet, CLOTH).limit
    with pytest.raises(FormingError, match=f"over the stable limit of {limit:.3g} s"):
        make_model(sheet, CLOTH, 1.01 * limit, scale_mass=False)
    assert make_model(sheet, CLOTH, 100.0 * limit).mass_scale == pytest.approx(4e4, rel=0.6)


def test_scaled_masses_make_the_wanted_step_half_the_limit_at_every_node() -> None:
    model = make_model(rectangle(5, 5, 10.0), CLOTH, 1e-3)
    assert model.limit == pytest.approx(2e-3, rel=1e-9)
