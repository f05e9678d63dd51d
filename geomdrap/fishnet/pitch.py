"""The side of a cell: chosen from the part where the user leaves it open, and checked against it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from geomdrap.errors import DrapeError

if TYPE_CHECKING:
    from geomdrap.surface import Surface

NODES_WANTED = 4000  # enough for maps and patterns, fast enough to try many orientations
LEAST_PITCH = 1e-8  # of the part's diagonal
FLAT_RAD = math.radians(1.0)  # facets that meet at less than this count as one plane


def choose_pitch(surface: Surface) -> tuple[float, tuple[str, ...]]:
    """A round pitch in mm that gives some thousand nodes and does not go below the facets, and the sentence on it."""
    by_area = math.sqrt(surface.area / NODES_WANTED)
    width, area = _curved_widths(surface)
    order = np.argsort(width)
    most = np.searchsorted(np.cumsum(area[order]), 0.96 * area.sum()) if len(width) else 0
    by_facets = float(width[order][min(most, len(width) - 1)]) if len(width) else 0.0
    least = min(max(by_area, by_facets), surface.diagonal / 20.0)
    decade = 10.0 ** math.floor(math.log10(least))
    pitch = min(s * decade for s in (1.0, 2.0, 2.5, 5.0, 10.0) if s * decade >= least * (1 - 1e-9))
    return pitch, (f"pitch {pitch:g} mm chosen from the part (set another with --pitch)",)


def check_pitch(surface: Surface, pitch: float) -> float:
    """The pitch as a float. Raises DrapeError where it is not positive, or larger than the part."""
    try:
        pitch = float(pitch)
    except (TypeError, ValueError):
        raise DrapeError(f"the pitch must be a number of mm, not {pitch!r}") from None
    if not (math.isfinite(pitch) and pitch > 0.0):
        raise DrapeError(f"the pitch must be a positive number of mm, not {pitch:g}")
    if pitch > surface.diagonal:
        raise DrapeError(
            f"a pitch of {pitch:g} mm is larger than {surface.source}, whose diagonal is {surface.diagonal:.6g} mm; "
            "use a smaller one, or check the unit of the part (--unit)"
        )
    if pitch < LEAST_PITCH * surface.diagonal:
        raise DrapeError(
            f"a pitch of {pitch:g} mm is far too small for {surface.source}, whose diagonal is "
            f"{surface.diagonal:.6g} mm: its nodes would fit into no memory; use a larger one"
        )
    return pitch


_WIDTHS: WeakKeyDictionary[Surface, tuple[np.ndarray, np.ndarray]] = WeakKeyDictionary()


def _curved_widths(surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Least heights (k,) mm and areas (k,) mm² of the facets that stand for a curved surface; made once."""
    if surface not in _WIDTHS:
        beside = surface.neighbours
        turn = np.einsum("fk,fnk->fn", surface.normals, surface.normals[np.maximum(beside, 0)])
        bent = ((turn < math.cos(FLAT_RAD)) & (beside >= 0)).any(axis=1)
        corners = surface.unfolded[bent, :3]
        sides = [
            corners[:, 0],
            np.hypot(corners[:, 1], corners[:, 2]),
            np.hypot(corners[:, 1] - corners[:, 0], corners[:, 2]),
        ]
        _WIDTHS[surface] = 2.0 * surface.areas[bent] / np.max(sides, axis=0), surface.areas[bent]
    return _WIDTHS[surface]


def coarse_facets(surface: Surface, pitch: float) -> tuple[str, ...]:
    """A warning where the pitch is below the size of facets that stand for a curved surface."""
    width, area = _curved_widths(surface)
    share = float(area[width > pitch].sum() / surface.area)
    if share < 0.05:
        return ()
    return (
        f"the pitch of {pitch:g} mm is below the size of the facets on {share:.0%} of the part: the net follows the "
        "facets, not the curved surface they stand for; use a finer mesh or a larger pitch",
    )
