"""From a measured table to an experiment: pitch of the model, frames, noise, outliers."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.channel_noise import noise_of_channels
from geomdrap.criticism.cleaned import POSITION, spoilt
from geomdrap.criticism.experiment import COARSE, FINE, Experiment, flatten
from geomdrap.criticism.layup import Layup
from geomdrap.criticism.prediction import CHANNELS, predicted
from geomdrap.criticism.smooth import note_on
from geomdrap.errors import MeasurementError
from geomdrap.measurement.marks import mark_spacing, pitch_for_marks
from geomdrap.measurement.match import Matched, match
from geomdrap.measurement.outliers import find_outliers
from geomdrap.measurement.plausible import looks_wrong, require_on_part
from geomdrap.measurement.upright import without_upright

if TYPE_CHECKING:
    from geomdrap.measurement import Measurement
    from geomdrap.surface import Surface

FEWEST_PLACES = 6  # three values of the placement, up to two of an effect, and something to hold them against
MOST_POINTS = 400  # with a dense covariance; more points are thinned out evenly


def prepare(
    surface: Surface,
    measurement: Measurement,
    layup: Layup,
    sigma_xyz: float | None = None,
    sigma_shear: float | None = None,
    sigma_direction: float | None = None,
) -> tuple[Experiment, tuple[str, ...]]:
    """The experiment, without the points that stand out from their neighbours, and notes on what was chosen.

    What speaks against the table as a whole, as labels that look swapped, is among the experiment's ``warnings``.

    ``sigma_xyz`` mm, ``sigma_shear`` and ``sigma_direction`` degrees apply where the table has no noise of its own.
    With neither, noise is read from replicates, else from how neighbouring residuals differ, and a note says so; that
    of directions, where these do not say it, from that of the shear, and that of a few directions of one family from
    the other; where that is not known either, these are left out. Raises MeasurementError where nothing can be
    compared, or points at fewer than ``FEWEST_PLACES`` places.
    """
    measurement = without_upright(surface, measurement)
    warnings = [*measurement.warnings, *require_on_part(surface, measurement)]
    notes = [*note_on(surface)]
    measurement = thinned(measurement, notes)
    lay = replace(layup, pitch=None)
    pitches = _pitches(surface, measurement, layup)
    net = _without_values(surface, measurement, lay, pitches).draped()
    found = match(net, measurement)
    if not found.used.any():
        raise MeasurementError(
            f"{measurement.source}: the model predicts none of the {len(measurement)} points "
            f"({found.reason[0]}); check the origin, the heading and the units of the table"
        )
    warnings += looks_wrong(net, measurement, found)
    at = np.column_stack([found.u, found.v])
    frames = np.stack([found.warp, np.cross(found.normal, found.warp), found.normal], axis=1)
    channels, values = measured_table(measurement, found, frames)
    table = predicted(net, measurement, frames, channels)
    mask = np.isfinite(values) & np.isfinite(table) & np.isfinite(at).all(axis=1)[:, None]
    _require_places(measurement, at, mask)
    given = (sigma_xyz, sigma_shear, sigma_direction)
    sigma, more, doubts = noise_of_channels(measurement, channels, values, values - table, at, given)
    warnings += doubts
    known = np.isfinite(sigma).any(axis=0)
    if not known.all():
        channels, measurement = _with_known_noise(channels, known, measurement)
        values, mask, sigma = values[:, known], mask[:, known], sigma[:, known]
    mask &= ~spoilt(channels, mask.shape, find_outliers(net, measurement, found, *_by_kind(channels, sigma)))
    if not mask.any():
        raise MeasurementError(f"{measurement.source}: every point stands out from its neighbours; check the table")
    _require_places(measurement, at, mask)
    # the seed was near enough to the part; on the surfaces that effects make of it, it may lie further off
    lay = replace(lay, project=True)
    noise, values = flatten(sigma, mask), flatten(values, mask)
    experiment = Experiment(
        surface, measurement, lay, at, frames, channels, mask, noise, values, pitches, tuple(warnings)
    )
    return experiment, (*notes, *more)


def _without_values(
    surface: Surface, measurement: Measurement, layup: Layup, pitches: tuple[float, float]
) -> Experiment:
    """An experiment that knows how to drape, and nothing yet of what was measured."""
    none, nowhere = np.zeros(0), (np.zeros((0, 2)), np.zeros((0, 3, 3)))
    return Experiment(surface, measurement, layup, *nowhere, (), np.zeros((0, 0), bool), none, none, pitches)


def _require_places(measurement: Measurement, at: np.ndarray, mask: np.ndarray) -> None:
    """Raise MeasurementError where the points used lie at too few places ``at`` (n, 2) mm; ``mask`` (n, c)."""
    places = len(np.unique(np.round(at[mask.any(axis=1)], 6), axis=0))
    if places < FEWEST_PLACES:
        raise MeasurementError(
            f"{measurement.source}: points at {places} place{'' if places == 1 else 's'} can be used, too few to say "
            f"which effect is missing (3 values of the placement and up to 2 of an effect are fitted): measure at "
            f"{FEWEST_PLACES} places or more"
        )


def thinned(measurement: Measurement, notes: list[str]) -> Measurement:
    """At most ``MOST_POINTS`` points, the same whatever the order of the rows."""
    n = len(measurement)
    if n <= MOST_POINTS:
        return measurement
    notes.append(f"{MOST_POINTS} of {n} points were used, drawn evenly from all")
    order = np.lexsort(np.round(measurement.points, 6).T)
    return measurement.take(np.sort(order[np.random.default_rng(0).permutation(n)[:MOST_POINTS]]))


def _pitches(surface: Surface, measurement: Measurement, layup: Layup) -> tuple[float, float]:
    """Pitches of the fine and of the coarse net: by the numbers of nodes, dividing the spacing of the marks."""
    spacing = mark_spacing(measurement.u)
    fine = layup.pitch or pitch_for_marks(spacing, float(np.sqrt(surface.area / FINE)))
    coarse = max(pitch_for_marks(spacing, float(np.sqrt(surface.area / COARSE))), fine)
    return fine, coarse


def measured_table(
    measurement: Measurement, found: Matched, frames: np.ndarray
) -> tuple[tuple[str, ...], np.ndarray]:
    """Channels (c,) and measured values (n, c), NaN where there is none."""
    table: dict[str, np.ndarray] = {}
    for name in POSITION if measurement.labelled else ("normal",):
        table[name] = np.einsum("nk,nk->n", measurement.points, frames[:, CHANNELS.index(name)])
    if measurement.shear is not None:
        table["shear"] = measurement.shear
    for name in ("warp", "weft"):
        direction = getattr(measurement, name)
        if direction is not None:
            table[name] = np.where(np.isfinite(direction).all(axis=1), 0.0, np.nan)
    return tuple(table), np.column_stack(list(table.values()))


def _with_known_noise(
    channels: tuple[str, ...], known: np.ndarray, measurement: Measurement
) -> tuple[tuple[str, ...], Measurement]:
    """The channels of ``known`` (c,) noise, and the measurement without the directions of the others."""
    held = tuple(name for name, told in zip(channels, known, strict=True) if told)
    warp, weft = (getattr(measurement, name) if name in held else None for name in ("warp", "weft"))
    return held, replace(measurement, warp=warp, weft=weft)


def _by_kind(channels: tuple[str, ...], sigma: np.ndarray) -> tuple[np.ndarray | None, np.ndarray | None]:
    """Noise (n,) of positions and of shear, None where there are none."""
    position = sigma[:, channels.index("normal")] if "normal" in channels else None
    return position, sigma[:, channels.index("shear")] if "shear" in channels else None
