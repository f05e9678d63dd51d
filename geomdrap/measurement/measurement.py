"""A measured table as arrays: where marks of the fabric lie on the part, and how it shears there."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace

import numpy as np

from geomdrap.errors import MeasurementError
from geomdrap.surface.findings import count


@dataclass(frozen=True, eq=False)
class Measurement:
    """Measured points of a draped ply, a row each.

    ``source`` is the file's name, for messages. ``points`` (n, 3) mm. ``u``, ``v`` (n,) mm: fabric coordinates of
    marks drawn on the flat fabric, None where there were none. ``shear`` (n,) degrees, NaN where it was not
    measured, or None. ``warp``, ``weft`` (n, 3) unit fibre directions, with either sign, NaN where not measured,
    or None. ``sigma_xyz`` (n,) mm per coordinate, ``sigma_shear`` and ``sigma_direction`` (n,) degrees: standard
    deviations of the rows, NaN where the table leaves them open, or None. ``replicate`` (n,) number of the
    repetition, or None. ``row`` (n,) line in the file. ``notes`` say what the reader did, ``warnings`` what the
    user should look at.
    """

    source: str
    points: np.ndarray
    u: np.ndarray | None = None
    v: np.ndarray | None = None
    shear: np.ndarray | None = None
    warp: np.ndarray | None = None
    weft: np.ndarray | None = None
    sigma_xyz: np.ndarray | None = None
    sigma_shear: np.ndarray | None = None
    sigma_direction: np.ndarray | None = None
    replicate: np.ndarray | None = None
    row: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        points = np.asarray(self.points, dtype=float)
        if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
            raise MeasurementError(f"{self.source}: points must be finite numbers (n, 3), not {points.shape}")
        object.__setattr__(self, "points", points)
        if len(self.row) == 0:
            object.__setattr__(self, "row", np.arange(1, len(points) + 1))
        for name, values in self._arrays():
            if len(values) != len(points):
                raise MeasurementError(
                    f"{self.source}: {name} has {len(values)} rows, but there are {len(points)} points"
                )
        if (self.u is None) != (self.v is None):
            raise MeasurementError(f"{self.source}: u and v go together; give both or neither")

    def __len__(self) -> int:
        return len(self.points)

    @property
    def labelled(self) -> bool:
        """Whether the points are marks with known fabric coordinates."""
        return self.u is not None

    def take(self, rows: np.ndarray) -> Measurement:
        """The same measurement with only those rows (numbers, or (n,) bool)."""
        return replace(self, **{name: values[rows] for name, values in self._arrays()})

    def _arrays(self) -> list[tuple[str, np.ndarray]]:
        """Names and arrays of all columns that there are."""
        held = ((f.name, getattr(self, f.name)) for f in fields(self))
        return [(name, values) for name, values in held if isinstance(values, np.ndarray)]


def require_values(measurement: Measurement, parameters: int, purpose: str) -> None:
    """Raise MeasurementError where a table holds too few measured values for so many unknowns.

    A labelled position counts 3 values (1 without labels: the distance from the part), a shear angle 1.
    """
    values = len(measurement) * (3 if measurement.labelled else 1)
    if measurement.shear is not None:
        values += int(np.isfinite(measurement.shear).sum())
    if values <= parameters or len(measurement) == 0:
        raise MeasurementError(
            f"{measurement.source} holds {count(len(measurement), 'point')} with {count(values, 'measured value')}, "
            f"too few for {purpose}, which has {parameters} unknowns: measure more points"
        )
