"""How the size of the residuals goes with the place: binned, with a rank correlation that respects neighbours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.compare_structure import pairs_by_distance

if TYPE_CHECKING:
    from geomdrap.criticism.comparison import Comparison

BINS = 8
LEAST = 5
"""Points in a bin."""

AGAINST = {
    "shear": "predicted shear |γ|, degrees",
    "distance": "distance from the origin, mm",
    "curvature": "curvature of the part, 1/m (− hollow, + bulge)",
    "rim": "distance from the rim, mm",
}
"""Names of the places that residuals are held against (fields of `Places`), and what they are."""


@dataclass(frozen=True, eq=False)
class Trend:
    """Residual sizes of one ``kind`` against one place (a key of AGAINST).

    Kinds are position in mm, shear, and warp and weft (turns of the directions) in degrees.

    ``edges`` (k + 1,) of the bins, ``n`` (k,) points in them, ``middle`` (k,) their median place, ``rms`` (k,) of the
    residual, ``mean`` (k,) of the signed residual (along the normal for positions). ``rho``: Spearman's rank
    correlation of size and place; ``p``: probability of one so large by chance, with the number of independent
    points that the smoothness of both leaves; None where it cannot be told.
    """

    kind: str
    against: str
    edges: np.ndarray
    n: np.ndarray
    middle: np.ndarray
    rms: np.ndarray
    mean: np.ndarray
    rho: float | None
    p: float | None
    independent: float | None


def trends_of(comparison: Comparison) -> tuple[Trend, ...]:
    """All trends of the trusted rows; kinds that were not measured are left out."""
    kinds = [("position", comparison.size, comparison.parts[:, 2])]
    if comparison.shear is not None:
        kinds.append(("shear", np.abs(comparison.shear), comparison.shear))
    if comparison.warp_turn is not None:
        kinds.append(("warp", np.abs(comparison.warp_turn), comparison.warp_turn))
    if comparison.weft_turn is not None:
        kinds.append(("weft", np.abs(comparison.weft_turn), comparison.weft_turn))
    out = []
    for kind, size, signed in kinds:
        for against in AGAINST:
            place = getattr(comparison.places, against)
            kept = comparison.trusted & np.isfinite(size) & np.isfinite(place)
            if kept.sum() >= 3 * LEAST and np.ptp(place[kept]) > 0.0:
                where = np.column_stack([comparison.matched.u, comparison.matched.v])[kept]
                out.append(_trend(kind, against, _rounded(place[kept]), size[kept], signed[kept], where))
    return tuple(out)


def _trend(
    kind: str, against: str, place: np.ndarray, size: np.ndarray, signed: np.ndarray, where: np.ndarray
) -> Trend:
    edges = _edges(place)
    number = np.clip(np.searchsorted(edges, place, side="right") - 1, 0, len(edges) - 2)
    n = np.bincount(number, minlength=len(edges) - 1)
    rho, p, independent = rank_correlation(place, size, where)
    return Trend(
        kind=kind,
        against=against,
        edges=edges,
        n=n,
        middle=np.array([np.median(place[number == k]) if n[k] else np.nan for k in range(len(n))]),
        rms=np.sqrt(np.bincount(number, size**2, len(n)) / np.maximum(n, 1)),
        mean=np.bincount(number, signed, len(n)) / np.maximum(n, 1),
        rho=rho,
        p=p,
        independent=independent,
    )


def _edges(place: np.ndarray) -> np.ndarray:
    """Edges of at most BINS bins that hold about as many of the places (n,) each."""
    count = int(np.clip(len(place) // LEAST, 1, BINS))
    edges = np.unique(np.quantile(place, np.linspace(0.0, 1.0, count + 1)))
    return edges if len(edges) > 1 else np.array([edges[0], edges[0] + 1.0])


def _rounded(values: np.ndarray) -> np.ndarray:
    """Values (n,) to 1e-9 of their largest, so that those equal but for rounding rank equally."""
    step = max(1e-9 * float(np.abs(values).max()), 1e-300)
    return np.round(values / step) * step


def rank_correlation(
    x: np.ndarray, y: np.ndarray, where: np.ndarray
) -> tuple[float | None, float | None, float | None]:
    """Spearman's rho of x and y (n,), its p-value, and the number of independent points, for places (n, 2).

    Smooth fields agree by chance more often than independent numbers; the number of points is lowered by their
    autocorrelations (P. Clifford, S. Richardson, D. Hémon, Biometrics 45, 1989).
    """
    from scipy.stats import rankdata, t

    a, b = (rankdata(_rounded(values)) - 0.5 * (len(values) + 1) for values in (x, y))
    if not (a.any() and b.any()):
        return None, None, None
    rho = float(a @ b / np.sqrt((a @ a) * (b @ b)))
    both = pairs_by_distance(where, (a, b))
    shared = float(np.sum(both.count * both.mean[0] * both.mean[1]))
    n = len(x)
    chance = n * a.var() * b.var()  # what independent numbers would share; less than that is chance too
    independent = float(np.clip(1.0 + n * chance / max(chance + shared, chance), 3.0, n))
    freedom = independent - 2.0
    statistic = abs(rho) * np.sqrt(freedom / max(1.0 - rho**2, 1e-12))
    return rho, float(2.0 * t.sf(statistic, freedom)), independent
