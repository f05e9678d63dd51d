"""Points that do not go with their neighbours: slips of the instrument, and labels off by a mark or two."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.measurement.lines import wrong_lines
from geomdrap.measurement.local import deviations, neighbours, quantile_of_size, robust_sigma
from geomdrap.measurement.marks import mark_spacing

if TYPE_CHECKING:
    from geomdrap.fishnet import Net
    from geomdrap.measurement.match import Matched
    from geomdrap.measurement.measurement import Measurement

LIMIT = 5.0
"""Robust standard deviations beyond which a value is an outlier: 1 in 2 million of normal noise."""

NEARBY = 0.75
"""Quantile of the neighbours' deviations that says what is usual nearby."""

OFF_BY = 2
"""Marks by which a label may be wrong along each axis and still be recognised."""

SAME = 0.25
"""Of the spacing: a mark this close to where another label would lie has that label."""


@dataclass(frozen=True)
class Outlier:
    """A point that stands out: ``row`` its number in the measurement, ``line`` in the file; position or shear.

    ``size`` is what it is off its neighbours by (mm or degrees), ``sigmas`` the same in robust standard deviations;
    those of a line of marks that is off do not stand out beside one another: they are held against the lines beside
    (the prediction where there is none), and may have ``sigmas`` of LIMIT.
    ``shift`` is the number of marks (along warp, weft) by which its label seems wrong, None where it does not.
    """

    row: int
    line: int
    kind: str
    size: float
    sigmas: float
    shift: tuple[int, int] | None = None


def find_outliers(
    net: Net, measurement: Measurement, matched: Matched, sigma_xyz: np.ndarray | None, sigma_shear: np.ndarray | None
) -> tuple[Outlier, ...]:
    """Outliers among the rows with a prediction, judged on the residual against their neighbours on the fabric.

    ``sigma_xyz``, ``sigma_shear`` (n,): noise below which nothing stands out, or None.
    """
    rows = np.flatnonzero(matched.used)
    places = np.column_stack([matched.u, matched.v])[rows]
    residual = measurement.points[rows] - matched.point[rows]
    if not measurement.labelled:
        residual = np.einsum("ij,ij->i", residual, matched.normal[rows])[:, None]
    found = []
    off, sigmas = stand_out(places, residual, None if sigma_xyz is None else sigma_xyz[rows])
    for k in np.flatnonzero(sigmas > LIMIT).tolist():
        shift = _label_shift(net, measurement, int(rows[k]), residual[k] - off[k])
        size = float(np.linalg.norm(off[k]))
        line = int(measurement.row[rows[k]])
        found.append(Outlier(int(rows[k]), line, "position", size, float(sigmas[k]), shift))
    found = _with_lines(found, net, measurement, matched)
    if measurement.shear is not None:
        rows = rows[np.isfinite(measurement.shear[rows])]
        places = np.column_stack([matched.u, matched.v])[rows]
        residual = (measurement.shear - matched.shear)[rows][:, None]
        off, sigmas = stand_out(places, residual, None if sigma_shear is None else sigma_shear[rows])
        for k in np.flatnonzero(sigmas > LIMIT).tolist():
            line = int(measurement.row[rows[k]])
            found.append(Outlier(int(rows[k]), line, "shear", abs(float(off[k, 0])), float(sigmas[k])))
    return tuple(sorted(found, key=lambda outlier: (outlier.line, outlier.kind)))


def _with_lines(found: list[Outlier], net: Net, measurement: Measurement, matched: Matched) -> list[Outlier]:
    """The outliers with all marks that are labelled a mark off along a line."""
    lines, sigmas = wrong_lines(net, measurement), {one.row: one.sigmas for one in found}
    others = [one for one in found if one.row not in lines]
    wrong = [
        Outlier(row, int(measurement.row[row]), "position", off, sigmas.get(row, LIMIT), shift)
        for row, (shift, off) in lines.items()
        if matched.used[row]
    ]
    return [*others, *wrong]


def stand_out(places: np.ndarray, values: np.ndarray, sigma: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
    """Deviations (n, k) from the neighbours, and their size (n,) in robust standard deviations.

    The scale is the largest of: the noise given, what is usual on the whole part, and what is usual nearby (a steep
    place of the residual is no outlier).
    """
    off, factor = deviations(places, values)
    if not np.isfinite(off).any():
        return np.zeros_like(values), np.zeros(len(values))
    scaled = off / factor[:, None]
    size = np.linalg.norm(scaled, axis=1)
    usual = robust_sigma(scaled)
    nearby = np.quantile(size[neighbours(places)], NEARBY, axis=1) / quantile_of_size(NEARBY, values.shape[1])
    least = 0.0 if sigma is None else np.nan_to_num(sigma)
    tiny = 1e-9 * (1.0 + np.abs(values).max())
    scale = np.maximum(np.maximum(np.maximum(usual, nearby), least), tiny)
    return off, size / scale / np.sqrt(_excess(values.shape[1]))


def _excess(width: int) -> float:
    """Factor that makes a limit for one normal number as strict for the size of ``width`` of them."""
    from scipy.special import chdtri

    return float(chdtri(width, 2.0 * _tail()) / LIMIT**2)


def _tail() -> float:
    from scipy.special import ndtr

    return float(ndtr(-LIMIT))


def _label_shift(net: Net, measurement: Measurement, row: int, trend: np.ndarray) -> tuple[int, int] | None:
    """Marks (along warp, weft) by which the label of a row must be moved to lie where it was measured, or None.

    ``trend`` (3,) mm is the residual of its neighbours.
    """
    if measurement.u is None or measurement.v is None:
        return None
    step_u, step_v = mark_spacing(measurement.u), mark_spacing(measurement.v)
    if step_u is None or step_v is None:
        return None
    a, b = (n.ravel() for n in np.mgrid[-OFF_BY : OFF_BY + 1, -OFF_BY : OFF_BY + 1])
    points, _ = net.interpolate(measurement.u[row] + a * step_u, measurement.v[row] + b * step_v)
    away = np.linalg.norm(measurement.points[row] - points - trend, axis=1)
    away[(a == 0) & (b == 0)] = np.inf
    away = np.where(np.isfinite(away), away, np.inf)
    best = int(np.argmin(away))
    return (int(a[best]), int(b[best])) if away[best] < SAME * min(step_u, step_v) else None
