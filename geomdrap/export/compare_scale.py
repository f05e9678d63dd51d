"""One scale for all panels of a comparison, or of two side by side: colours and the length of the vectors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from geomdrap.criticism import Comparison

Floats = NDArray[np.float64]

NICE = (1.0, 2.0, 2.5, 5.0, 10.0)
MOST = 0.98
"""Quantile of the residuals that the colour scales hold; the rest takes the last colour, and that is said."""
LONG = 0.1
"""Length of a large residual as drawn, as a share of the part's diagonal."""
SIZE_COLOURS = "magma", 0.80, 0.12
SIGNED_COLOURS = "RdBu_r"
"""Continuous, safe for the colour-blind."""


@dataclass(frozen=True)
class CompareScale:
    """``size`` mm: top of the colours of residual vectors; ``signed``: top of the signed dots (degrees, or mm along
    the normal); ``factor`` by which vectors are drawn longer than they are.
    """

    size: float
    signed: float
    factor: float


def scale_of(comparisons: Sequence[Comparison]) -> CompareScale:
    """The scale that holds all of the comparisons."""
    sizes = np.concatenate([c.size[c.trusted] for c in comparisons])
    signed = np.concatenate([signed_values(c)[0][c.trusted] for c in comparisons])
    size, top = _quantile(sizes), _quantile(np.abs(signed))
    diagonal = comparisons[0].net.surface.diagonal
    return CompareScale(nice_above(size), nice_above(top), nice_below(LONG * diagonal / max(size, 1e-12)))


def signed_values(comparison: Comparison) -> tuple[Floats, str, str]:
    """What the dots show (n,), its name and its unit: shear, else the warp's turn, else the normal distance."""
    if comparison.shear is not None:
        return comparison.shear, "Shear, measured less predicted", "°"
    if comparison.warp_turn is not None:
        return comparison.warp_turn, "Warp direction, measured less predicted", "°"
    if comparison.weft_turn is not None:
        return comparison.weft_turn, "Weft direction, measured less predicted", "°"
    return comparison.parts[:, 2], "Distance from the part along its normal", " mm"


def thinned(places: Floats, rows: NDArray[np.int64], most: int) -> NDArray[np.int64]:
    """About ``most`` of the rows, evenly spread over the places (n, 2); all of them where they are fewer."""
    if len(rows) <= most:
        return rows
    there = places[rows]
    size = np.ptp(there, axis=0)
    side = float(np.sqrt(max(size[0] * size[1], 1e-12 * float(size.max()) ** 2) / most))
    square = np.floor((there - there.min(axis=0)) / max(side, 1e-300)).astype(np.int64)
    _, first = np.unique(square, axis=0, return_index=True)
    return rows[np.sort(first)]


def _quantile(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.quantile(known, MOST)) if len(known) else 1.0


def nice_above(value: float) -> float:
    """A round number not below the value; 1 for 0."""
    if not value > 0.0:
        return 1.0
    decade = 10.0 ** np.floor(np.log10(value))
    return float(next(n for n in NICE if n * decade >= value * (1 - 1e-9)) * decade)


def nice_below(value: float) -> float:
    """A round number not above the value."""
    decade = 10.0 ** np.floor(np.log10(value))
    return float(max(n for n in NICE if n * decade <= value * (1 + 1e-9)) * decade)


def size_colours() -> Any:
    """Colour map of residual sizes: light orange for small, dark for large."""
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap

    name, first, last = SIZE_COLOURS
    return ListedColormap(colormaps[name](np.linspace(first, last, 256)))
