"""A measured curve of a bias-extension test, the pin-jointed theory of it, and what a theory may lack.

A strip of length L and width W, cut at 45° and pulled by δ, shears in its middle as a pin-jointed net with
cos((90° − γ)/2) = (D + δ)/(√2 D), D = L − W, as long as its yarns neither stretch nor slip
(J. Cao et al., Composites A 39 (2008) 1037, equation of the pure-shear zone). Each effect changes that by one idea.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import MeasurementError

Array = NDArray[np.float64]
Model = Callable[[Array, Array, float], Array]
"""(displacement (n,) mm, parameters (k,), D mm) -> shear (n,) deg."""


@dataclass(frozen=True)
class Curve:
    """Shear (n,) deg at displacements (n,) mm, by one method of reading; ``length`` D = L − W in mm."""

    series: str
    displacement: Array
    shear: Array
    length: float

    def part(self, chosen: NDArray[np.bool_]) -> Curve:
        """Give the chosen points alone."""
        return Curve(self.series, self.displacement[chosen], self.shear[chosen], self.length)


def read_curves(path: str | Path, length: float, width: float) -> dict[str, Curve]:
    """Read a table ``series,displacement,shear`` (mm, deg; lines with # are notes): a curve per series.

    ``length`` and ``width`` of the specimen, mm. MeasurementError names the file and what is wrong with it.
    """
    if not length > width > 0.0:
        raise MeasurementError(f"a bias-extension strip is longer than wide; got {length:g} × {width:g} mm")
    try:
        lines = [x for x in Path(path).read_text(encoding="utf-8").splitlines() if x.strip() and x[0] != "#"]
    except (OSError, UnicodeDecodeError):
        raise MeasurementError(f"{path} cannot be read as a table of text; name a CSV file") from None
    if not lines or lines[0].replace(" ", "") != "series,displacement,shear":
        raise MeasurementError(f"{path} does not start with the header series,displacement,shear; add it")
    rows = [_row(path, number, line) for number, line in enumerate(lines[1:], 1)]
    if not rows:
        raise MeasurementError(f"{path} has a header and no points; add some")
    found: dict[str, Curve] = {}
    for name in dict.fromkeys(row[0] for row in rows):
        points = np.array(sorted(row[1:] for row in rows if row[0] == name))
        found[name] = Curve(name, points[:, 0], points[:, 1], length - width)
    return found


def _row(path: str | Path, number: int, line: str) -> tuple[str, float, float]:
    try:
        name, displacement, shear = line.split(",")
        row = name.strip(), float(displacement), float(shear)
    except ValueError:
        row = "", np.nan, np.nan
    if not np.all(np.isfinite(row[1:])):
        raise MeasurementError(f"{path}, point {number}: '{line}' is not a series and two numbers; correct it")
    return row


def pin_jointed(displacement: Array, length: float) -> Array:
    """Shear (n,) deg at ``displacement`` (n,) mm of a net whose yarns keep their length, D = ``length`` mm."""
    cosine = (length + displacement) / (np.sqrt(2.0) * length)
    shear: Array = 90.0 - 2.0 * np.rad2deg(np.arccos(np.clip(cosine, -1.0, 1.0)))
    return shear


@dataclass(frozen=True)
class Parameter:
    """A parameter: where to start looking for it, and what is physically plausible, in ``unit``."""

    name: str
    unit: str
    starts: tuple[float, ...]
    low: float
    high: float


@dataclass(frozen=True)
class CurveEffect:
    """A theory of the curve, or a theory with what it may lack: a model of the curve and its parameters."""

    name: str
    summary: str
    model: Model
    parameters: tuple[Parameter, ...] = ()
    single: bool = True
    """Whether it is one cause and not a combination."""


_SLACK = Parameter("slack", "mm", (5.0,), 0.0, 8.0)
_SHARE = Parameter("share", "", (0.1,), 0.0, 0.3)
_ONSETS = (10.0, 30.0, 50.0)

Base = Callable[[Array], Array]
"""Displacement (n,) mm -> shear (n,) deg, by the theory alone."""


@dataclass(frozen=True)
class Idea:
    """One thing that a theory of the curve may lack: how it ``bends`` the curve of the theory."""

    name: str
    summary: str
    bends: Callable[[Base, Array, Array, float], Array]
    parameters: tuple[Parameter, ...]
    single: bool = True


def _saturated(base: Base, d: Array, p: Array, length: float) -> Array:
    shear = base(d)
    return shear - p[0] * np.maximum(shear - p[1], 0.0)


def _stretched(displacement: Array, length: float, strain: Array | float) -> Array:
    """The displacement at which unstretched yarns shear as much as those longer by ``strain`` do."""
    return np.asarray((length + displacement) / (1.0 + np.asarray(strain)) - length)


IDEAS = (
    Idea(
        "pre-shear",
        "the cloth was sheared before the test",
        lambda base, d, p, length: base(d) + p[0],
        (Parameter("shear", "deg", (-1.0,), -3.0, 3.0),),
    ),
    Idea(
        "clamp slack",
        "the clamps move before the cloth does",
        lambda base, d, p, length: base(d - p[0]),
        (_SLACK,),
    ),
    Idea(
        "constant extension",
        "yarns are longer than thought, by straightened crimp",
        lambda base, d, p, length: base(_stretched(d, length, p[0])),
        (Parameter("strain", "", (0.01,), 0.0, 0.02),),
    ),
    Idea(
        "saturation",
        "beyond an onset a share of the shear is resisted (locking)",
        _saturated,
        (Parameter("share", "", (0.1, 0.4), 0.0, 1.0), Parameter("onset", "deg", (5.0, 25.0), -2.0, 60.0)),
    ),
    Idea(
        "growing extension",
        "yarns stretch in proportion to the displacement",
        lambda base, d, p, length: base(_stretched(d, length, p[0] * d / 100.0)),
        (Parameter("strain per 100 mm", "", (0.01,), 0.0, 0.02),),
    ),
    Idea(
        "slip",
        "a share of the displacement is slip at the crossings",
        lambda base, d, p, length: base(d * (1.0 - p[0])),
        (_SHARE,),
    ),
    Idea(
        "slack + slip from an onset",
        "the clamps slack, and slip sets in at a displacement",
        lambda base, d, p, length: base(d - p[0] - p[1] * np.maximum(d - p[2], 0.0)),
        (_SLACK, _SHARE, Parameter("onset", "mm", _ONSETS, 0.0, 120.0)),
        single=False,
    ),
)


def effects_on(theory: CurveEffect) -> dict[str, CurveEffect]:
    """``theory`` alone, and with each of the ideas on top; parameters of the idea come before those of the theory."""
    return {theory.name: theory, **{idea.name: _on(theory, idea) for idea in IDEAS}}


def _on(theory: CurveEffect, idea: Idea) -> CurveEffect:
    own = len(idea.parameters)

    def model(d: Array, p: Array, length: float) -> Array:
        return idea.bends(lambda moved: theory.model(moved, p[own:], length), d, p[:own], length)

    return CurveEffect(idea.name, idea.summary, model, (*idea.parameters, *theory.parameters), idea.single)


EFFECTS = effects_on(CurveEffect("pin-jointed", "nothing is missing", lambda d, p, length: pin_jointed(d, length)))
"""The effects on the pin-jointed theory, by name; the first is the theory itself."""
