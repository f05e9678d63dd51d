"""From a measured table to an experiment: pitch of the model, frames, noise, outliers."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.experiment import CHANNELS, COARSE, FINE, Experiment, Layup, flatten, predicted
from geomdrap.errors import MeasurementError

if TYPE_CHECKING:
    from geomdrap.fishnet import Net
    from geomdrap.measurement import Measurement
    from geomdrap.surface import Surface

MOST_POINTS = 600  # with a dense covariance; more points are thinned out evenly
NEIGHBOURS = 8
OUTLIER = 5.0  # robust standard deviations from what the neighbours say
UNDERSTATED = 1.25  # noise this much larger than said is believed instead


def prepare(
    surface: Surface,
    measurement: Measurement,
    layup: Layup,
    sigma_xyz: float | None = None,
    sigma_shear: float | None = None,
) -> tuple[Experiment, tuple[str, ...]]:
    """The experiment and notes on what was chosen.

    ``sigma_xyz`` mm and ``sigma_shear`` degrees apply where the table has no noise of its own; with neither, noise is
    read from how neighbouring residuals differ. Raises MeasurementError where nothing can be compared.
    """
    notes: list[str] = []
    measurement = thinned(measurement, notes)
    pitches = _pitches(surface, measurement, layup)
    lay = replace(layup, pitch=pitches[0])
    bare = Experiment(
        surface, measurement, lay, np.zeros((0, 2)), np.zeros((0, 3, 3)), (), np.zeros((0, 0), bool), np.zeros(0),
        np.zeros(0), pitches,
    )  # fmt: skip
    net = bare.draped()
    at, frames = places(net, measurement)
    channels, values, sigma = measured_table(measurement, frames, sigma_xyz, sigma_shear)
    table = predicted(net, measurement, frames, channels)
    mask = np.isfinite(values) & np.isfinite(table) & np.isfinite(at).all(axis=1)[:, None]
    if not mask.any():
        raise MeasurementError(
            f"{measurement.source}: the model predicts none of the {len(measurement)} points; check the origin, the "
            "heading and the unit of the table"
        )
    residual = values - table
    for c, name in enumerate(channels):
        heard = local_noise(at, residual[:, c], mask[:, c])
        said = np.nanmedian(sigma[mask[:, c], c]) if mask[:, c].any() else np.nan
        if np.isfinite(said) and heard > UNDERSTATED * said:
            notes.append(f"neighbouring residuals of {name} differ by {heard:.3g}, more than the noise given, {said:.3g}")
            sigma[:, c] *= heard / said
        sigma[:, c] = np.where(np.isfinite(sigma[:, c]), sigma[:, c], max(heard, 1e-9))
    mask &= ~outliers(at, residual, mask, sigma)[:, None]
    experiment = Experiment(
        surface, measurement, lay, at, frames, channels, mask, flatten(sigma, mask), flatten(values, mask), pitches
    )
    return experiment, tuple(notes)


def thinned(measurement: Measurement, notes: list[str]) -> Measurement:
    """At most ``MOST_POINTS`` points, spread evenly over the table's order along the part's longest direction."""
    n = len(measurement)
    if n <= MOST_POINTS:
        return measurement
    notes.append(f"{MOST_POINTS} of {n} points were used, spread evenly")
    rng = np.random.default_rng(0)
    order = np.lexsort(np.round(measurement.points, 6).T)  # the same points whatever the order of the rows
    return measurement.take(np.sort(order[rng.permutation(n)[:MOST_POINTS]]))


def _pitches(surface: Surface, measurement: Measurement, layup: Layup) -> tuple[float, float]:
    """Pitches of the fine and of the coarse net: by the numbers of nodes, dividing the spacing of the marks."""
    from geomdrap.measurement.marks import mark_spacing, pitch_for_marks

    spacing = mark_spacing(measurement.u)
    fine = layup.pitch or pitch_for_marks(spacing, float(np.sqrt(surface.area / FINE)))
    coarse = max(pitch_for_marks(spacing, float(np.sqrt(surface.area / COARSE))), fine)
    return fine, coarse


def places(net: Net, measurement: Measurement) -> tuple[np.ndarray, np.ndarray]:
    """Fabric coordinates (n, 2) mm and frames (n, 3, 3) along the warp, across it, along the normal."""
    from geomdrap.measurement.match import match

    found = match(net, measurement)
    across = np.cross(found.normal, found.warp)
    return np.column_stack([found.u, found.v]), np.stack([found.warp, across, found.normal], axis=1)


def measured_table(
    measurement: Measurement, frames: np.ndarray, sigma_xyz: float | None, sigma_shear: float | None
) -> tuple[tuple[str, ...], np.ndarray, np.ndarray]:
    """Channels (c,), measured values (n, c) and their noise (n, c), NaN where it is not known."""
    n = len(measurement)
    names, values, noise = [], [], []
    spread = _noise(measurement.sigma_xyz, sigma_xyz, n)
    turned = _noise(measurement.sigma_shear, sigma_shear, n)
    for name in CHANNELS[:3] if measurement.labelled else ("normal",):
        names.append(name)
        values.append(np.einsum("nk,nk->n", measurement.points, frames[:, CHANNELS.index(name)]))
        noise.append(spread)
    if measurement.shear is not None:
        names.append("shear")
        values.append(measurement.shear)
        noise.append(turned)
    for name in ("warp", "weft"):
        direction = getattr(measurement, name)
        if direction is not None:
            names.append(name)
            values.append(np.where(np.isfinite(direction).all(axis=1), 0.0, np.nan))
            noise.append(turned)
    return tuple(names), np.column_stack(values), np.column_stack(noise)


def _noise(own: np.ndarray | None, said: float | None, n: int) -> np.ndarray:
    default = np.nan if said is None else said
    if own is None:
        return np.full(n, default)
    return np.where(np.isfinite(own), own, default)


def beside(at: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """For each of ``rows`` the nearest others among them (k, NEIGHBOURS), as numbers of points."""
    from scipy.spatial import cKDTree

    count = min(NEIGHBOURS + 1, len(rows))
    return rows[cKDTree(at[rows]).query(at[rows], k=count)[1].reshape(len(rows), count)[:, 1:]]


def local_noise(at: np.ndarray, residual: np.ndarray, known: np.ndarray) -> float:
    """Standard deviation of values (n,) about the plane through their neighbours, robust against outliers."""
    rows = np.flatnonzero(known)
    if len(rows) < NEIGHBOURS + 1:
        return float(np.nanstd(residual[rows])) if len(rows) > 1 else np.nan
    near = beside(at, rows)
    misses = []
    for k, others in zip(rows, near, strict=True):
        a = np.column_stack([np.ones(len(others)), at[others] - at[k]])
        weights = np.linalg.lstsq(a.T, np.array([1.0, 0.0, 0.0]), rcond=1e-9)[0]  # of the plane at the point itself
        misses.append((residual[k] - weights @ residual[others]) / np.sqrt(1.0 + weights @ weights))
    return float(1.4826 * np.median(np.abs(misses)))


def outliers(at: np.ndarray, residual: np.ndarray, mask: np.ndarray, sigma: np.ndarray) -> np.ndarray:
    """Which points (n,) are far from what their neighbours say, in any channel."""
    out = np.zeros(len(at), bool)
    for c in range(mask.shape[1]):
        rows = np.flatnonzero(mask[:, c])
        if len(rows) < NEIGHBOURS + 1:
            continue
        near = beside(at, rows)
        away = np.abs(residual[rows, c] - np.median(residual[near, c], axis=1))
        spread = np.maximum(1.4826 * np.median(away), 1.2 * sigma[rows, c])
        out[rows[away > OUTLIER * spread]] = True
    return out
