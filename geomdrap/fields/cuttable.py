"""What of the strip beyond the net must stay bare, so that the flat pattern can be cut from one layer of fabric."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fields.contour import is_simple, outlines
from geomdrap.fields.joints import cut_off, on_outline, with_common_corners
from geomdrap.fields.overlap import doubled
from geomdrap.fields.slit import slits
from geomdrap.fields.strip import BARE, BEYOND, BY_NET
from geomdrap.fishnet import Status

if TYPE_CHECKING:
    from geomdrap.fields.refine import Refined
    from geomdrap.fishnet import Net

ATTEMPTS = 4  # the first takes away facets of the strip, the others also those of the net along the outline

def make_cuttable(
    net: Net, mesh: Refined, at: np.ndarray, kind: np.ndarray, stopped: np.ndarray, reached: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """``at``, ``kind`` and ``stopped`` (m,) changed: facets in slits, and where fabric would lie double, are bare.

    ``at`` (m, 3, 2) cells from the seed; ``reached`` the draped facets in the order in which they were. Where the
    outline crosses nothing, nothing lies double, and no more is looked for. Within the net facets may fold over,
    where its cells are too coarse for the part; its outline does not show it, and no hole is cut for it.
    """
    at = with_common_corners(at, kind, mesh.triangles, mesh.neighbours, mesh.neighbour_edge)
    kind, stopped = kind.copy(), stopped.copy()

    def leave(facets: np.ndarray, why: Status) -> None:
        stopped[facets], kind[facets] = why, BARE

    def leave_cut_off(why: Status) -> None:
        leave(cut_off(at, kind, mesh.neighbours, mesh.neighbour_edge), why)

    seed = np.array([net.u[0], net.v[0]]) / net.pitch
    in_slits = slits(at - seed, kind, mesh, net.surface, net.status_around, net.pitch)
    if in_slits.any():
        leave(in_slits, Status.SLIT)
        leave_cut_off(Status.SLIT)
    half = None if net.reach is None else np.array(net.reach) / net.pitch
    for attempt in range(ATTEMPTS):
        if is_simple(outlines(at, kind, mesh.neighbours, mesh.neighbour_edge)):
            break
        movable = reached[kind[reached] == BEYOND]
        if attempt > 0:  # the net itself, at its outline
            edge = on_outline(at, kind, mesh.neighbours, mesh.neighbour_edge)
            movable = np.concatenate([edge[kind[edge] == BY_NET], movable])
        rest = np.setdiff1d(np.flatnonzero(kind), movable)
        leave(doubled(at, movable, rest, half), Status.DOUBLED)
        leave_cut_off(Status.DOUBLED)
    return at, kind, stopped
