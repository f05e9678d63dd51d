"""T9: our forces at equilibria that another program found (Kratos Multiphysics 10.4.4; see make_kratos_fixture.py)."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from laws import resin_alone

from geomdrap.forming import Sheet, make_model, start
from geomdrap.forming.state import add_forces

FIXTURE = Path(__file__).parents[1] / "data" / "forming" / "kratos.npz"


def _yarn_forces(data: dict, x: np.ndarray) -> np.ndarray:
    """Of yarns with Saint Venant's law, as that program has them: S = E (l² − L²) / 2L², N = S A l / L."""
    i, j = data["pieces"].T
    rest, along = data["points"][j] - data["points"][i], x[j] - x[i]
    length2 = np.sum(rest**2, axis=1)
    strain = 0.5 * (np.sum(along**2, axis=1) / length2 - 1.0)
    pull = (data["yarn_modulus"] * data["section"] * strain / np.sqrt(length2))[:, None] * along
    force = np.zeros_like(x)
    np.add.at(force, i, pull)
    np.add.at(force, j, -pull)
    return force


@pytest.mark.parametrize("case", ["stretched", "twisted"])
def test_forces_vanish_at_the_equilibria_of_another_program_and_reactions_are_its_own(case: str) -> None:
    data = dict(np.load(FIXTURE))
    points, triangles = data["points"], data["triangles"]
    sheet = Sheet(
        points[:, :2], points, triangles, np.ones(len(triangles)), data["pieces"], np.zeros(len(data["pieces"]), int),
        np.ones(len(data["pieces"])), 36,
    )  # fmt: skip
    resin = resin_alone(strain="green", modulus=float(data["modulus"]), poisson=float(data["poisson"]))
    model = make_model(sheet, replace(resin, thickness=float(data["thickness"])))
    state = start(model)
    state.x[:] = (points + data[case]).ravel()
    add_forces(model, state)
    membrane, yarns = state.f.reshape(-1, 3), _yarn_forces(data, state.points)
    total = membrane + yarns
    held = (points[:, 0] < 1e-9) | (points[:, 0] > points[:, 0].max() - 1e-9)
    scale = np.abs(membrane[held]).max()
    free = total[~held][:, :2] if case == "stretched" else total[~held]
    assert scale > 10.0
    assert np.abs(free).max() < 1e-13 * np.abs(yarns).max()
    reaction = data[f"{case}_reaction"][held]
    assert np.abs(-total[held] - reaction).max() < 1e-13 * np.abs(reaction).max()
    if case == "twisted":
        assert np.abs(data[case][:, 2]).max() > 10.0
