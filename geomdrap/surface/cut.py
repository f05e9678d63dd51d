"""Cuts: a line drawn on the part becomes a slit of its mesh, whose two sides are rims that a ply does not cross.

The line is set into the mesh, point by point and crossing by crossing, so that it runs along edges; the faces on its
two sides then forget each other. The surface stays what it was to the last digit but for that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface import topology
from geomdrap.surface.degenerate import heights
from geomdrap.surface.edit import NEAR, Editable, ordered
from geomdrap.surface.prepare import Prepared
from geomdrap.surface.types import Floats, Ints

DETOUR = 4.0  # lengths of its chord that the section between two points may take over the part


class Line(NamedTuple):
    """A line to cut along: points (k, 3) mm that lie on faces (k,) with normals (k, 3), and how messages call it."""

    points: Floats
    faces: Ints
    normals: Floats
    name: str


def cut_along(mesh: Prepared, lines: Sequence[Line]) -> tuple[Prepared, float]:
    """A mesh cut along lines, which may cross and touch, and the length of all cuts, mm.

    Between two points a cut runs where the plane through both and along the mean of their normals meets the part.
    Raises SurfaceError where that does not lead from one to the other.
    """
    edit = Editable(mesh.points, mesh.triangles, mesh.neighbours, mesh.neighbour_edge)
    for line in lines:
        stops = [edit.insert(int(face), point) for face, point in zip(line.faces, line.points, strict=True)]
        if len(set(stops)) < 2:
            raise SurfaceError(f"{line.name} comes to a single point when it is laid onto the part: make it longer")
        for k, (start, end) in enumerate(pairwise(stops)):
            if start != end:
                path = [start, *_section(edit, start, end, line.normals[k] + line.normals[k + 1], line.name)]
                edit.marked |= {ordered(a, b) for a, b in pairwise(path)}
    return _parted(mesh, edit)


def _section(edit: Editable, start: int, end: int, normal: Floats, name: str) -> list[int]:
    """Vertices after ``start`` up to ``end`` along the section of the part through both; new where it crosses."""
    a, b = edit.points[start].copy(), edit.points[end].copy()
    walked, path = 0.0, [start]
    while path[-1] != end:
        found = _next_vertex(edit, path, end, normal)
        walked += float(np.linalg.norm(edit.points[found] - edit.points[path[-1]])) if found >= 0 else 0.0
        if found < 0 or walked > DETOUR * float(np.linalg.norm(b - a)):
            raise SurfaceError(
                f"{name} does not run over the part from ({_written(a)}) to ({_written(b)}): it meets the rim, or "
                "the part bends away under it; give points in between"
            )
        path.append(found)
    return path[1:]


def _next_vertex(edit: Editable, path: list[int], end: int, normal: Floats) -> int:
    """The vertex after the last of a path on the section towards ``end``; -1 where the section leaves the part.

    The plane of the section holds ``end``, ``normal`` and where the path has come to: steps to a vertex nearby do
    not add up.
    """
    here = path[-1]
    fan, origin = edit.around(here), edit.points[here]
    if any(end in edit.triangles[face] for face, _ in fan):
        return end
    ahead = edit.points[end] - origin if len(path) == 1 else origin - edit.points[path[-2]]
    across = np.cross(edit.points[end] - origin, normal)
    best, place = 0.0 if len(path) == 1 else -1.0, None
    for face, corner in fan:
        ends = [int(edit.triangles[face, (corner + k) % 3]) for k in (1, 2)]
        low, high = (float(across @ (edit.points[v] - origin)) for v in ends)
        if low * high > 0.0 or low == high:
            continue
        share = low / (low - high)
        if len(path) > 1 and path[-2] in ends and abs(share - ends.index(path[-2])) < NEAR:
            continue  # where the path came from
        way = (1.0 - share) * edit.points[ends[0]] + share * edit.points[ends[1]] - origin
        forward = float(way @ ahead) / float(np.linalg.norm(way) * np.linalg.norm(ahead))
        if forward > best:
            best, place = forward, (face, (corner + 1) % 3, share)
    return edit.on_edge(*place) if place is not None else -1


def _parted(mesh: Prepared, edit: Editable) -> tuple[Prepared, float]:
    """The mesh with the faces on the two sides of marked edges parted, each side with vertices of its own."""
    n, m = edit.n, edit.m
    triangles, neighbours = edit.triangles[:m].copy(), edit.neighbours[:m].copy()
    slots = edit.neighbour_edge[:m].copy()
    length = 0.0
    for a, b in edit.marked:
        for face, corner in edit.around(a):
            for edge in (corner, (corner + 2) % 3):
                other = neighbours[face, edge]
                if b in (triangles[face, edge], triangles[face, (edge + 1) % 3]) and other >= 0:
                    slot = slots[face, edge]
                    neighbours[face, edge] = slots[face, edge] = neighbours[other, slot] = slots[other, slot] = -1
                    length += float(np.linalg.norm(edit.points[a] - edit.points[b]))
    copied = topology.split_fans(triangles, neighbours, slots, n)
    points = np.ascontiguousarray(np.concatenate([edit.points[:n], edit.points[copied]]))
    order, start = topology.sorted_edges(triangles, len(points))
    component, n_components = topology.label_components(order, start, m)
    height, edge_length = heights(points, triangles)
    parent = edit.parent[:m]
    cut = replace(
        mesh,
        points=points,
        triangles=triangles,
        source_face=mesh.source_face[parent],
        neighbours=neighbours,
        neighbour_edge=slots,
        component=component,
        n_components=int(n_components),
        twisted=mesh.twisted[mesh.component[parent][np.unique(component, return_index=True)[1]]],
        doubled=mesh.doubled[parent],
        slender=height / edge_length,
    )
    return cut, length


def _written(point: Floats) -> str:
    return ", ".join(f"{c:.6g}" for c in point)
