"""Look over a prepared mesh and write down what is unusual."""

from __future__ import annotations

import numpy as np
from numba import njit

from geomdrap.surface import topology
from geomdrap.surface.cracks import find_cracks
from geomdrap.surface.defects import doubled_components, non_manifold_edges
from geomdrap.surface.findings import LISTED, Component, Findings, Loop, Point
from geomdrap.surface.prepare import Prepared
from geomdrap.surface.types import Floats

#: a sliver's height is under this share of its longest edge
SLIVER = 1e-3
#: mm across: smaller moulds are made for no ply (a 14-inch tray read as mm is 17), larger ones are rare
SMALLEST, LARGEST = 25.0, 20_000.0


def inspect(mesh: Prepared, areas: Floats, notes: tuple[str, ...]) -> Findings:
    """Find components, boundary loops, non-manifold edges, slivers and a doubtful unit. areas (m,) mm²."""
    is_open = np.zeros(mesh.n_components, np.bool_)
    is_open[mesh.component[(mesh.neighbours < 0).any(axis=1)]] = True
    n_loops, loops = _loops(mesh)
    edges, cracks = non_manifold_edges(mesh), find_cracks(mesh)
    return Findings(
        **mesh.counts,
        faces=len(mesh.triangles),
        points=len(mesh.points),
        weld_tolerance=mesh.tolerance,
        n_components=mesh.n_components,
        n_closed=int((~is_open).sum()),
        components=_components(mesh, areas, is_open),
        n_loops=n_loops,
        loops=loops,
        n_non_manifold=len(edges),
        non_manifold=_listed(edges),
        n_bow_ties=len(mesh.bow_ties),
        bow_ties=_listed(mesh.bow_ties),
        n_slivers=int((mesh.slender < SLIVER).sum()),
        worst_sliver=float(mesh.slender.min()),
        n_cracks=len(cracks),
        cracks=_listed(cracks),
        unit_hint=_unit_hint(mesh.points),
        notes=notes,
    )


@njit(cache=True)
def component_sums(points, triangles, areas, component, n):  # type: ignore[no-untyped-def]
    """Per component: number of faces (n,), area (n,) and the centre (n, 3) of its area."""
    faces, area, moment = np.zeros(n, np.int64), np.zeros(n), np.zeros((n, 3))
    for f in range(len(triangles)):
        c = component[f]
        faces[c] += 1
        area[c] += areas[f]
        for i in range(3):
            for a in range(3):
                # about the first point, so that a part far from the origin loses no digits
                moment[c, a] += areas[f] * (points[triangles[f, i], a] - points[0, a]) / 3.0
    for c in range(n):
        for a in range(3):
            moment[c, a] = points[0, a] + moment[c, a] / area[c]
    return faces, area, moment


def _listed(points: Floats) -> tuple[Point, ...]:
    return tuple((float(x), float(y), float(z)) for x, y, z in points[:LISTED])


def _point(values: Floats) -> Point:
    return float(values[0]), float(values[1]), float(values[2])


def _components(mesh: Prepared, areas: Floats, is_open: np.ndarray) -> tuple[Component, ...]:
    faces, area, center = component_sums(
        mesh.points, mesh.triangles, areas, mesh.component, mesh.n_components
    )
    doubled = doubled_components(mesh)
    return tuple(
        Component(
            int(faces[c]),
            float(area[c]),
            _point(center[c]),
            not is_open[c],
            not mesh.twisted[c],
            bool(doubled[c]),
        )
        for c in np.argsort(-area, kind="stable")[:LISTED]
    )


def _loops(mesh: Prepared) -> tuple[int, tuple[Loop, ...]]:
    walk, start = topology.boundary_walk(mesh.triangles, mesh.neighbours, len(mesh.points))
    n = len(start) - 1
    if n == 0:
        return 0, ()
    face, k = walk // 3, walk % 3
    begin, end = mesh.points[mesh.triangles[face, k]], mesh.points[mesh.triangles[face, (k + 1) % 3]]
    step = np.linalg.norm(end - begin, axis=1)
    length = np.add.reduceat(step, start[:-1])
    center = np.add.reduceat((0.5 * (begin + end)) * step[:, None], start[:-1], axis=0) / length[:, None]
    component = mesh.component[face[start[:-1]]]
    order = np.argsort(-length, kind="stable")
    _, at = np.unique(component[order], return_index=True)  # the first, so the longest, of each component
    outer = np.zeros(n, np.bool_)
    outer[order[at]] = True
    edges = np.diff(start)
    return n, tuple(
        Loop(int(component[i]), int(edges[i]), float(length[i]), _point(center[i]), bool(outer[i]))
        for i in order[:LISTED]
    )


def _unit_hint(points: Floats) -> str:
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    if diagonal < SMALLEST:
        return (
            f"the part is only {diagonal:.3g} mm across, which looks like metres or inches: "
            "use --unit m or --unit in if so"
        )
    if diagonal > LARGEST:
        return f"the part is {diagonal / 1000:.3g} m across: was --unit right, or is the file in mm already?"
    return ""
