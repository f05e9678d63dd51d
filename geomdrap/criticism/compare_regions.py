"""Where the residual is worst, in words; and which areas of the part were not measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.measurement.local import neighbours
from geomdrap.surface.findings import count

if TYPE_CHECKING:
    from geomdrap.criticism.comparison import Comparison
    from geomdrap.surface import Surface

NEAR = 8
"""Neighbours over which a residual is averaged, so that noise does not make a region."""
CLEAR = 5.0
"""Standard deviations of that average from which a region is worth a name."""
PART_OF = 0.5
"""Of its peak: how far the averaged residual may fall within a region."""
WIDTH = 3.05
"""Spacings of the points: greatest distance of a region's points from its peak, so that a region has a place.

No whole number, so that rounding does not decide on marks of a grid."""
TIGHT = 0.2
"""Of the part's diagonal: radii of curvature below this are worth a word."""
MOST = 5
PLAIN = 0.02
"""mm: where components at right angles would come to another size, the angle between the yarns is said."""
FAR_FROM_POINTS = 2.5
"""Spacings of the points: area further from all of them was not measured."""
LEAST_GAP = 0.01
"""Of the part's area: gaps smaller than this are not listed."""


@dataclass(frozen=True)
class Region:
    """A region of large residuals: ``name`` in words, ``position`` (3,) mm and ``u``, ``v`` mm of its worst point.

    ``n`` points; ``along_warp``, ``along_weft``, ``normal`` mm, ``shear``, ``warp_turn``, ``weft_turn`` degrees: mean
    residuals, None where not measured, as along the yarns without fabric coordinates; ``size`` mm the length of the
    vector with these components along yarns ``yarn_angle`` degrees apart, oblique as in `Comparison`; ``score`` the
    peak in standard deviations of the noise, or of the usual residual where the noise is not known.
    """

    name: str
    position: tuple[float, float, float]
    u: float
    v: float
    n: int
    size: float
    along_warp: float | None
    along_weft: float | None
    normal: float
    yarn_angle: float
    shear: float | None
    warp_turn: float | None
    weft_turn: float | None
    score: float


@dataclass(frozen=True)
class Gap:
    """A patch of the part without measured points nearby: ``area`` mm², ``center`` (3,) mm."""

    area: float
    center: tuple[float, float, float]


def worst_regions(comparison: Comparison) -> tuple[Region, ...]:
    """The worst regions, worst first: peaks of the residual averaged over neighbours, and what belongs to them."""
    rows = np.flatnonzero(comparison.trusted)
    if len(rows) < 3:
        return ()
    where = np.column_stack([comparison.matched.u, comparison.matched.v])[rows]
    near = np.column_stack([np.arange(len(rows)), neighbours(where, NEAR)])
    level, score = np.max([_averaged(values[rows], near) for values in _in_sigmas(comparison)], axis=0)
    spacing = typical_spacing(where)
    left = np.ones(len(rows), bool)
    out: list[Region] = []
    while left.any() and len(out) < MOST:
        peak = int(np.argmax(np.where(left, level, -1.0)))
        if not score[peak] > CLEAR:
            break
        away = np.linalg.norm(where - where[peak], axis=1)
        members = left & (level >= PART_OF * level[peak]) & (away <= WIDTH * spacing)
        out.append(_region(comparison, rows[members], int(rows[peak]), float(level[peak])))
        left &= away > 2.0 * WIDTH * spacing
    return tuple(out)


def _in_sigmas(comparison: Comparison) -> list[np.ndarray]:
    """Residuals of position (n, 3), shear and directions (n, 1), where measured, in standard deviations."""
    kinds = [(comparison.vector, comparison.noise_xyz.sigma)]
    if comparison.shear is not None:
        kinds.append((comparison.shear[:, None], comparison.noise_shear.sigma))
    turns = ((comparison.warp_turn, comparison.noise_warp), (comparison.weft_turn, comparison.noise_weft))
    kinds += [(turn[:, None], noise.sigma) for turn, noise in turns if turn is not None]
    return [values / (_usual(values) if sigma is None else sigma[:, None]) for values, sigma in kinds]


def _usual(values: np.ndarray) -> float:
    """Root mean square of all that is known of values (n, k); 1 where that is nothing, or 0."""
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) or 1.0 if len(known) else 1.0


def _averaged(values: np.ndarray, near: np.ndarray) -> np.ndarray:
    """Length of the mean of values (n, k) over neighbours ``near`` (n, m), and the same in its own sigmas: (2, n)."""
    known = np.isfinite(values).all(axis=1)
    many = known[near].sum(axis=1)
    mean = np.where(known[:, None], values, 0.0)[near].sum(axis=1) / np.maximum(many, 1)[:, None]
    level = np.linalg.norm(mean, axis=1)
    return np.stack([level, level * np.sqrt(many)])


def typical_spacing(places: np.ndarray) -> float:
    """Median distance in mm of places (n, d) from their nearest neighbour; coincident ones count once."""
    from scipy.spatial import cKDTree

    places = np.unique(np.round(places, 6), axis=0)
    if len(places) < 2:
        return 0.0
    distance, _ = cKDTree(places).query(places, k=[2])
    return float(np.median(distance))


def _spacing_of_marks(comparison: Comparison, points: np.ndarray) -> float:
    """The typical spacing, mm, of the points used (k, 3), repeated readings of one mark counted once."""
    if not comparison.measurement.labelled:
        return typical_spacing(points)
    where = np.column_stack([comparison.matched.u, comparison.matched.v])[comparison.used]
    _, first = np.unique(np.round(where, 6), axis=0, return_index=True)
    return typical_spacing(points[first])


