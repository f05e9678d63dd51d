"""Whether fibre directions are those of the yarns that the table says: warp and weft may be swapped."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.measurement.match import Matched
    from geomdrap.measurement.measurement import Measurement

BETTER = 0.5
"""Directions are of the other yarns where half of them then turn by at most this share of what they turn by now."""
AWAY, FEWEST = 45.0, 8
"""Degrees from which on, and directions from so many on, a typical turn is no effect and no chance."""


def check_directions(measurement: Measurement, found: Matched) -> tuple[str, ...]:
    """A warning where directions go with those predicted for the other family of yarns."""
    pairs = [(name, getattr(measurement, name)) for name in ("warp", "weft")]
    given = [(name, directions) for name, directions in pairs if directions is not None]
    own = _typical_turn([(directions, getattr(found, name)) for name, directions in given])
    other = {"warp": found.weft, "weft": found.warp}
    swapped = _typical_turn([(directions, other[name]) for name, directions in given])
    if not (own > AWAY and swapped < BETTER * own):
        return ()
    what = "the directions of warp and weft are swapped"
    if len(given) == 1:
        name, second = ("warp", "weft") if given[0][0] == "warp" else ("weft", "warp")
        what = f"the directions of the {name} are those of the {second}"
    heading = "" if measurement.labelled else ", or the heading is off by 90 degrees"
    return (
        f"{measurement.source}: it looks as if {what}{heading}: half of them would then lie within {swapped:.2g} "
        f"degrees of the prediction, instead of {own:.2g} degrees",
    )


def _typical_turn(pairs: list[tuple[np.ndarray, np.ndarray]]) -> float:
    """Median angle in degrees between directions (n, 3) without a head, over all pairs of them; NaN for too few."""
    if not pairs:
        return float("nan")
    cosine = np.concatenate([np.abs(np.einsum("ij,ij->i", a, b)) for a, b in pairs])
    known = cosine[np.isfinite(cosine)]
    return float(np.degrees(np.arccos(np.clip(np.median(known), 0.0, 1.0)))) if len(known) >= FEWEST else float("nan")
