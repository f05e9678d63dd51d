"""T3, T5, T6, T7, T15: test specimens against closed forms, an inextensible net, and an equilibrium found otherwise."""

from __future__ import annotations

import numpy as np
import pytest
from inextensible_net import NetStrip, trellis_slope
from laws import resin_alone

from geomdrap.errors import FormingError
from geomdrap.forming import ELASTIC, RELAXATIONS, Cloth, Fibre, Resin, drive, make_model, rectangle
from geomdrap.forming.biaxial import biaxial_specimen
from geomdrap.forming.coupon import bias_extension, biaxial, picture_frame, uniaxial
from geomdrap.forming.specimen import pull, tensions

STIFF = Fibre(modulus=1.3e6, undulation=0.0)
NEARLY_INEXTENSIBLE = Cloth(STIFF, STIFF, Resin(relaxation=ELASTIC))


@pytest.mark.parametrize(("shear", "force"), [(10.0, 894.40), (30.0, 5295.88), (45.0, 17518.13)])
def test_the_picture_frame_has_the_force_of_the_closed_form(shear: float, force: float) -> None:
    result = picture_frame(Cloth(resin=Resin(relaxation=ELASTIC)), 100.0, [shear]).result
    g = np.deg2rad(shear)
    exact = 2.0 * 100.0 * float(trellis_slope(np.array(g))) / np.sin(0.25 * np.pi - 0.5 * g)
    assert exact == pytest.approx(force, abs=0.005)
    assert result.forces["force"][-1] == pytest.approx(exact, rel=1e-12)
    assert result.displacement[-1] == pytest.approx(
        200.0 * (np.cos(np.pi / 4 - g / 2) - np.cos(np.pi / 4)), rel=1e-12
    )
    assert result.shear[-1] == pytest.approx(shear, abs=1e-9)
    assert result.balance_error < 1e-6


def test_constant_thickness_takes_the_cosine_from_the_force_of_the_frame() -> None:
    forces = [
        picture_frame(resin_alone(thickness=rule), 100.0, [40.0]).result.forces["force"][-1]
        for rule in ("incompressible", "constant")
    ]
    assert forces[1] / forces[0] == pytest.approx(np.cos(np.deg2rad(40.0)), rel=1e-9)


@pytest.mark.parametrize(
    ("degrees", "ratio"), [(10, 1.06), (20, 1.26), (30, 1.63), (40, 2.27), (50, 3.39), (60, 5.54)]
)
def test_the_resin_stiffens_in_shear_as_tabulated(degrees: int, ratio: float) -> None:
    g = np.deg2rad(degrees)
    assert float(trellis_slope(np.array(g))) / (45.0 / 2.9 * g) == pytest.approx(ratio, abs=0.01)


def test_the_frame_of_a_relaxing_resin_pulls_less_the_slower_it_is() -> None:
    forces = [picture_frame(Cloth(), 100.0, [5.0, 20.0], speed).result.forces["force"] for speed in (20.0, 80.0, 1e9)]
    elastic = picture_frame(Cloth(resin=Resin(relaxation=ELASTIC)), 100.0, [5.0, 20.0]).result.forces["force"]
    assert np.all(np.diff([f[-1] for f in forces]) > 0.0)
    assert forces[2] == pytest.approx(elastic, rel=1e-3)


@pytest.mark.slow
def test_the_net_oracle_has_the_values_found_before() -> None:
    """T6 and T7: force and shear in the middle of inextensible nets, N and deg."""
    for angle, rows in (
        (45.0, ((2.4, 71.49, 2.180), (12.0, 447.2, 11.506))),
        (15.0, ((1.0, 363.0, None), (4.0, 2286.7, None))),
        (30.0, ((5.0, 232.9, None), (20.0, 1982.3, None))),
    ):
        found = NetStrip(150.0, 30.0, 2.0, angle, 50).solve([row[0] for row in rows])
        for (_, force, shear), (f, g) in zip(rows, found, strict=True):
            assert f == pytest.approx(force, rel=5e-4)
            assert shear is None or g == pytest.approx(shear, abs=0.006)


