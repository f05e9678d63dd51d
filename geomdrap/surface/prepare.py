"""From triangles as they come to arrays that can be draped: weld, drop, orient, connect."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface import orient, topology
from geomdrap.surface.degenerate import NO_HEIGHT, turn_flat_faces
from geomdrap.surface.types import Bools, Floats, Ints
from geomdrap.surface.weld import weld_vertices


@dataclass(frozen=True)
class Prepared:
    """A mesh made ready: arrays as in Surface, and what was done to get there.

    bad_edges (h,) half-edges 3 f + k at non-manifold edges, edge by edge; twisted (n_components,) not
    orientable; doubled (m,) faces that had a twin; slender (m,) heights as shares of the longest edges; cuts names
    of the lines that it was cut along, cut_length mm of all.
    """

    points: Floats
    triangles: Ints
    source_face: Ints
    vertex_of_input: Ints
    neighbours: Ints
    neighbour_edge: Ints
    component: Ints
    n_components: int
    bad_edges: Ints
    twisted: Bools
    doubled: Bools
    slender: Floats
    bow_ties: Floats
    tolerance: float
    counts: dict[str, int]
    cuts: tuple[str, ...] = ()
    cut_length: float = 0.0


@dataclass
class _Faces:
    """Faces on their way: vertex numbers (m, 3), numbers in the input (m,), whether they had a twin (m,)."""

    corners: Ints
    number: Ints
    doubled: Bools
    slender: Floats = field(default_factory=lambda: np.empty(0))


def prepare(points: Floats, triangles: Ints, source: str) -> Prepared:
    """Weld, drop degenerate faces and doubles, orient each component, connect faces across edges.

    points (n, 3), triangles (m, 3). Raises SurfaceError where nothing with an area remains.
    """
    first, tolerance = weld_vertices(points, triangles)
    counts = {"points_input": len(points), "faces_input": len(triangles)}
    counts["welded"] = int((first != np.arange(len(points))).sum())
    faces = _drop_collapsed_and_doubles(first.astype(np.int32)[triangles], len(points), counts)
    counts["flipped_edges"], faces.slender = turn_flat_faces(points, faces.corners, faces.number, tolerance)
    good = faces.slender > NO_HEIGHT
    if not good.all():
        counts["degenerate_faces"] += int((~good).sum())
        corners = np.ascontiguousarray(faces.corners[good])
        faces = _Faces(corners, faces.number[good], faces.doubled[good], faces.slender[good])
    if len(faces.corners) == 0:
        raise SurfaceError(f"{source}: no face has an area; export the part as a triangulated surface")
    return _connect(points, faces, first, tolerance, counts)


def _drop_collapsed_and_doubles(corners: Ints, n: int, counts: dict[str, int]) -> _Faces:
    """Keep the faces with three different corners, each once; count the others."""
    distinct = (corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2]) & (corners[:, 2] != corners[:, 0])
    number = np.flatnonzero(distinct)
    corners = np.ascontiguousarray(corners[number])
    twin = topology.repeated_faces(corners, n)
    single = twin == np.arange(len(corners))
    doubled = np.zeros(len(corners), np.bool_)
    doubled[twin[~single]] = True
    counts["degenerate_faces"] = len(distinct) - len(number)
    counts["duplicate_faces"] = int((~single).sum())
    return _Faces(np.ascontiguousarray(corners[single]), number[single], doubled[single])


def _connect(points: Floats, faces: _Faces, first: Ints, tolerance: float, counts: dict[str, int]) -> Prepared:
    """Neighbours, components, orientation, one vertex per fan, and the vertices numbered anew."""
    corners, n = faces.corners, len(points)
    order, start = topology.sorted_edges(corners, n)
    neighbours, neighbour_edge, bad = topology.match_edges(order, start, len(corners))
    component, n_components = topology.label_components(order, start, len(corners))
    flip, patch, twisted_patch = orient.find_flips(points, corners, neighbours, neighbour_edge)
    counts["turned_faces"] = int(flip.sum())
    bad = np.where(flip[bad // 3], bad - 2 * (bad % 3) + 2, bad)
    orient.turn_faces(corners, neighbours, neighbour_edge, flip)
    twisted = np.zeros(n_components, np.bool_)
    if twisted_patch.any():
        twisted[component[twisted_patch[patch]]] = True
        orient.cut_twists(corners, neighbours, neighbour_edge)
    on_bad_edge = np.zeros(n, np.bool_)
    on_bad_edge[corners[bad // 3, bad % 3]] = True
    on_bad_edge[corners[bad // 3, (bad % 3 + 1) % 3]] = True
    copied = topology.split_fans(corners, neighbours, neighbour_edge, n)
    new_of_old, used = _renumber(corners, n + len(copied))
    vertex_of_input = new_of_old[first]
    counts["unused_points"] = int((vertex_of_input < 0).sum())
    return Prepared(
        points=np.ascontiguousarray(points[np.concatenate([np.arange(n), copied])[used]]),
        triangles=new_of_old[corners].astype(np.int32),
        source_face=faces.number,
        vertex_of_input=vertex_of_input,
        neighbours=neighbours,
        neighbour_edge=neighbour_edge,
        component=component,
        n_components=int(n_components),
        bad_edges=bad,
        twisted=twisted,
        doubled=faces.doubled,
        slender=faces.slender,
        bow_ties=points[np.unique(copied[~on_bad_edge[copied]])],
        tolerance=tolerance,
        counts=counts,
    )


def _renumber(faces: Ints, n: int) -> tuple[Ints, Ints]:
    """Number the used vertices from 0: new number of each old one (-1 unused); the used ones in order."""
    mark = np.zeros(n, np.bool_)
    mark[faces.ravel()] = True
    used = np.flatnonzero(mark)
    new = np.full(n, -1, np.int64)
    new[used] = np.arange(len(used))
    return new, used


def take_component(whole: Prepared, label: int) -> Prepared:
    """One component of a prepared mesh, with all its arrays cut to it."""
    inside = whole.component == label
    faces = np.flatnonzero(inside)
    new_face = np.full(len(inside) + 1, -1, np.int32)  # the last serves neighbour -1
    new_face[faces] = np.arange(len(faces), dtype=np.int32)
    new_vertex, used = _renumber(whole.triangles[faces], len(whole.points))
    old = whole.vertex_of_input
    bad = whole.bad_edges[inside[whole.bad_edges // 3]]
    return Prepared(
        points=whole.points[used],
        triangles=new_vertex[whole.triangles[faces]].astype(np.int32),
        source_face=whole.source_face[faces],
        vertex_of_input=np.where(old >= 0, new_vertex[old], -1),
        neighbours=new_face[whole.neighbours[faces]],
        neighbour_edge=whole.neighbour_edge[faces],
        component=np.zeros(len(faces), np.int32),
        n_components=1,
        bad_edges=3 * new_face[bad // 3].astype(np.int64) + bad % 3,
        twisted=whole.twisted[label : label + 1],
        doubled=whole.doubled[faces],
        slender=whole.slender[faces],
        bow_ties=whole.bow_ties,
        tolerance=whole.tolerance,
        counts=whole.counts,
        cuts=whole.cuts,
        cut_length=whole.cut_length,
    )


def turn_over(mesh: Prepared) -> Prepared:
    """Face the other way: corners 1 and 2 change places, and with them edges 0 and 2."""
    slot = np.where(mesh.neighbour_edge >= 0, 2 - mesh.neighbour_edge, -1).astype(np.int8)
    changed = {
        "triangles": mesh.triangles[:, [0, 2, 1]].copy(),
        "neighbours": mesh.neighbours[:, ::-1].copy(),
        "neighbour_edge": slot[:, ::-1].copy(),
        "bad_edges": mesh.bad_edges - 2 * (mesh.bad_edges % 3) + 2,
    }
    return Prepared(**{**mesh.__dict__, **changed})
