"""A case of a sweep, what all cases share, and what becomes of one."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from geomdrap.errors import GeomdrapError, interrupt_within
from geomdrap.fields import evaluate
from geomdrap.fields.figures import figures
from geomdrap.fishnet import drape
from geomdrap.sweep.row import Row, failed, row_of_figures

if TYPE_CHECKING:
    from geomdrap.fields import Drape
    from geomdrap.fishnet import Effect, Net
    from geomdrap.surface import Surface


@dataclass(frozen=True)
class Case:
    """Where a ply touches first, ``"centroid"`` or a point (x, y, z) mm on the part, and its heading in degrees."""

    origin: str | tuple[float, float, float]
    angle: float


@dataclass(frozen=True, eq=False)
class Job:
    """What all cases of a sweep share: the part, and how it is draped (see ``geomdrap.drape``)."""

    surface: Surface
    pitch: float | None = None
    reach: tuple[float, float] | None = None
    limit_angle: float | None = None
    effects: tuple[Effect, ...] = ()
    reference: tuple[float, float, float] | None = None

    def drape(self, case: Case) -> Net:
        """The net of a case. Raises what ``geomdrap.drape`` raises."""
        return drape(
            self.surface, case.origin, case.angle, self.pitch, self.reach,
            effects=self.effects, reference=self.reference, project=True,
        )  # fmt: skip

    def evaluate(self, case: Case) -> Drape:
        """Everything about the drape of a case. Raises what ``geomdrap.drape`` raises."""
        return evaluate(self.drape(case), self.limit_angle)

    def row(self, case: Case) -> Row:
        """The row of a case; one that cannot be draped is a row with the reason. Raises KeyboardInterrupt."""
        try:
            net = self.drape(case)
            return row_of_figures(case.origin, net, figures(net, self.limit_angle))
        except GeomdrapError as error:
            return failed(case.origin, case.angle, str(error))
        except MemoryError:
            return failed(case.origin, case.angle, "not enough memory; a larger pitch needs less")
        except Exception as error:  # hours of other cases must not be lost by one
            interrupt = interrupt_within(error)
            if interrupt is not None:
                raise interrupt from None
            return failed(case.origin, case.angle, f"this is a bug in geomdrap ({type(error).__name__}: {error})")

    def settings(self) -> dict[str, Any]:
        """What must be the same for rows to be comparable, as JSON holds it."""
        effects = [[effect.title(), getattr(effect, "values", {})] for effect in self.effects]
        return {
            "part": fingerprint(self.surface),
            "pitch": self.pitch,
            "blank": None if self.reach is None else [2.0 * r for r in self.reach],
            "limit_angle": self.limit_angle,
            "effects": sorted(effects, key=str),
            "reference": None if self.reference is None else list(self.reference),
        }


def fingerprint(surface: Surface) -> str:
    """A number that two parts share only if their meshes are the same, to the last bit."""
    parts = (surface.points.tobytes(), surface.triangles.tobytes())
    return hashlib.sha256(b"".join(parts)).hexdigest()[:32]
