"""The net cut to the part: which of it is draped, where in the flat fabric, in which directions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from geomdrap.fields.contour import shares_in_rectangle
from geomdrap.fields.cuttable import make_cuttable
from geomdrap.fields.gradient import bend_cells, complete_ends, shear_gradients
from geomdrap.fields.pieces import require_few_pieces
from geomdrap.fields.refine import Refined, refine
from geomdrap.fields.spread import by_net
from geomdrap.fields.start import starts
from geomdrap.fields.strip import continue_beyond
from geomdrap.fishnet import Status

if TYPE_CHECKING:
    from collections.abc import Callable

    from geomdrap.fishnet import Net
    from geomdrap.surface import Surface

FINE = 1.5  # cells: longest edge of a piece of a facet
REFUSED = np.zeros(16, np.bool_)
REFUSED[[Status.FOLDED, Status.BEHIND_FOLD, Status.NOT_CLOSED]] = True


@dataclass(frozen=True, eq=False)
class Trimmed:
    """Facets of the part, split to the pitch, with the fabric on them.

    ``mesh``; ``at`` (m, 3, 2) mm in the flat fabric per corner, NaN where bare; ``kind`` (m,) 0 where bare;
    ``tangent`` (m, 2, 3) along warp and weft, mm of surface per mm of fabric; ``area`` (m,) mm²; ``share`` (m,) of
    each facet that lies within the blank, 0 where bare; ``reason`` (m,) a Status.
    """

    mesh: Refined
    at: np.ndarray
    kind: np.ndarray
    tangent: np.ndarray
    area: np.ndarray
    share: np.ndarray
    reason: np.ndarray


def trim(net: Net, progress: Callable[[float], None] = lambda _: None) -> Trimmed:
    """Spread the net's fabric coordinates over the part, out to its rim or to the blank's.

    ``progress`` is called with the share done, 0 to 1.
    """
    mesh, area = _pieces(net.surface, FINE * net.pitch)
    if min(net.lattice_valid.shape) == 0:
        return _all_bare(mesh, area, Status.TOO_NARROW)
    progress(0.25)
    cells, kind, tangent, stopped, reached = _spread(net, mesh)
    progress(0.7)
    cells += np.array([net.u[0], net.v[0]]) / net.pitch
    cells, kind, stopped = make_cuttable(net, mesh, cells, kind, stopped, reached)
    if net.fabric.relaxes:  # such a net reached the rim before it came to rest: a smaller pitch is of no use
        stopped = np.where(stopped == Status.TOO_NARROW, np.uint8(Status.DRAWN_IN), stopped)
    progress(0.9)
    at, share = cells * net.pitch, (kind > 0).astype(float)
    reason = np.where(kind > 0, np.uint8(Status.PRESENT), np.where(stopped > 0, stopped, np.uint8(Status.UNREACHED)))
    if net.reach is not None:
        share *= _share_in_blank(at, net.reach)
        reason = np.where((kind > 0) & (share == 0.0), np.uint8(Status.BLANK), reason)
        kind = np.where(share > 0.0, kind, 0).astype(np.uint8)
    bare = np.flatnonzero(kind == 0)
    at[bare], tangent[bare] = np.nan, np.nan
    tangent /= net.pitch
    return Trimmed(mesh, at, kind, tangent, area, share, _spread_reasons(reason, mesh.neighbours))


_SPLIT: WeakKeyDictionary[Surface, tuple[float, Refined, np.ndarray]] = WeakKeyDictionary()


def _pieces(part: Surface, longest: float) -> tuple[Refined, np.ndarray]:
    """The part in pieces of edges up to ``longest`` mm, and their areas (m,) mm²; kept until asked for another.

    Raises DrapeError where they would be too many.
    """
    if part not in _SPLIT or _SPLIT[part][0] != longest:
        require_few_pieces(part, longest)
        mesh = refine(part.points, part.triangles, part.neighbours, part.neighbour_edge, longest)
        corners = mesh.points[mesh.triangles]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        _SPLIT[part] = longest, mesh, 0.5 * np.linalg.norm(across, axis=1)
    return _SPLIT[part][1:]


def _spread(net: Net, mesh: Refined) -> tuple[np.ndarray, ...]:
    """Coordinates in cells from the first node, kinds, tangents, what stops: see ``continue_beyond``."""
    points, triangles, neighbours = mesh.points, mesh.triangles, mesh.neighbours
    lattice, valid, side = net.lattice, net.lattice_valid, net.pitch
    vertex_at = by_net(points, triangles, neighbours, lattice, valid, *starts(net, mesh), side)
    gradient = shear_gradients(np.radians(net.cell_shear))
    yarns = complete_ends(net.yarns, valid, gradient)
    bend_cells(vertex_at, yarns, gradient)
    return continue_beyond(
        points, triangles, neighbours, mesh.neighbour_edge, net.surface.normals[mesh.parent],
        vertex_at, yarns, gradient, valid, net.status_around, REFUSED, side,
    )  # fmt: skip


def _all_bare(mesh: Refined, area: np.ndarray, why: Status) -> Trimmed:
    m = len(area)
    return Trimmed(
        mesh, np.full((m, 3, 2), np.nan), np.zeros(m, np.uint8), np.full((m, 2, 3), np.nan), area, np.zeros(m),
        np.full(m, np.uint8(why)),
    )  # fmt: skip


def _share_in_blank(at: np.ndarray, reach: tuple[float, float]) -> np.ndarray:
    """Share (m,) of each flat facet (m, 3, 2) within |u| ≤ reach[0], |v| ≤ reach[1]."""
    inside = (np.abs(at) <= reach).all(axis=(1, 2))
    share = inside.astype(float)
    rows = np.flatnonzero(~inside & ((at.min(axis=1) < reach) & (at.max(axis=1) > np.negative(reach))).all(axis=1))
    share[rows] = shares_in_rectangle(at[rows], (float(reach[0]), float(reach[1])))
    return share


def _spread_reasons(reason: np.ndarray, neighbours: np.ndarray) -> np.ndarray:
    """Give bare facets that nothing stopped at the reason of the bare facets beside them."""
    reason = reason.copy()
    front = np.flatnonzero((reason != Status.UNREACHED) & (reason != Status.PRESENT))
    while len(front):
        beside = neighbours[front]
        front = np.unique(beside[(beside >= 0) & (reason[beside] == Status.UNREACHED)])
        beside = neighbours[front]
        known = (beside >= 0) & (reason[beside] != Status.PRESENT)
        reason[front] = np.where(known, reason[beside], np.uint8(Status.UNREACHED)).max(axis=1, initial=0)
    return reason
