"""A row of a sweep: one case in numbers."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from geomdrap.fields.figures import Figures
    from geomdrap.fishnet import Net

Origin = str | tuple[float, float, float]


@dataclass(frozen=True)
class Row:
    """One case in numbers, or why there are none.

    ``asked`` is the origin as the case has it, ``origin`` (x, y, z) mm where the ply was laid down; ``angle``
    degrees, ``pitch`` mm. Absolute shear in degrees; ``over_limit`` share 0..1 of the draped area over the limit
    angle; ``coverage`` 0..1 of the part; areas mm²; ``blank_length``, ``blank_width`` mm along warp and weft of the
    least rectangle that the ply is cut from, ``waste`` 0..1 the share of it that is cut away. NaN where ``reason``
    says why the case failed.
    """

    asked: Origin
    origin: tuple[float, float, float]
    angle: float
    pitch: float = math.nan
    max_shear: float = math.nan
    p95_shear: float = math.nan
    mean_shear: float = math.nan
    over_limit: float = math.nan
    coverage: float = math.nan
    part_area: float = math.nan
    draped_area: float = math.nan
    fabric_area: float = math.nan
    blank_length: float = math.nan
    blank_width: float = math.nan
    blank_area: float = math.nan
    waste: float = math.nan
    reason: str | None = None

    @property
    def key(self) -> tuple[Origin, float]:
        """By what a row is told from others of its sweep."""
        return self.asked, self.angle


NUMBERS = tuple(f.name for f in fields(Row) if f.name not in ("asked", "origin", "reason"))


def row_of_figures(asked: Origin, net: Net, found: Figures) -> Row:
    """The row of a net."""
    length, width = found.blank
    blank, fabric = length * width, found.area.fabric
    x, y, z = (float(c) for c in net.origin)
    return Row(
        asked=asked,
        origin=(x, y, z),
        angle=net.angle,
        pitch=net.pitch,
        max_shear=found.statistics.max,
        p95_shear=found.statistics.p95,
        mean_shear=found.statistics.mean,
        over_limit=found.statistics.over_limit,
        coverage=found.area.coverage,
        part_area=found.area.part,
        draped_area=found.area.draped,
        fabric_area=fabric,
        blank_length=length,
        blank_width=width,
        blank_area=blank,
        waste=1.0 - fabric / blank if blank > 0.0 else 0.0,
    )


def failed(asked: Origin, angle: float, reason: str) -> Row:
    """The row of a case that could not be draped."""
    nowhere = (math.nan,) * 3
    return Row(asked, nowhere if isinstance(asked, str) else asked, angle, reason=" ".join(reason.split()))


def as_json(row: Row) -> dict[str, Any]:
    """A row as JSON's own values, to the last bit; None for NaN."""
    return {name: _plain(value) for name, value in asdict(row).items()}


def from_json(values: dict[str, Any]) -> Row:
    """The row that ``as_json`` gave. Raises KeyError, TypeError or ValueError where it is none."""
    numbers = {name: math.nan if values[name] is None else float(values[name]) for name in NUMBERS}
    asked, reason = values["asked"], values["reason"]
    if not (isinstance(asked, str) or len(asked) == 3) or not (reason is None or isinstance(reason, str)):
        raise ValueError(asked)
    x, y, z = (math.nan if c is None else float(c) for c in values["origin"])
    point = asked if isinstance(asked, str) else (float(asked[0]), float(asked[1]), float(asked[2]))
    return Row(asked=point, origin=(x, y, z), reason=reason, **numbers)


def _plain(value: Any) -> Any:
    if isinstance(value, (tuple, list)):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
