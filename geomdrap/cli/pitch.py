"""The pitch of a run: what the program chooses is tried, and what nobody has room for is refused before the work."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from geomdrap.fields import Drape
    from geomdrap.surface import Surface

MOST_HALVINGS = 2
GAIN = 0.01  # of the part: coverage that is worth a smaller pitch by itself
BYTES_PER_CELL = 450.0  # of the fields, as MOST_PIECES counts them
ALIKE = 100.0  # times the middle one: facets larger than that are at fault themselves


def require_room(surface: Surface, pitch: float) -> None:
    """Raise DrapeError for a pitch whose cells on this part are more than the fields have room for.

    Where a few huge facets are the reason, the fields say so themselves, and name them.
    """
    import numpy as np

    from geomdrap.errors import DrapeError
    from geomdrap.fields.pieces import MOST_PIECES
    from geomdrap.fields.trim import FINE
    from geomdrap.fishnet.pitch import LEAST_PITCH

    area = float(np.bincount(surface.component, surface.areas).max())
    least = math.sqrt(2.0 * area / MOST_PIECES) / FINE
    if LEAST_PITCH * surface.diagonal <= pitch < least and surface.areas.max() <= ALIKE * np.median(surface.areas):
        cells = (math.sqrt(area) / pitch) ** 2
        raise DrapeError(
            f"a pitch of {pitch:g} mm is too small for {surface.source}: its {cells:.2g} cells need about "
            f"{cells * BYTES_PER_CELL / 1e9:.2g} GB of memory for their fields; use {_rounded_up(least):g} mm or more"
        )


def _rounded_up(length: float) -> float:
    """The next number of two digits."""
    step = 10.0 ** (math.floor(math.log10(length)) - 1)
    return math.ceil(length / step) * step


def finer_where_coarse(first: Drape, again: Callable[[float], Drape]) -> Drape:
    """A drape at a pitch that the program chose, or at half of it as long as that mends what is wrong with it.

    ``again`` drapes at another pitch (mm). Not below the facets, which the net would follow. A note says it.
    """
    result = first
    for _ in range(MOST_HALVINGS):
        finer = 0.5 * result.net.pitch
        if not _coarse(result) or _below_facets(result, finer):
            break
        other = again(finer)
        if not _better(other, result):
            break
        result = other
    if result is not first:
        pitch = f"pitch {result.net.pitch:g} mm chosen from the part, {first.net.pitch:g} mm being too coarse"
        return _noted(result, f"{pitch} for it (set another with --pitch)")
    if _coarse(first):
        below = _below_facets(first, 0.5 * first.net.pitch)
        why = (
            "it would follow the facets of the mesh"
            if below
            else "it mends nothing: sharp edges may be the reason"
        )
        return _noted(first, f"a smaller pitch than {first.net.pitch:g} mm was not chosen, as {why}")
    return first


def _coarse(result: Drape) -> bool:
    """Whether a smaller pitch is called for: by the Gauss-Bonnet check, or by bare places narrower than the pitch."""
    from geomdrap.fishnet import Status

    return _residual(result) > _most() or any(r.reason == Status.TOO_NARROW.reason for r in result.bare)


def _better(new: Drape, old: Drape) -> bool:
    """Whether the check falls below its limit, or to half, and as much is covered; or more of the part is."""
    gain = new.area.coverage - old.area.coverage
    return gain > GAIN or (gain > -0.1 * GAIN and _residual(new) <= max(_most(), 0.5 * _residual(old)))


def _residual(result: Drape) -> float:
    return result.checks.curvature_residual or 0.0


def _most() -> float:
    from geomdrap.fields.evaluate import MOST_RESIDUAL

    return MOST_RESIDUAL


def _below_facets(result: Drape, pitch: float) -> bool:
    from geomdrap.fishnet.pitch import coarse_facets

    return bool(coarse_facets(result.net.surface, pitch))


def _noted(result: Drape, note: str) -> Drape:
    return replace(result, net=replace(result.net, notes=(note, *result.net.notes)))
