"""Noise of every measured value of an experiment, by channel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import MeasurementError
from geomdrap.measurement.local import FEWEST
from geomdrap.measurement.noise import REPEATS, RESIDUAL, Noise, noise_of, noise_of_directions, repeats_of

if TYPE_CHECKING:
    from geomdrap.measurement import Measurement

OPTIONS = {"position": "--sigma-xyz", "shear": "--sigma-shear", "direction": "--sigma-direction"}
UNITS = {"position": "mm", "shear": "deg", "direction": "deg"}
NOT_POSITION = {"shear": "shear", "warp": "direction", "weft": "direction"}
_OTHER = {"warp": "weft", "weft": "warp"}


def noise_of_channels(
    measurement: Measurement,
    channels: tuple[str, ...],
    values: np.ndarray,
    residual: np.ndarray,
    at: np.ndarray,
    given: tuple[float | None, float | None, float | None],
) -> tuple[np.ndarray, tuple[str, ...], tuple[str, ...]]:
    """Noise (n, c) of every value, notes and warnings; ``given`` for positions, shear and directions.

    NaN for directions that are too few to say it. Raises MeasurementError where else there is no way to know it.
    """
    sigma = np.full(values.shape, np.nan)
    repeats = repeats_of(measurement)
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    columns = (measurement.sigma_xyz, measurement.sigma_shear, measurement.sigma_direction)
    shear = given[1]
    few = []
    for kind, own in _alike(channels):
        k = list(OPTIONS).index(kind)
        if kind == "direction":
            noise, more = noise_of_directions(columns[k], given[k], shear, residual[:, own], repeats, at)
        else:
            name = OPTIONS[kind].removeprefix("--").replace("-", "_")
            noise, more = noise_of(name, columns[k], given[k], values[:, own], repeats, residual[:, own], at)
        warnings += tuple(words for words in more if words not in warnings)
        if kind == "direction" and noise.sigma is None and _are_few(residual[:, own[0]], at):
            few.append(own[0])
            continue
        sigma[:, own] = _known(noise, kind, measurement)[:, None]
        shear = noise.typical if kind == "shear" else shear
        read = noise.source in (REPEATS, RESIDUAL)
        what = f"{kind} of the {channels[own[0]]}" if kind == "direction" else kind
        notes += (f"noise of the {what} {noise.typical:.2g} {UNITS[kind]}, from {noise.source}",) if read else ()
    for k in few:
        other = channels.index(_OTHER[channels[k]]) if _OTHER[channels[k]] in channels else k
        sigma[:, k] = np.sqrt(np.mean(sigma[:, other] ** 2))
        said = (_words_on_few(measurement, channels[k], sigma[0, k]),)
        if np.isnan(sigma[0, k]):
            warnings += said
        else:
            notes += said
    return sigma, notes, warnings


def _are_few(residual: np.ndarray, at: np.ndarray) -> bool:
    """Whether residuals (n,) at places ``at`` (n, 2) are too few for differences of neighbours."""
    return int((np.isfinite(residual) & np.isfinite(at).all(axis=1)).sum()) < FEWEST


def _words_on_few(measurement: Measurement, family: str, sigma: float) -> str:
    """What the noise of a few directions of a family is taken to be, degrees, or that they are left out (NaN)."""
    if np.isfinite(sigma):
        of = f"{sigma:.2g} deg, that of the {_OTHER[family]}"
        return f"noise of the direction of the {family} {of}: there are too few directions of the {family}"
    return (
        f"{measurement.source}: there are too few directions of the {family} to read their noise from them, and they "
        "are left out; give it (--sigma-direction)"
    )


def _alike(channels: tuple[str, ...]) -> list[tuple[str, list[int]]]:
    """Kinds of channels that are of one noise, with the channels' numbers: positions, shear, warp, weft."""
    places = [k for k, name in enumerate(channels) if name not in NOT_POSITION]
    others = [(NOT_POSITION[name], [k]) for k, name in enumerate(channels) if name in NOT_POSITION]
    return [*([("position", places)] if places else []), *others]


def _known(noise: Noise, kind: str, measurement: Measurement) -> np.ndarray:
    """Standard deviations (n,); raises MeasurementError where there is no way to know them."""
    if noise.sigma is None:
        raise MeasurementError(
            f"{measurement.source}: there are too few points to read the noise of the {kind} from them; give it "
            f"({OPTIONS[kind]})"
        )
    return noise.sigma
