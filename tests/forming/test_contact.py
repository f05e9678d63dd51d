"""T12: rigid tools: friction on a slope, the capstan, forces that add up, a sphere under pressure, no penetration."""

from __future__ import annotations

import numpy as np
import pytest
from laws import resin_alone, yarns_alone

from geomdrap.errors import FormingError
from geomdrap.forming import Cloth, Fibre, Tool, ledger_of, make_model, rectangle, start, take_steps
from geomdrap.forming.contact import gap, packed

GRAVITY = 9810.0


def _on_slope(angle: float, friction: float, steps: int = 4000) -> tuple:
    """A small sheet on a plane inclined by ``angle`` deg: model, state, unit vector down the slope."""
    t = np.deg2rad(angle)
    down, normal = np.array([np.cos(t), 0.0, -np.sin(t)]), np.array([np.sin(t), 0.0, np.cos(t)])
    sheet = rectangle(2, 2, 10.0)
    place = sheet.fabric[:, :1] * down + sheet.fabric[:, 1:] * [0.0, 1.0, 0.0]
    model = make_model(sheet.moved(place), Cloth(), 1e-5)
    state = start(model, tools=(Tool("plane", (0.0, 0.0, 0.0), tuple(normal), friction=friction),))
    take_steps(model, state, steps, load=model.mass[:, None] * [0.0, 0.0, -GRAVITY])
    return model, state, down


def test_a_sheet_sticks_where_the_slope_is_less_steep_than_the_friction() -> None:
    model, state, _ = _on_slope(20.0, 0.40)  # tan 20° = 0.364
    assert np.abs(state.points - model.sheet.points).max() < 1e-9


@pytest.mark.parametrize(("angle", "friction"), [(20.0, 0.0), (20.0, 0.2), (45.0, 0.3)])
def test_a_sheet_slides_down_a_slope_with_coulombs_acceleration(angle: float, friction: float) -> None:
    model, state, down = _on_slope(angle, friction)
    t = np.deg2rad(angle)
    moved = (state.points - model.sheet.points) @ down
    exact = 0.5 * GRAVITY * (np.sin(t) - friction * np.cos(t)) * state.time**2
    assert moved == pytest.approx(np.full(len(moved), exact), rel=1e-3)


def test_what_friction_takes_from_a_sliding_sheet_is_in_the_books() -> None:
    model, state, down = _on_slope(30.0, 0.2)
    ledger = ledger_of(model, state)
    way = float(np.mean((state.points - model.sheet.points) @ down))
    exact = 0.2 * np.cos(np.deg2rad(30.0)) * GRAVITY * float(model.mass.sum()) * way
    assert ledger.friction == pytest.approx(exact, rel=2e-3)
    assert ledger.balance_error() < 2e-3


def test_momentum_from_a_tool_is_that_of_the_load_step_by_step() -> None:
    model, state, _ = _on_slope(0.0, 0.3, 100)
    weight = float(model.mass.sum()) * GRAVITY
    for _ in range(20):
        take_steps(model, state, 1, load=model.mass[:, None] * [0.0, 0.0, -GRAVITY])
        assert state.impulse[0] / model.step == pytest.approx([0.0, 0.0, weight], rel=1e-10, abs=1e-10 * weight)


@pytest.mark.parametrize(
    "tool",
    [
        Tool("plane", (0.0, 0.0, -2.0), (0.2, 0.1, 1.0), friction=0.2),
        Tool("sphere", (20.0, 20.0, -31.0), radius=30.0, friction=0.3),
        Tool("cylinder", (0.0, 20.0, -21.0), (1.0, 0.0, 0.1), radius=20.0, friction=0.1, velocity=(0.0, 0.0, 300.0)),
    ],
    ids=lambda tool: tool.kind,
)
def test_no_node_is_inside_a_tool_after_any_step(tool: Tool) -> None:
    model = make_model(rectangle(8, 8, 5.0, "both"), Cloth(), 2e-6)
    velocity = np.random.default_rng(0).normal(0.0, 300.0, model.sheet.points.shape) + [0.0, 0.0, -2000.0]
    state, deepest, touched = start(model, velocity, (tool,)), 0.0, 0
    for _ in range(600):
        take_steps(model, state, 1, load=model.mass[:, None] * [0.0, 0.0, -100 * GRAVITY])
        gaps = [gap(state.tools[0], *place)[0] for place in state.points]
        deepest, touched = min(deepest, *gaps), touched + bool(np.any(state.impulse))
    assert touched > 5
    assert deepest > -1e-13  # mm: rounding


def test_energy_with_a_moving_tool_and_friction_balances() -> None:
    tool = Tool(
        "cylinder", (20.0, 20.0, -20.0), (0.0, 1.0, 0.0), radius=20.0, friction=0.3, velocity=(50.0, 0.0, 200.0)
    )
    sheet = rectangle(8, 8, 5.0, "both")
    edge = np.flatnonzero((sheet.fabric[:, 0] == 0.0) | (sheet.fabric[:, 0] == 40.0))
    model = make_model(sheet, Cloth(), 5e-6, list(edge), safety=0.2)
    state = start(model, tools=(tool,))
    take_steps(model, state, 8000)
    ledger = ledger_of(model, state)
    assert ledger.friction > 0.0
    assert ledger.external > 0.0
    assert ledger.balance_error() < 5e-3


