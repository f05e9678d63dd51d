"""What a diagnosis holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.criticism.evidence import Evidence
    from geomdrap.criticism.experiment import Experiment
    from geomdrap.criticism.leftover import Leftover
    from geomdrap.criticism.likelihood import Scatter
    from geomdrap.fishnet import Effect
    from geomdrap.measurement.outliers import Outlier

NONE, PLACEMENT, AMBIGUOUS, UNKNOWN = "none", "placement", "ambiguous", "unknown"


@dataclass(frozen=True)
class Value:
    """A fitted parameter: ``value`` and standard deviation ``sigma``, in ``unit``; infinite where it is not seen."""

    name: str
    value: float
    sigma: float
    unit: str

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval."""
        return self.value - 1.96 * self.sigma, self.value + 1.96 * self.sigma


@dataclass(frozen=True)
class Tried:
    """An effect that was tried: its ``values``, ``evidence`` and errors, and whether it was ``selected``.

    ``rms_position`` mm and ``rms_shear`` degrees, None where not measured; ``cv_error``: held out, over the noise.
    ``confounded_with`` lists effects whose signature on these points is nearly the same; ``visible`` holds for each
    parameter how far from its neutral value these data would show it, None where they would not. ``looked_at_only``:
    a first look promised too little for a fit; the values are those at which it does nothing, sigma is infinite.
    """

    name: str
    values: tuple[Value, ...]
    evidence: Evidence
    rms_position: float | None
    rms_shear: float | None
    cv_error: float
    confounded_with: tuple[str, ...]
    visible: tuple[tuple[str, float | None, str], ...]
    selected: bool
    looked_at_only: bool = False


@dataclass(frozen=True)
class Step:
    """A model on the way: the effect ``added`` (None for the model without), and its errors.

    ``error`` and ``cv_error`` (held out) are root mean squares over the noise.
    """

    added: str | None
    error: float
    cv_error: float
    rms_position: float | None
    rms_shear: float | None


@dataclass(frozen=True, eq=False, repr=False)
class Diagnosis:
    """Which effect is missing in the model.

    ``verdict``: none, placement, an effect, two with a plus, ambiguous or unknown; ``candidates`` the effects that
    explain the measurement; ``confidence`` 0 to 1; ``tried`` every effect, the likeliest first; ``steps`` the models:
    the net as it was meant, with its placement fitted, with each effect added; ``noise_floor`` the error of a perfect
    model, over the noise; ``placement`` the fitted one; ``effects`` of the final model with their values, the
    placement first; ``scatter`` of the lay-up; ``leftover`` what the final model leaves; ``hints`` what to do next or
    to measure.
    """

    verdict: str
    candidates: tuple[str, ...]
    confidence: float
    experiment: Experiment
    steps: tuple[Step, ...]
    noise_floor: float
    placement: tuple[Value, ...]
    tried: tuple[Tried, ...]
    effects: tuple[Effect, ...]
    scatter: Scatter
    leftover: Leftover
    outliers: tuple[Outlier, ...]
    hints: tuple[str, ...]
    notes: tuple[str, ...]

    def __repr__(self) -> str:
        return f"Diagnosis({self.verdict!r}, candidates={self.candidates!r}, confidence={self.confidence:.3g})"

    @property
    def warnings(self) -> tuple[str, ...]:
        """What speaks against the measured table as a whole: labels that look swapped, a unit that is doubtful."""
        return self.experiment.warnings

    def as_dict(self) -> dict[str, object]:
        """The diagnosis as JSON has it (schema geomdrap.diagnose/1)."""
        return {
            "schema": "geomdrap.diagnose/1",
            "verdict": self.verdict,
            "candidates": list(self.candidates),
            "confidence": rounded(self.confidence),
            "points": len(self.experiment.measurement),
            "used": int(self.experiment.mask.any(axis=1).sum()),
            "outliers": [o.line for o in self.outliers],
            "baseline": self._baseline(),
            "effects": [_tried(t) for t in self.tried],
            "noise_floor": rounded(self.noise_floor),
            "scatter": {"size": rounded(self.scatter.size), "length": rounded(self.scatter.length)}
            if self.scatter.size > 0.0
            else None,
            "leftover": {
                "p_value": rounded(self.leftover.p_value),
                "size": rounded(self.leftover.size),
                "structured": self.leftover.structured,
                "doubtful": self.leftover.doubtful,
            },
            "hints": list(self.hints),
            "warnings": list(self.warnings),
            "notes": list(self.notes),
        }

    def _baseline(self) -> dict[str, object]:
        base = self.steps[1]
        return {
            "placement": _values(self.placement),
            "error": rounded(base.error),
            "cv_error": rounded(base.cv_error),
            "rms_position": rounded(base.rms_position),
            "rms_shear": rounded(base.rms_shear),
        }


def _tried(t: Tried) -> dict[str, object]:
    return {
        "name": t.name,
        "parameters": _values(t.values),
        "rms_position": rounded(t.rms_position),
        "rms_shear": rounded(t.rms_shear),
        "cv_error": rounded(t.cv_error),
        "p_value": rounded(t.evidence.p_family),
        "share": rounded(t.evidence.share),
        "gain": rounded(t.evidence.gain),
        "confounded_with": list(t.confounded_with),
        "visible_from": {name: rounded(amount) for name, amount, _ in t.visible},
        "selected": t.selected,
        "looked_at_only": t.looked_at_only,
    }


def _values(values: tuple[Value, ...]) -> dict[str, dict[str, object]]:
    return {v.name: {"value": rounded(v.value), "sigma": rounded(v.sigma), "unit": v.unit} for v in values}


def rounded(number: float | None) -> float | None:
    """A number as it is printed: six digits, None for what is not there."""
    if number is None or not np.isfinite(number):
        return None
    return float(f"{number:.6g}")
