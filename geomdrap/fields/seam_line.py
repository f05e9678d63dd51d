"""Lines of constant v, exactly as they run over the facets of the part: where a seam lies, and what it crosses."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from geomdrap.fields.result import Drape

TOGETHER = 1e-3
"""Cells: stretches whose ends lie this close on the part are one line."""


class FabricFacets(NamedTuple):
    """Draped facets in the order of their lowest corner: ``at`` (m, 3, 2) mm in the fabric, ``points`` (m, 3, 3) mm
    on the part, ``shear`` (m,) degrees, signed; ``low`` (m,) and ``tallest``: lowest corner, largest height, mm in v.
    """

    at: np.ndarray
    points: np.ndarray
    shear: np.ndarray
    low: np.ndarray
    tallest: float


class Stretches(NamedTuple):
    """What of a line lies on facets: ``u`` (n, 2) mm from left to right, ``points`` (n, 2, 3) mm, ``shear`` (n,)."""

    u: np.ndarray
    points: np.ndarray
    shear: np.ndarray


def fabric_facets(result: Drape) -> FabricFacets:
    """The facets of a drape that have fabric."""
    from geomdrap.fields.evaluate import sheared, unit_directions

    trimmed = result.trimmed
    on = np.flatnonzero(trimmed.share > 0.0)
    low = trimmed.at[on, :, 1].min(axis=1)
    order = np.argsort(low, kind="stable")
    on, low = on[order], low[order]
    at = trimmed.at[on]
    tallest = float((at[:, :, 1].max(axis=1) - low).max(initial=0.0))
    shear = sheared(*unit_directions(trimmed))[on]
    return FabricFacets(at, trimmed.mesh.points[trimmed.mesh.triangles[on]], shear, low, tallest)


def stretches_along(facets: FabricFacets, level: float, half: float = np.inf) -> Stretches:
    """The line v = ``level``, facet by facet, within |u| ≤ ``half`` mm, in the order of u."""
    first = np.searchsorted(facets.low, level - facets.tallest, side="left")
    last = np.searchsorted(facets.low, level, side="right")
    at, points = facets.at[first:last], facets.points[first:last]
    over = at[:, :, 1] > level
    hit = np.flatnonzero(over.any(axis=1) & ~over.all(axis=1))
    at, points, over = at[hit], points[hit], over[hit]
    alone = np.where(over.sum(axis=1) == 1, over.argmax(axis=1), (~over).argmax(axis=1))
    rows = np.arange(len(hit))
    u, places = np.empty((len(hit), 2)), np.empty((len(hit), 2, 3))
    for side in range(2):
        other = (alone + 1 + side) % 3
        a, b = at[rows, alone], at[rows, other]
        share = (level - a[:, 1]) / (b[:, 1] - a[:, 1])
        u[:, side] = a[:, 0] + share * (b[:, 0] - a[:, 0])
        places[:, side] = points[rows, alone] + share[:, None] * (points[rows, other] - points[rows, alone])
    turned = u[:, 0] > u[:, 1]
    u[turned], places[turned] = u[turned, ::-1], places[turned, ::-1]
    return _in_order(_within(Stretches(u, places, facets.shear[first:last][hit]), half))


def _within(line: Stretches, half: float) -> Stretches:
    """What of the stretches lies at |u| ≤ ``half``; none without a length."""
    clipped = np.clip(line.u, -half, half)
    keep = clipped[:, 1] > clipped[:, 0]
    u, points, clipped = line.u[keep], line.points[keep], clipped[keep]
    share = (clipped - u[:, :1]) / (u[:, 1:] - u[:, :1])
    return Stretches(
        clipped,
        points[:, :1] + share[:, :, None] * (points[:, 1:] - points[:, :1]),
        line.shear[keep],
    )


def _in_order(line: Stretches) -> Stretches:
    order = np.argsort(line.u[:, 0], kind="stable")
    return Stretches(line.u[order], line.points[order], line.shear[order])


def polylines(line: Stretches, pitch: float) -> tuple[np.ndarray, ...]:
    """The line on the part as polylines (k, 3) mm, a new one wherever the part or the fabric has a gap."""
    if not len(line.u):
        return ()
    gap = np.linalg.norm(line.points[1:, 0] - line.points[:-1, 1], axis=1) > TOGETHER * pitch
    starts = np.concatenate([[0], np.flatnonzero(gap) + 1, [len(gap) + 1]])
    return tuple(
        np.vstack([line.points[a:b, 0], line.points[b - 1 : b, 1]])
        for a, b in pairwise(starts.tolist())
    )