def _shown(result: object, displacement: float) -> tuple[float, float]:
    k = int(np.argmin(np.abs(result.displacement - displacement)))  # type: ignore[attr-defined]
    assert result.displacement[k] == pytest.approx(displacement)  # type: ignore[attr-defined]
    return float(result.forces["force"][k]), float(result.shear[k])  # type: ignore[attr-defined]


@pytest.mark.slow
def test_bias_extension_has_force_and_shear_of_the_inextensible_net() -> None:
    """T6, with yarns ten times stiffer: 1 % of force, 0.15 deg of shear; the zone formula is 5 % off in shear."""
    result = bias_extension(NEARLY_INEXTENSIBLE, 30.0, cells=10, frames=25).result
    for displacement, force, shear in ((2.4, 71.49, 2.180), (12.0, 447.2, 11.506), (30.0, 2830.5, 33.076)):
        f, g = _shown(result, displacement)
        assert f == pytest.approx(force, rel=0.01)
        assert g == pytest.approx(shear, abs=0.15)
    assert result.balance_error < 1e-3
    assert result.kinetic_share < 0.01


@pytest.mark.slow
@pytest.mark.parametrize(
    ("angle", "cells", "rows"),
    [
        (15.0, 5, ((1.0, 363.0), (2.0, 798.8), (4.0, 2286.7), (6.0, 6464.5))),
        (30.0, 8, ((5.0, 232.9), (10.0, 553.2), (20.0, 1982.3), (30.0, 9173.1))),
        (45.0, 8, ((10.0, 350.6), (20.0, 1017.9))),
    ],
)
def test_off_axis_forces_are_those_of_the_inextensible_net(angle: float, cells: int, rows: tuple) -> None:
    """T7, 1 %, with yarns two hundred times stiffer than aramid, since others stretch near the lock."""
    yarn = Fibre(modulus=2.6e7, undulation=0.0)
    cloth, furthest = Cloth(yarn, yarn, Resin(relaxation=ELASTIC)), rows[-1][0]
    frames = 10 * round(furthest / rows[0][0])  # forces are means over a frame: short ones
    result = uniaxial(cloth, angle, 20.0, furthest, cells=cells, frames=frames).result
    for displacement, force in rows:
        assert _shown(result, displacement)[0] == pytest.approx(force, rel=0.01)
    first, *_ = result.run.frames
    known = result.run.frames[frames // 10 :]  # at the first reading there is next to no energy
    assert max(f.ledger.balance_error(first.ledger) for f in known) < 1e-3


@pytest.mark.slow
def test_speeds_differ_in_force_as_the_relaxation_says() -> None:
    """T3: F40/F20 and F80/F20 of a 45° strip, at 12 mm; 0.5 %."""
    straight = Fibre(undulation=0.0)
    forces = [
        _shown(uniaxial(Cloth(straight, straight), 45.0, speed, 12.0, cells=10, frames=12).result, 12.0)[0]
        for speed in (20.0, 40.0, 80.0)
    ]
    table = RELAXATIONS["table"]
    for k, speed in ((1, 40.0), (2, 80.0)):
        exact = speed / 20.0 * table.after_ramp(720.0 / speed) / table.after_ramp(36.0)
        assert forces[k] / forces[0] == pytest.approx(exact, rel=0.005)
    assert forces[1] / forces[0] == pytest.approx(1.0493, rel=0.005)
    assert forces[2] / forces[0] == pytest.approx(1.0946, rel=0.005)


def test_damping_does_not_hold_back_the_first_millimetres() -> None:
    """Against eight times the steps, whose masses are 64 times lighter: 0.1 %; against the even flow it were 2.5 %."""
    few, many = (
        uniaxial(Cloth(), displacement=10.0, length=90.0, cells=4, frames=10, steps=steps).result.forces["force"][1:]
        for steps in (10_000, 80_000)
    )
    assert few == pytest.approx(many, rel=1e-3)


@pytest.mark.slow
def test_stiffness_falls_with_the_angle_and_undulation_delays_the_force() -> None:
    forces = {
        a: uniaxial(Cloth(), a, displacement=2.0, cells=8, frames=4).result.forces["force"][-1]
        for a in (0, 15, 30, 45)
    }
    assert forces[0] > forces[15] > forces[30] > forces[45] > 0.0
    straight = Fibre(undulation=0.0)
    late, early = (
        uniaxial(Cloth(f, f), 45.0, displacement=45.0, cells=8, frames=30).result.forces["force"][-1]
        for f in (Fibre(undulation=0.005), straight)
    )
    assert late < 0.95 * early


@pytest.mark.slow
def test_the_equilibrium_is_the_one_that_another_solver_finds() -> None:
    """T15: places and force of the relaxed explicit run, against where the forces by numpy alone vanish; 1e-6."""
    from numpy_step import NumpyStep
    from scipy.optimize import root

    from geomdrap.forming import ledger_of, start, take_steps

    yarn = Fibre(modulus=2000.0, undulation=0.0, compression=1.0)
    specimen = biaxial_specimen(Cloth(yarn, yarn, Resin(relaxation=ELASTIC)), 60.0, 40.0, 6, 0.3)
    model = make_model(specimen.sheet, specimen.cloth, 1e-3, specimen.held, 40.0)
    end = specimen.sheet.points + 8.0 * specimen.flow
    state = start(model)
    for n in range(1, 41):
        take_steps(model, state, 50, (specimen.sheet.points + 8.0 * n / 40.0 * specimen.flow)[model.driven])
    take_steps(model, state, 10_000, end[model.driven])
    assert ledger_of(model, state).kinetic < 1e-12 * ledger_of(model, state).internal

    oracle = NumpyStep(model)
    oracle.x = end.copy()
    free = np.flatnonzero(model.free)

    def residual(z: np.ndarray) -> np.ndarray:
        oracle.x[free, :2] = z.reshape(-1, 2)
        return oracle.forces()[free, :2].ravel()

    found = root(residual, end[free, :2].ravel(), method="hybr", options={"xtol": 1e-13, "maxfev": 100_000})
    assert np.abs(residual(found.x)).max() < 1e-7
    assert state.points[:, :2] == pytest.approx(oracle.x[:, :2], abs=1e-6)
    force = sum(np.sum(w[model.driven] * state.reaction) for w in specimen.readers.values())
    pulled = sum(-np.sum(w * oracle.forces()) for w in specimen.readers.values())
    assert force == pytest.approx(pulled, rel=1e-6)


def test_the_yarns_that_cross_a_cut_carry_what_the_grips_beyond_it_pull() -> None:
    """Grips as wide as the sheet, yarns alone: tensions, which are worked out from strains, against reactions."""
    yarn = Fibre(modulus=50.0, undulation=0.05)
    cloth = Cloth(yarn, yarn, Resin(modulus=0.0, relaxation=ELASTIC), thickness=1.0)
    result = pull(biaxial_specimen(cloth, 100.0, 100.0, 6), 10.0, 240.0, 8000, 5)
    ends, tension, family = tensions(result)
    model, last = result.run.model, result.run.frames[-1]
    rest = model.sheet.points
    for axis in (0, 1):
        side = rest[model.ends][:, :, axis].mean(axis=1)
        across = (family == axis) & (np.abs(side - 25.0 / 3.0) < 1.0)  # the row of cells beyond the middle
        along = ends[across, 1] - ends[across, 0]
        pulled = tension[across] * model.section[across] / (yarn.share * cloth.thickness)
        carried = np.sum(pulled * np.abs(along[:, axis]) / np.linalg.norm(along, axis=1))
        beyond = rest[model.driven][:, axis] > 1.0
        assert across.sum() == 7
        assert carried == pytest.approx(last.reaction[beyond][:, axis].sum(), rel=1e-3)
    assert result.forces["force_warp"] == pytest.approx(result.forces["force_weft"], rel=1e-9)


def test_the_jersey_has_the_forces_of_the_paper() -> None:
    """Table 2: 620 and 1,180 N at 140 mm, a ratio of 1.90 ± 0.1, with 400 cells and 1,600 pieces of yarn."""
    result = biaxial(frames=10).result
    assert result.forces["force_warp"][-1] == pytest.approx(620.0, rel=0.01)
    assert result.forces["force_weft"][-1] == pytest.approx(1180.0, rel=0.01)
    assert result.specimen.sheet.cells == 400
    assert len(result.specimen.sheet.pieces) == 1600
    assert abs(result.shear[-1]) < 1e-6
    assert result.balance_error < 1e-4
    assert not result.warnings


def test_a_step_over_the_limit_diverges_and_what_came_before_is_kept() -> None:
    yarn = Fibre(undulation=0.0, compression=1.0)
    specimen = biaxial_specimen(Cloth(yarn, yarn), 100.0, 60.0, 6)
    model = make_model(specimen.sheet, specimen.cloth, 1e-3, specimen.held, safety=1.0)
    from dataclasses import replace

    wild = replace(model, mass=model.mass / 2.0)  # so that it grows for a while; the bound is below the limit
    rest = wild.sheet.points[wild.driven]
    run = drive(wild, lambda t: rest + t * specimen.flow[wild.driven], 4000, 40)
    assert run.stopped.startswith("the run diverged at ")
    assert "near u = " in run.stopped
    assert "what came before is kept" in run.stopped
    assert 2 <= len(run.frames) < 41
    assert run.balance_error < 0.5
    assert all(np.isfinite(f.points).all() for f in run.frames)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: uniaxial(Cloth(), speed=0.0), "speed must be above 0"),
        (lambda: uniaxial(Cloth(), displacement=-3.0), "displacement and speed must be above 0"),
        (lambda: uniaxial(Cloth(), steps=10, frames=50), "10 steps are too few for 50 frames"),
        (lambda: uniaxial(Cloth(), angle=95.0), "angle from 0 to 90"),
        (lambda: picture_frame(Cloth(), shear=[30.0, 10.0]), "must ascend"),
        (lambda: picture_frame(Cloth(), shear=[95.0]), "below 90 degrees"),
        (lambda: picture_frame(Cloth(), side=0.0), "a side and a speed above 0"),
        (
            lambda: picture_frame(Cloth(), shear=[1.0, 2.0, 3.0], steps=2),
            "2 steps are too few for 3 readings; take at",
        ),
        (lambda: biaxial_specimen(Cloth(), grip=300.0), "grips no wider"),
        (lambda: rectangle(0, 3, 1.0), "a cell or more"),
        (lambda: Fibre(modulus=-1.0), "fibre modulus must be 0 MPa or more; got -1"),
        (lambda: Fibre(undulation=-0.1), "undulation must be 0"),
        (lambda: Fibre(compression=2.0), "between 0 and 1"),
        (lambda: Fibre(share=1.5), "between 0 and 1"),
        (lambda: Resin(modulus=float("nan")), "resin modulus must be 0 MPa or more"),
        (lambda: Resin(poisson=0.5), "below 0.5; got 0.5"),
        (lambda: Resin(strain="small"), "no strain 'small'"),
        (lambda: Resin(thickness="thin"), "no thickness rule 'thin'"),
        (lambda: Resin(strain="green", thickness="constant"), "'green' .* knows no constant thickness"),
        (lambda: Cloth(thickness=0.0), "thickness of the cloth must be above 0 mm"),
        (lambda: Cloth(density=-1.0), "density of the cloth must be above 0"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(call: object, said: str) -> None:
    with pytest.raises(FormingError, match=said):
        call()  # type: ignore[operator]


@pytest.mark.parametrize(
    ("shares", "times", "said"),
    [
        ((0.1, 0.2), (10.0, 1.0), "must ascend; sort 10, 1"),
        ((0.1,), (0.0,), "above 0 s"),
        ((0.6, 0.5), (1.0, 2.0), "less than 1"),
        ((0.1,), (1.0, 2.0), "a time for each share"),
        ((-0.1,), (1.0,), "0 or more"),
    ],
)
def test_a_relaxation_that_cannot_be_is_refused(shares: tuple, times: tuple, said: str) -> None:
    from geomdrap.forming import Relaxation

    with pytest.raises(FormingError, match=said):
        Relaxation(shares, times)
