"""The mechanical model as the theory of a bias-extension curve, and what it may lack.

The model finds the shear that balances the forces, which the pin-jointed formula of three zones does not. Its own two
parameters that bend the curve, the modulus and the undulation of the yarns, are tried beside the ideas that it leaves
out. A few runs over each, interpolated, stand for the model while values are fitted.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from geomdrap.criticism.curve import Array, CurveEffect, Parameter, effects_on
from geomdrap.errors import FormingError
from geomdrap.forming import Cloth
from geomdrap.forming.coupon import bias_extension

LOGARITHMS = (-2.0, -1.5, -1.0, -0.5, 0.0, 0.5)
"""Decimal logarithms of the factors by which the modulus of the yarns is run."""
UNDULATIONS = (0.0, 0.005, 0.01, 0.02, 0.04)
SOFTER = Parameter("log modulus factor", "", (-0.5,), -1.0, 0.5)
UNDULATED = Parameter("undulation", "", (0.01,), 0.0, 0.02)


class DivergedError(FormingError):
    """A run of the model over which its parameters were to be tried did not reach the end of the curve."""


def mechanical_effects(
    cloth: Cloth,
    length: float,
    width: float,
    furthest: float,
    cells: int = 10,
    progress: Callable[[float], None] | None = None,
    **settings: Any,
) -> dict[str, CurveEffect]:
    """Effects on the curve of a strip of ``length`` × ``width`` mm of ``cloth``, pulled by up to ``furthest`` mm.

    The first is the model itself. Displacements below 0 are taken on straight, since clamps may slack. ``settings``
    (``speed``, …) are those of `bias_extension`. DivergedError where a run ends early.
    """
    from scipy.interpolate import CubicSpline

    own_undulation = cloth.warp.undulation
    cases = [(10.0**power, own_undulation) for power in LOGARITHMS] + [(1.0, u) for u in UNDULATIONS]
    curves: dict[tuple[float, float], Any] = {}

    def run(factor: float, undulation: float) -> Any:
        changed = replace(
            cloth,
            warp=replace(cloth.warp, modulus=factor * cloth.warp.modulus, undulation=undulation),
            weft=replace(cloth.weft, modulus=factor * cloth.weft.modulus, undulation=undulation),
        )
        pulled = bias_extension(changed, furthest, length, width, cells=cells, **settings).result
        if pulled.stopped:
            case = f"with the modulus of the yarns times {factor:.3g} and an undulation of {undulation:g}"
            raise DivergedError(f"the model cannot stand for the curve {case}: {pulled.stopped}")
        return CubicSpline(pulled.displacement, pulled.shear)

    for number, case in enumerate(dict.fromkeys(cases), 1):
        curves[case] = run(*case)
        if progress:
            progress(number / len(set(cases)))
    softer, undulated = ([curves[c] for c in part] for part in (cases[: len(LOGARITHMS)], cases[len(LOGARITHMS) :]))
    itself = curves[1.0, own_undulation]
    theory = CurveEffect("mechanical", "nothing is missing", lambda d, p, _: _read(itself, d, furthest))
    own = (
        _family("softer yarns", "the yarns are softer than thought", SOFTER, LOGARITHMS, softer, furthest),
        _family("undulation", "the yarns are crimped", UNDULATED, UNDULATIONS, undulated, furthest),
    )
    return {**effects_on(theory), **{effect.name: effect for effect in own}}


def _read(curve: Any, displacement: Array, furthest: float) -> Array:
    d = np.asarray(displacement, dtype=np.float64)
    inside = np.clip(d, 0.0, furthest)
    return np.asarray(curve(inside) + (d - inside) * curve(inside, 1))


def _family(
    name: str, summary: str, parameter: Parameter, knots: Sequence[float], curves: Sequence[Any], furthest: float
) -> CurveEffect:
    """The effect of one parameter, from curves at its ``knots``; beyond them it has none."""
    from scipy.interpolate import CubicSpline

    def model(displacement: Array, values: Array, _: float) -> Array:
        rows = np.stack([_read(c, displacement, furthest) for c in curves])
        return np.asarray(CubicSpline(knots, rows, axis=0)(np.clip(values[0], knots[0], knots[-1])))

    return CurveEffect(name, summary, model, (parameter,))
