"""``evaluate``: from a net to everything that is read from it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fields.checks import check_net
from geomdrap.fields.contour import self_crossings
from geomdrap.fields.cut_lines import torn
from geomdrap.fields.flat import flat_pattern
from geomdrap.fields.result import Areas, BareRegion, Checks, Drape, FlatPattern, ShearStatistics
from geomdrap.fields.trim import Trimmed, trim
from geomdrap.fishnet import Effect, Status
from geomdrap.geodesic.compiled import kernel

if TYPE_CHECKING:
    from collections.abc import Callable

    from geomdrap.fishnet import Net

MOST_RESIDUAL = 1.0  # degrees of curvature residual above which the pitch is called coarse
LEAST_FABRIC = 0.995  # of the draped area: sheared fabric covers less than its own area, never more
LEAST_BARE = 1e-4  # of the part: smaller bare specks are counted in the coverage but not listed


def evaluate(net: Net, limit_angle: float | None = None, progress: Callable[[float], None] = lambda _: None) -> Drape:
    """Fields, flat pattern, areas, bare regions, statistics and checks of a net.

    ``limit_angle`` degrees; the fabric's own if None. ``progress`` is called with the share done, 0 to 1.
    Raises DrapeError for a limit angle out of range.
    """
    from dataclasses import replace

    limit = (
        net.fabric.limit_angle if limit_angle is None else replace(net.fabric, limit_angle=limit_angle).limit_angle
    )
    trimmed = trim(net, lambda share: progress(0.65 * share))
    warp, weft = unit_directions(trimmed)
    shear = sheared(warp, weft)
    faces = _per_face(net, trimmed, warp, weft)
    progress(0.75)
    flat = flat_pattern(net, trimmed, limit)
    progress(0.85)
    checks = check_net(net, trimmed)
    progress(0.95)
    return Drape(
        net=replace(net, balance=None, slid=None),  # which are for nets near it, and twice as large
        limit_angle=limit,
        **faces,
        flat=flat,
        area=areas(trimmed),
        bare=bare_regions(trimmed),
        statistics=statistics(net, trimmed, shear, limit),
        checks=checks,
        warnings=(*net.warnings, *doubts(flat, checks, areas(trimmed), stretch(net)), *_tear(net, trimmed)),
        trimmed=trimmed,
        roll=None,
    )


def _tear(net: Net, trimmed: Trimmed) -> tuple[str, ...]:
    """A warning where the fabric of the two sides of a cut does not join behind it."""
    length, gap = torn(trimmed, net.pitch) if net.surface.cuts else (0.0, 0.0)
    if gap == 0.0:
        return ()
    return (
        f"behind a cut the fabric of its two sides does not join: the flat pattern is open there over {length:.4g} "
        f"mm, by up to {gap:.3g} mm; lead the cut on to the rim, or to where the part is flat",
    )


def stretch(net: Net) -> float:
    """How much larger than flat the fabric is where its yarns are strained and nothing shears, 1 for most nets.

    A net that an effect has grown in the end does not say so; the lines between its nodes tell, which are else a
    little shorter than the yarns.
    """
    if net.sides is not None:
        return _longer(net, *net.sides)
    if all(type(e).on_net is Effect.on_net for e in net.effects):
        return 1.0
    return max(1.0, _longer(net, *(np.linalg.norm(np.diff(net.points, axis=axis), axis=2) for axis in (0, 1))))


def _longer(net: Net, warp: np.ndarray, weft: np.ndarray) -> float:
    """How much larger than flat cells are whose warp pieces (nu - 1, nv) and weft (nu, nv - 1) are so long, mm."""
    warp, weft = warp / np.diff(net.u)[:, None], weft / np.diff(net.v)[None, :]
    return float(np.nanmean(warp) * np.nanmean(weft)) if np.isfinite(warp).any() and np.isfinite(weft).any() else 1.0


def doubts(flat: FlatPattern, checks: Checks, area: Areas, stretched: float = 1.0) -> tuple[str, ...]:
    """Sentences on what of the result should not be trusted as it is; ``stretched`` as from ``stretch``."""
    found = []
    crossings, (u, v) = self_crossings((*flat.outer, *flat.inner))
    if crossings:
        found.append(
            f"the flat pattern crosses itself in {crossings} places, as at u = {u:.1f}, v = {v:.1f} mm, and cannot "
            "be cut like this: the fabric shears too far or folds there; use another origin or heading, a smaller "
            "pitch, or plan a dart"
        )
    if checks.curvature_residual is not None and checks.curvature_residual > MOST_RESIDUAL:
        found.append(
            f"shear and curvature of the part differ by {checks.curvature_residual:.1f}°: the pitch is coarse for "
            "the radii of the part; halve it (on a mesh that is fine enough) and compare"
        )
    if stretched * area.fabric < LEAST_FABRIC * area.draped:
        found.append(
            f"the fabric's area of {area.fabric:.6g} mm² is less than the {area.draped:.6g} mm² that it covers, "
            "which cannot be: the pitch is too coarse for thin walls or sharp edges of the part; use a smaller one"
        )
    return tuple(found)


def unit_directions(trimmed: Trimmed) -> tuple[np.ndarray, np.ndarray]:
    """Unit warp and weft directions (m, 3) of the split facets."""
    unit = unit_vectors(trimmed.tangent.reshape(-1, 3)).reshape(trimmed.tangent.shape)
    return unit[:, 0], unit[:, 1]


def sheared(warp: np.ndarray, weft: np.ndarray) -> np.ndarray:
    """Shear (n,) degrees between unit directions (n, 3)."""
    sine = warp[:, 0] * weft[:, 0] + warp[:, 1] * weft[:, 1] + warp[:, 2] * weft[:, 2]
    return np.asarray(np.degrees(np.arcsin(np.clip(sine, -1.0, 1.0))))


@kernel
def unit_vectors(vectors: np.ndarray) -> np.ndarray:
    """Vectors (n, 3) made unit vectors; those without a length stay as they are."""
    out = np.empty_like(vectors)
    for n in range(len(vectors)):
        x, y, z = vectors[n, 0], vectors[n, 1], vectors[n, 2]
        length = math.sqrt(x * x + y * y + z * z)
        scale = 1.0 / length if length > 0.0 else 1.0
        out[n, 0], out[n, 1], out[n, 2] = scale * x, scale * y, scale * z
    return out


def areas(trimmed: Trimmed) -> Areas:
    """Areas of the part, of the draped part and of the fabric on it."""
    part = float(trimmed.area.sum())
    draped = float((trimmed.area * trimmed.share).sum())
    (au, av), (bu, bv), (cu, cv) = trimmed.at.transpose(1, 2, 0)
    flat = 0.5 * ((bu - au) * (cv - av) - (bv - av) * (cu - au))
    fabric = float(np.where(trimmed.share > 0.0, flat * trimmed.share, 0.0).sum())
    return Areas(part, draped, fabric, draped / part)


def _per_face(net: Net, trimmed: Trimmed, warp: np.ndarray, weft: np.ndarray) -> dict[str, np.ndarray]:
    """Fields on the part's own facets: area-weighted over the pieces of each."""
    m = len(net.surface.triangles)
    parent, on = trimmed.mesh.parent, trimmed.kind > 0
    weight = trimmed.area * trimmed.share

    def mean(values: np.ndarray) -> np.ndarray:
        total = np.column_stack([np.bincount(parent[on], (values[on, k] * weight[on]), m) for k in range(3)])
        length = np.linalg.norm(total, axis=1, keepdims=True)
        return np.where(length > 0.0, total / np.where(length > 0.0, length, 1.0), np.nan)

    face_warp, face_weft = mean(warp), mean(weft)
    sine = np.clip((face_warp * face_weft).sum(axis=1), -1.0, 1.0)
    factor = 1.0 / np.sqrt(np.maximum(1.0 - sine**2, 1e-12))
    covered = np.bincount(parent, weight, m) / np.bincount(parent, trimmed.area, m)
    reason = np.full(m, np.uint8(Status.PRESENT))
    reason[parent[~on]] = trimmed.reason[~on]
    return {
        "face_shear": np.degrees(np.arcsin(sine)),
        "face_warp": face_warp,
        "face_weft": face_weft,
        "face_thickness": factor,
        "face_fibre_volume": factor.copy(),
        "face_coverage": np.clip(covered, 0.0, 1.0),
        "face_reason": np.where(covered > 0.5, np.uint8(Status.PRESENT), reason),
    }


