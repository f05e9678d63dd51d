"""T4, T5, T8: one triangle against closed forms; patches of many; motions that strain nothing."""

from __future__ import annotations

import numpy as np
import pytest
from laws import resin_alone
from scipy.linalg import logm, polar
from scipy.spatial.transform import Rotation

from geomdrap.forming import RELAXATIONS, make_model, rectangle, start
from geomdrap.forming.membrane import WIDTH
from geomdrap.forming.state import add_forces

SHEAR_MODULUS = 45.0 / 2.9


def _elastic_stress(model: object, state: object) -> np.ndarray:
    """Elastic stress (m, 3) of the triangles, 11, 12, 22."""
    history = state.history.reshape(len(state.history), -1, 3, WIDTH)  # type: ignore[attr-defined]
    return np.moveaxis(history[:, 0], 1, 2).reshape(-1, 3)[: len(model.corners)]  # type: ignore[attr-defined]


def _deformed(cloth: object, gradient: np.ndarray, cells: int = 1, steps: int = 1) -> tuple:
    """Model and state with all nodes carried by a deformation gradient (3, 2)."""
    model = make_model(rectangle(cells, cells, 10.0), cloth)  # type: ignore[arg-type]
    state = start(model)
    flat = np.eye(3)[:, :2]
    for n in range(1, steps + 1):
        state.x[:] = (model.sheet.fabric @ (flat + (gradient - flat) * n / steps).T).ravel()
        add_forces(model, state)
    return model, state


def _plane(matrix: np.ndarray) -> np.ndarray:
    """A plane deformation as a gradient (3, 2)."""
    return np.vstack([matrix, np.zeros(2)])


@pytest.mark.parametrize("size", [1e-9, 1e-4, 0.03, 0.2, 0.7])
def test_the_stress_is_that_of_the_logarithm_of_the_stretch(size: float) -> None:
    rng = np.random.default_rng(3)
    nu, k = 0.45, 45.0 / (1 - 0.45**2)
    for _ in range(20):
        f = np.eye(2) + size * rng.uniform(-1, 1, (2, 2))
        model, state = _deformed(resin_alone(), _plane(f))
        h = logm(polar(f)[1]).real
        exact = k * np.array([h[0, 0] + nu * h[1, 1], (1 - nu) * h[0, 1], h[1, 1] + nu * h[0, 0]])
        assert _elastic_stress(model, state)[0] == pytest.approx(exact, rel=1e-11, abs=1e-12)


@pytest.mark.parametrize(("gamma", "s12", "s11"), [(1.0, 0.869784, 0.415900), (2.0, 1.386294, 1.141593)])
def test_the_rate_form_gives_dienes_solution_in_simple_shear(gamma: float, s12: float, s11: float) -> None:
    """J. K. Dienes, Acta Mechanica 32 (1979) 217. The stress in the frame of U is turned into space by R."""
    model, state = _deformed(
        resin_alone(strain="green-naghdi"), _plane(np.array([[1.0, gamma], [0.0, 1.0]])), 1, 4000
    )
    t = _elastic_stress(model, state)[0]
    turn = polar(np.array([[1.0, gamma], [0.0, 1.0]]))[0]
    stress = turn @ np.array([[t[0], t[1]], [t[1], t[2]]]) @ turn.T / SHEAR_MODULUS
    assert stress[0, 1] == pytest.approx(s12, abs=1e-6)
    assert stress[0, 0] == pytest.approx(s11, abs=1e-6)
    tan_b = 0.5 * gamma
    b = np.arctan(tan_b)
    exact = 2 * np.cos(2 * b) * (2 * b - 2 * np.tan(2 * b) * np.log(np.cos(b)) - tan_b)
    assert stress[0, 1] == pytest.approx(exact, abs=1e-6)


@pytest.mark.parametrize(("gamma", "value"), [(1.0, 0.860818), (2.0, 1.246450)])
def test_total_hencky_strain_differs_from_the_rate_form_in_simple_shear(gamma: float, value: float) -> None:
    model, state = _deformed(resin_alone(), _plane(np.array([[1.0, gamma], [0.0, 1.0]])))
    t = _elastic_stress(model, state)[0]
    turn = polar(np.array([[1.0, gamma], [0.0, 1.0]]))[0]
    stress = turn @ np.array([[t[0], t[1]], [t[1], t[2]]]) @ turn.T / SHEAR_MODULUS
    assert value == pytest.approx(2 * np.arcsinh(gamma / 2) / np.sqrt(1 + gamma**2 / 4), abs=1e-6)
    assert stress[0, 1] == pytest.approx(value, abs=1e-6)


def _trellis(angle: float) -> np.ndarray:
    c, s = np.cos(0.5 * angle), np.sin(0.5 * angle)
    return _plane(np.array([[c, s], [s, c]]))


def test_in_trellis_shear_the_rate_form_and_the_total_strain_are_one() -> None:
    """Nothing turns there, and the principal axes stay."""
    model, total = _deformed(resin_alone(), _trellis(np.deg2rad(50.0)))
    state = start(make_model(model.sheet, resin_alone(strain="green-naghdi")))
    walker = make_model(model.sheet, resin_alone(strain="green-naghdi"))
    for angle in np.deg2rad(np.linspace(0.0, 50.0, 2001))[1:]:
        state.x[:] = (model.sheet.fabric @ _trellis(angle).T).ravel()
        add_forces(walker, state)
    assert _elastic_stress(model, state) == pytest.approx(_elastic_stress(model, total), rel=1e-6)