def test_a_yarn_over_a_cylinder_pulls_as_euler_and_eytelwein_say() -> None:
    """T₂/T₁ of the polygon that the nodes make; π/2 at μ = 0.3, twenty pieces: 1.602401."""
    friction, radius, pieces, tail = 0.3, 50.0, 20, 8
    chord = 2.0 * radius * np.sin(0.25 * np.pi / pieces)
    count = pieces + 2 * tail
    sheet = rectangle(count, 1, chord, "both")
    fibre = Fibre(modulus=2000.0, undulation=0.0)
    angle = (np.arange(count + 1) - tail) * 0.5 * np.pi / pieces
    on = np.clip(angle, 0.0, 0.5 * np.pi)
    beyond = chord * (np.arange(count + 1) - np.clip(np.arange(count + 1), tail, tail + pieces))
    x = radius * np.sin(on) + beyond * np.cos(on)
    z = radius * np.cos(on) - beyond * np.sin(on)
    place = np.column_stack([np.repeat(x, 2), sheet.fabric[:, 1], np.repeat(z, 2)])
    held = np.array([0, 1, 2 * count, 2 * count + 1])
    model = make_model(sheet.moved(place), yarns_alone(fibre), 1e-4, list(held), damping=20.0, safety=0.3)
    state = start(model, tools=(Tool("cylinder", (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), radius - 1e-9, friction),))
    rest = state.points[model.driven].copy()
    first, last = np.array([-1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0])
    tension = []
    for n in range(1, 401):  # tighten both ends, then drag it over the tool
        way = np.zeros_like(rest)
        way[:2] += first * min(n / 100.0, 1.0) * 4.0 - first * max(n - 100, 0) / 300.0 * 3.0
        way[2:] += last * (min(n / 100.0, 1.0) * 4.0 + max(n - 100, 0) / 300.0 * 3.0)
        take_steps(model, state, 200, rest + way)
        tension.append((state.reaction[:2].sum(axis=0) @ first, state.reaction[2:].sum(axis=0) @ last))
    ratio = np.mean([b / a for a, b in tension[-60:]])
    turn = 0.5 * np.pi / pieces
    polygon = ((1 + friction * np.tan(turn / 2)) / (1 - friction * np.tan(turn / 2))) ** pieces
    assert polygon == pytest.approx(1.602401, abs=1e-6)
    assert ratio == pytest.approx(polygon, rel=0.01)


def test_a_sphere_under_pressure_carries_half_of_pressure_times_radius() -> None:
    """p = 2 σ h / R, σ h from the resin's stress at the radius that it has reached."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=3, radius=50.0)
    points, triangles = np.asarray(ball.vertices), np.asarray(ball.faces, dtype=np.int64)
    corners = points[triangles]
    side = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
    along = (corners[:, 1] - corners[:, 0]) / side[:, None]
    other = corners[:, 2] - corners[:, 0]
    x = np.einsum("mi,mi->m", other, along)
    y = np.linalg.norm(other - x[:, None] * along, axis=1)
    # every triangle has flat coordinates of its own: the resin has no direction
    from geomdrap.forming.membrane import WIDTH, WORK_ROWS, membrane_forces

    cloth = resin_alone()
    count = len(triangles)
    inverse = np.linalg.inv(np.stack([np.stack([side, 0 * side], 1), np.stack([x, y], 1)], axis=-1))
    shape = np.stack(
        [inverse[:, 0, 0], inverse[:, 0, 1], inverse[:, 1, 0], inverse[:, 1, 1], side * y / 2 * cloth.thickness]
    )
    from geomdrap.forming.model import _blocks, _membrane_law

    blocks = _blocks(shape)
    history = np.zeros((len(blocks), 6 * WIDTH))
    stretch = 1.1
    force = np.zeros(points.size)
    membrane_forces(
        np.ascontiguousarray(stretch * points).ravel(), force, triangles, blocks, history, _membrane_law(cloth), np.zeros(0),
        np.zeros(0), np.zeros(WORK_ROWS * WIDTH),
    )  # fmt: skip
    normal = np.cross(*(np.moveaxis(stretch * (corners[:, 1:] - corners[:, :1]), 1, 0))) / 2
    push = np.zeros_like(points)
    np.add.at(push, triangles, np.repeat(normal[:, None] / 3, 3, axis=1))
    radial = points / 50.0
    pressure = -np.sum(force.reshape(-1, 3) * radial) / np.sum(push * radial)
    kirchhoff = 45.0 / (1 - 0.45) * np.log(stretch)
    membrane = kirchhoff * cloth.thickness / stretch**2  # N/mm: σ h, with J = stretch²
    assert count == 1280
    assert pressure == pytest.approx(2 * membrane / (50.0 * stretch), rel=0.01)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"kind": "cone"}, "no tool 'cone'"),
        ({"kind": "sphere"}, "needs a radius above 0"),
        ({"kind": "plane", "friction": -0.1}, "friction of 0 or more"),
        ({"kind": "plane", "direction": (0.0, 0.0, 0.0)}, "must not be 0,0,0"),
    ],
)
def test_a_tool_that_cannot_be_is_refused(asked: dict, said: str) -> None:
    with pytest.raises(FormingError, match=said):
        Tool(**{"point": (0.0, 0.0, 0.0), **asked})


def test_the_gap_is_the_distance_along_the_normal() -> None:
    tool = packed((Tool("cylinder", (1.0, 0.0, 0.0), (0.0, 2.0, 0.0), 3.0),))[0]
    assert gap(tool, 1.0, 7.0, 5.0) == pytest.approx((2.0, 0.0, 0.0, 1.0))
    assert gap(tool, 2.0, -7.0, 0.0) == pytest.approx((-2.0, 1.0, 0.0, 0.0))