def bare_regions(trimmed: Trimmed) -> tuple[BareRegion, ...]:
    """Connected bare stretches, the largest first, each with the reason that most of it has."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    bare = trimmed.share < 1.0
    if not bare.any():
        return ()
    rows, k = np.nonzero((trimmed.mesh.neighbours >= 0) & bare[:, None])
    beside = trimmed.mesh.neighbours[rows, k]
    both = bare[beside]
    n = len(bare)
    graph = coo_array((np.ones(both.sum(), np.int8), (rows[both], beside[both])), shape=(n, n))
    label = connected_components(graph, directed=False)[1]
    without = trimmed.area * (1.0 - trimmed.share)
    reason = np.where(trimmed.kind == 0, trimmed.reason, np.uint8(Status.BLANK))  # only a blank ends within facets
    regions = []
    middle = trimmed.mesh.points[trimmed.mesh.triangles].mean(axis=1)
    least = LEAST_BARE * trimmed.area.sum()
    sizes = np.bincount(label[bare], without[bare], n)
    for group in np.flatnonzero(sizes > least):
        members = np.flatnonzero((label == group) & bare)
        area = without[members]
        center = (middle[members] * area[:, None]).sum(axis=0) / area.sum()
        on_it = middle[members[np.linalg.norm(middle[members] - center, axis=1).argmin()]]
        weight = np.bincount(reason[members], area)
        regions.append(BareRegion(float(area.sum()), on_it, Status(int(weight.argmax())).reason))
    return tuple(sorted(regions, key=lambda r: -r.area))


def statistics(net: Net, trimmed: Trimmed, shear: np.ndarray, limit: float) -> ShearStatistics:
    """Shear statistics: the largest of cells and facets, which reach out to the rim; the rest weighted by area."""
    on = trimmed.share > 0.0
    size, weight = np.abs(shear[on]), (trimmed.area * trimmed.share)[on]
    if not on.any() or not np.isfinite(net.cell_shear).any():
        return ShearStatistics(0.0, 0.0, 0.0, 0.0, 0.0)
    order = np.argsort(size)
    cumulated = np.cumsum(weight[order]) / weight.sum()
    return ShearStatistics(
        max=float(max(np.nanmax(np.abs(net.cell_shear)), size.max())),
        p95=float(size[order][min(np.searchsorted(cumulated, 0.95), len(order) - 1)]),
        mean=float((size * weight).sum() / weight.sum()),
        over_half_limit=float(weight[size > 0.5 * limit].sum() / weight.sum()),
        over_limit=float(weight[size > limit].sum() / weight.sum()),
    )
