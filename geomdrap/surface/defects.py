"""What keeps a mesh from being draped, said with its place."""

from __future__ import annotations

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface.findings import places
from geomdrap.surface.prepare import Prepared
from geomdrap.surface.types import Bools, Floats

#: a component is doubled where at least this share of its faces had a twin
DOUBLED = 0.5


def non_manifold_edges(mesh: Prepared) -> Floats:
    """Midpoints (k, 3) mm of the edges with more than two faces, each once."""
    face, k = mesh.bad_edges // 3, mesh.bad_edges % 3
    start, end = mesh.triangles[face, k], mesh.triangles[face, (k + 1) % 3]
    # fans are parted, so the same edge has other vertices in each face: the midpoint names it
    # (whichever way the edge runs, a + b rounds alike)
    return np.unique(0.5 * (mesh.points[start] + mesh.points[end]), axis=0)


def doubled_components(mesh: Prepared) -> Bools:
    """Whether each component was there twice: (n_components,)."""
    twins = np.bincount(mesh.component[mesh.doubled], minlength=mesh.n_components)
    return twins >= DOUBLED * np.bincount(mesh.component, minlength=mesh.n_components)


def require_drapable(mesh: Prepared, source: str) -> None:
    """Raise SurfaceError for non-manifold edges, one-sided strips and doubled shells."""
    doubled = np.flatnonzero(doubled_components(mesh))
    if len(doubled):
        at = mesh.points[mesh.triangles[np.flatnonzero(mesh.component == doubled[0])[0], 0]]
        raise SurfaceError(
            f"{source}: a shell is there twice, every triangle with a twin (near {places((tuple(at),), 1)}): "
            "delete one of the two shells"
        )
    edges = non_manifold_edges(mesh)
    if len(edges):
        raise SurfaceError(
            f"{source}: {len(edges)} edge(s) have more than two faces, at "
            f"{places(tuple(map(tuple, edges[:3])), len(edges))}: remove the fin or inner wall there, "
            "or export only the side that the ply lies on"
        )
    if mesh.twisted.any():
        at = mesh.points[mesh.triangles[np.flatnonzero(mesh.twisted[mesh.component])[0], 0]]
        raise SurfaceError(
            f"{source}: the surface through {places((tuple(at),), 1)} has only one side (Möbius strip): "
            "cut it open where the ply is to end"
        )