def _distorted(cloth: object) -> object:
    """A model on a mesh whose triangles differ: the inner nodes of a grid are shifted in the cloth itself."""
    from dataclasses import replace

    sheet = rectangle(6, 5, 10.0)
    inner = np.all((sheet.fabric > 1.0) & (sheet.fabric < [59.0, 49.0]), axis=1)
    shift = np.random.default_rng(5).uniform(-3.0, 3.0, sheet.fabric.shape) * inner[:, None]
    flat = sheet.fabric + shift
    moved = replace(sheet, fabric=flat, points=np.column_stack([flat, np.zeros(len(flat))]))
    return make_model(moved, cloth), inner  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("strain", "thickness"), [("hencky", "incompressible"), ("hencky", "constant"), ("green", "incompressible")]
)
def test_a_patch_of_distorted_triangles_carries_one_stress_and_balances(strain: str, thickness: str) -> None:
    model, inner = _distorted(resin_alone(strain=strain, thickness=thickness))  # type: ignore[misc]
    state = start(model)
    gradient = Rotation.from_rotvec([0.4, -0.7, 1.1]).as_matrix() @ _plane(np.array([[1.2, 0.3], [-0.1, 0.8]]))
    state.x[:] = (model.sheet.fabric @ gradient.T + [5.0, -3.0, 11.0]).ravel()
    add_forces(model, state)
    stress = _elastic_stress(model, state)
    assert np.ptp(stress, axis=0).max() < 1e-12 * np.abs(stress).max()
    scale = np.abs(state.f).max()
    assert np.abs(state.f.reshape(-1, 3)[inner]).max() < 1e-12 * scale


@pytest.mark.parametrize("strain", ["hencky", "green-naghdi", "green"])
def test_a_large_rotation_and_translation_strains_nothing(strain: str) -> None:
    cloth = resin_alone(strain=strain, relaxation=RELAXATIONS["table"])
    model = make_model(rectangle(5, 4, 10.0), cloth)
    state = start(model)
    turn = Rotation.from_rotvec([1.9, -0.8, 2.2]).as_matrix()
    state.x[:] = (model.sheet.points @ turn.T + [300.0, -20.0, 70.0]).ravel()
    add_forces(model, state)
    stiffness = model.law[0] * 2.0 * 10.0  # N per unit of strain on a side
    assert np.abs(state.f).max() < 1e-12 * stiffness
    assert np.abs(_elastic_stress(model, state)).max() < 1e-12 * model.law[0]


def test_a_rotation_leaves_the_relaxing_stresses_as_they_are() -> None:
    cloth = resin_alone(relaxation=RELAXATIONS["table"])
    model = make_model(rectangle(2, 2, 10.0), cloth)
    still, turned = start(model), start(model)
    bent = model.sheet.fabric @ _plane(np.array([[1.1, 0.2], [0.0, 0.9]])).T
    turn = Rotation.from_rotvec([1.9, -0.8, 2.2]).as_matrix()
    for state, second in ((still, bent), (turned, bent @ turn.T + [3.0, 2.0, 1.0])):
        for place in (bent, second):
            state.x[:] = place.ravel()
            add_forces(model, state)
    assert turned.history == pytest.approx(still.history, abs=1e-12 * np.abs(still.history).max())
    assert turned.f.reshape(-1, 3) == pytest.approx(
        still.f.reshape(-1, 3) @ turn.T, abs=1e-12 * np.abs(still.f).max()
    )


@pytest.mark.parametrize("strain", ["hencky", "green"])
def test_forces_are_the_slope_of_the_stored_energy(strain: str) -> None:
    from geomdrap.forming.ledger import resin_energy

    model = make_model(rectangle(3, 2, 10.0, "both"), resin_alone(strain=strain))
    rng = np.random.default_rng(1)
    place = model.sheet.points + rng.normal(0.0, 1.5, model.sheet.points.shape)
    way, h, energies = rng.normal(0.0, 1.0, place.shape), 1e-4, []
    for k in (-2, -1, 1, 2):
        state = start(model)
        state.x[:] = (place + k * h * way).ravel()
        add_forces(model, state)
        energies.append(resin_energy(model, state))
    state = start(model)
    state.x[:] = place.ravel()
    add_forces(model, state)
    slope = (energies[0] - 8 * energies[1] + 8 * energies[2] - energies[3]) / (12 * h)
    assert slope == pytest.approx(-state.f @ way.ravel(), rel=1e-9)


def test_constant_thickness_scales_the_force_of_a_trellis_by_the_cosine() -> None:
    forces = []
    for rule in ("incompressible", "constant"):
        _, state = _deformed(resin_alone(thickness=rule), _trellis(np.deg2rad(40.0)))
        forces.append(state.f.copy())
    assert forces[1] == pytest.approx(forces[0] * np.cos(np.deg2rad(40.0)), abs=1e-10)


def test_four_triangles_of_half_weight_resist_an_even_strain_as_two_do() -> None:
    gradient = _plane(np.array([[1.1, 0.3], [0.0, 0.9]]))
    results = []
    for diagonals in ("alternate", "both"):
        model = make_model(rectangle(4, 4, 10.0, diagonals), resin_alone())
        state = start(model)
        state.x[:] = (model.sheet.fabric @ gradient.T).ravel()
        add_forces(model, state)
        edge = np.isclose(model.sheet.fabric[:, 0], 40.0)
        results.append(state.f.reshape(-1, 3)[edge].sum(axis=0))
    assert results[0] == pytest.approx(results[1], rel=1e-12)