def _region(comparison: Comparison, rows: np.ndarray, peak: int, score: float) -> Region:
    matched, parts = comparison.matched, comparison.parts[rows]
    x, y, z = comparison.measurement.points[peak].tolist()
    shear, warp, weft = (
        None if values is None or np.isnan(values[rows]).all() else float(np.nanmean(values[rows]))
        for values in (comparison.shear, comparison.warp_turn, comparison.weft_turn)
    )
    a, b, normal = parts.mean(axis=0).tolist()
    cosine = float(np.einsum("ij,ij->i", matched.warp[rows], matched.weft[rows]).mean())
    labelled = comparison.measurement.labelled
    return Region(
        name=name_of_place(comparison, peak),
        position=(x, y, z),
        u=float(matched.u[peak]),
        v=float(matched.v[peak]),
        n=len(rows),
        size=float(np.sqrt(max(a * a + b * b + 2.0 * a * b * cosine + normal * normal, 0.0))),
        along_warp=a if labelled else None,
        along_weft=b if labelled else None,
        normal=normal,
        yarn_angle=float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))),
        shear=shear,
        warp_turn=warp,
        weft_turn=weft,
        score=score,
    )


def region_words(region: Region) -> str:
    """A region in one line: place, residual, shear."""
    at = ", ".join(f"{round(x) + 0:d}" for x in region.position)
    parts = {"warp": region.along_warp, "weft": region.along_weft, "normal": region.normal}
    known = {name: round(part, 2) + 0.0 for name, part in parts.items() if part is not None}  # + 0.0: no −0.00
    along = ", ".join(f"{part:+.2f} {name}" for name, part in known.items())
    if abs(region.size - float(np.linalg.norm(list(known.values())))) > PLAIN:
        along += f"; yarns {region.yarn_angle:.0f}° apart"
    angles = {"shear": region.shear, "warp": region.warp_turn, "weft": region.weft_turn}
    more = [f"; {name} {round(angle, 1) + 0.0:+.1f}°" for name, angle in angles.items() if angle is not None]
    return f"{region.name}: {region.size:.2f} mm ({along}){''.join(more)}; {count(region.n, 'point')} about ({at})"


def name_of_place(comparison: Comparison, row: int) -> str:
    """A place in words: how far along warp and weft, how close to the rim, in which kind of curvature."""
    matched, places, surface = comparison.matched, comparison.places, comparison.net.surface
    u, v = float(matched.u[row]), float(matched.v[row])
    reach = float(np.nanmax(places.distance))
    share = np.hypot(u, v) / reach if reach > 0.0 else 0.0
    words = [_way(u, v) if share >= 0.2 else "near the origin"]
    if share >= 0.2:
        words[0] = f"{'far' if share >= 0.6 else 'halfway'} {words[0]}"
    rim = float(places.rim[row])
    if rim < 0.12 * surface.diagonal:
        words.append(f"{rim:.0f} mm from the rim")
    curvature = float(places.curvature[row])
    if abs(curvature) * surface.diagonal > 1000.0 / TIGHT:
        kind = "on a bulge" if curvature > 0.0 else "in a hollow"
        words.append(f"{kind} of radius {1000.0 / abs(curvature):.0f} mm")
    return ", ".join(words)


def _way(u: float, v: float) -> str:
    """'along +warp', or 'along +warp on the −weft side' between the axes."""
    (large, first), (small, second) = sorted(((abs(u), _sign(u) + "warp"), (abs(v), _sign(v) + "weft")), reverse=True)
    return f"along {first}" if small < 0.4 * large else f"along {first} on the {second} side"


def _sign(x: float) -> str:
    return "+" if x >= 0.0 else "−"


def unmeasured(comparison: Comparison) -> tuple[float, tuple[Gap, ...]]:
    """Share of the part's area without a compared point nearby, and its larger patches, largest first."""
    from scipy.spatial import cKDTree

    surface = comparison.net.surface
    points = comparison.measurement.points[comparison.used]
    reach = FAR_FROM_POINTS * max(_spacing_of_marks(comparison, points), comparison.net.pitch)
    center = surface.points[surface.triangles].mean(axis=1)
    size = np.linalg.norm(surface.points[surface.triangles] - center[:, None], axis=2).max(axis=1)
    distance, _ = cKDTree(points).query(center)
    open_faces = distance > np.maximum(reach, size)
    share = float(surface.areas[open_faces].sum() / surface.area)
    return share, _patches(surface, open_faces, center)


def _patches(surface: Surface, chosen: np.ndarray, center: np.ndarray) -> tuple[Gap, ...]:
    """Connected patches of chosen faces (m,) that are worth listing."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    face, k = np.nonzero((surface.neighbours >= 0) & chosen[:, None])
    other = surface.neighbours[face, k]
    face, other = face[chosen[other]], other[chosen[other]]
    n = len(chosen)
    _, label = connected_components(coo_array((np.ones(len(face)), (face, other)), shape=(n, n)), directed=False)
    weight = np.where(chosen, surface.areas, 0.0)
    area = np.bincount(label, weight)
    middle = np.stack([np.bincount(label, weight * center[:, c]) for c in range(3)], axis=1)
    listed = [k for k in np.argsort(-area, kind="stable").tolist() if area[k] > LEAST_GAP * surface.area]
    return tuple(Gap(float(area[k]), tuple((middle[k] / area[k]).tolist())) for k in listed)
