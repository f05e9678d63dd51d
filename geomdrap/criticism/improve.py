"""``improve``: the missing effects added one by one, and how the error falls."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from geomdrap.criticism.diagnose import diagnose
from geomdrap.criticism.diagnosis import UNKNOWN, Diagnosis, Value

if TYPE_CHECKING:
    from geomdrap.fishnet import Effect
    from geomdrap.measurement import Measurement
    from geomdrap.surface import Surface


@dataclass(frozen=True, eq=False)
class Improvement:
    """A model made better: the ``diagnosis`` that it rests on, whose ``steps`` are the falling error."""

    diagnosis: Diagnosis

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The improved model: placement and effects with their values."""
        return self.diagnosis.effects

    @property
    def unexplained(self) -> float:
        """Share of the first misfit above the noise floor that the improved model leaves, 0 to 1."""
        first, last = self.diagnosis.steps[0].error, self.diagnosis.steps[-1].error
        floor = self.diagnosis.noise_floor
        above = first**2 - floor**2
        return min(max((last**2 - floor**2) / above, 0.0), 1.0) if above > 0.0 else 0.0

    @property
    def notes(self) -> tuple[str, ...]:
        """What the model file says of itself."""
        d = self.diagnosis
        if d.verdict == UNKNOWN:
            return (f"incomplete: {100 * self.unexplained:.0f} % of the misfit has no known cause",)
        if len(d.candidates) > 1 and d.verdict == "ambiguous":
            return (f"one of several that explain the measurement equally well: {', '.join(d.candidates)}",)
        return ()

    def _values(self) -> Iterator[tuple[str, tuple[Value, ...]]]:
        """Placement and effects of the model with their values and standard deviations."""
        names = [e.name for e in self.effects]
        known = {t.name: t.values for t in self.diagnosis.tried if t.selected}
        known["placement"] = self.diagnosis.placement
        yield from ((name, known[name]) for name in names if name in known)

    def as_dict(self, model: str | None = None) -> dict[str, Any]:
        """The improvement as JSON has it (schema geomdrap.improve/1); ``model`` is the path of the model file."""
        from geomdrap.criticism.diagnosis import rounded

        d = self.diagnosis
        return {
            "schema": "geomdrap.improve/1",
            "steps": [
                {
                    "added": s.added,
                    "error": rounded(s.error),
                    "cv_error": rounded(s.cv_error),
                    "rms_position": rounded(s.rms_position),
                    "rms_shear": rounded(s.rms_shear),
                }
                for s in d.steps
            ],
            "noise_floor": rounded(d.noise_floor),
            "verdict": d.verdict,
            "candidates": list(d.candidates),
            "unexplained": rounded(self.unexplained),
            "confidence": rounded(d.confidence),
            "parameters": {e.name: {k: rounded(v) for k, v in e.values.items()} for e in d.effects},
            "sigma": {name: {v.name: rounded(v.sigma) for v in values} for name, values in self._values()},
            "model": model,
            "hints": list(d.hints),
            "warnings": list(d.warnings),
            "notes": [*self.notes, *d.notes],
        }


def improve(surface: Surface, measurement: Measurement, **options: Any) -> Improvement:
    """Find the effects that a model lacks, one after another, until the noise floor; options as for ``diagnose``.

    Raises MeasurementError where the measurement does not go with the part.
    """
    return Improvement(diagnose(surface, measurement, **options))
