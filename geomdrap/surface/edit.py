"""A triangle mesh that grows: vertices set into faces and edges, each face knowing its neighbours all the time."""

from __future__ import annotations

import numpy as np

from geomdrap.surface.types import Floats, Ints

NEAR = 0.01  # of an edge or height: a new vertex so close to an old one is that one, and slivers are not made


def ordered(a: int, b: int) -> tuple[int, int]:
    """An edge between two vertices by its name in ``Editable.marked``."""
    return (a, b) if a < b else (b, a)


class Editable:
    """Points, triangles and neighbours of a mesh, in arrays with room for more.

    ``points`` (n, 3), ``triangles`` (m, 3), ``neighbours`` (m, 3) and ``neighbour_edge`` (m, 3) as in `Surface`, and
    ``parent`` (m,), the face that each one was a part of. What lies behind the first ``n`` and ``m`` is room.
    ``marked`` are edges, pairs of vertices with the lower first; where one is split, both its pieces are.
    """

    def __init__(self, points: Floats, triangles: Ints, neighbours: Ints, neighbour_edge: Ints) -> None:
        self.n, self.m = len(points), len(triangles)
        self.points, self.triangles = np.array(points), np.array(triangles)
        self.neighbours, self.neighbour_edge = np.array(neighbours), np.array(neighbour_edge)
        self.parent = np.arange(self.m)
        self.face_at = np.zeros(self.n, np.int64)  # one face of each vertex
        self.face_at[self.triangles.ravel()] = np.repeat(np.arange(self.m), 3)
        self.marked: set[tuple[int, int]] = set()
        self._pieces: dict[int, list[int]] = {}  # by the face that was split, those that came of it

    def _room(self) -> None:
        """Make sure that there is room for a vertex and two faces more."""
        if self.n + 1 > len(self.points):
            self.points = np.concatenate([self.points, np.empty_like(self.points)])
            self.face_at = np.concatenate([self.face_at, np.zeros_like(self.face_at)])
        if self.m + 2 > len(self.triangles):
            for name in ("triangles", "neighbours", "neighbour_edge", "parent"):
                array = getattr(self, name)
                setattr(self, name, np.concatenate([array, np.zeros_like(array)]))

    def _vertex(self, point: Floats) -> int:
        self.points[self.n] = point
        self.n += 1
        return self.n - 1

    def _face(self, parent: int) -> int:
        """A new face that is a piece of ``parent``."""
        whole = int(self.parent[parent])
        self.parent[self.m] = whole
        self._pieces.setdefault(whole, [whole]).append(self.m)
        self.m += 1
        return self.m - 1

    def _set(self, face: int, corners: tuple[int, int, int], beyond: tuple[tuple[int, int], ...]) -> None:
        """A face's corners, and across edge k the face and its edge (-1, -1 at a rim); they learn of it too."""
        self.triangles[face] = corners
        for k, (other, slot) in enumerate(beyond):
            self.neighbours[face, k], self.neighbour_edge[face, k] = other, slot
            if other >= 0:
                self.neighbours[other, slot], self.neighbour_edge[other, slot] = face, k
            self.face_at[corners[k]] = face

    def _turned(self, face: int, edge: int) -> tuple[tuple[int, int, int], list[tuple[int, int]]]:
        """Corners of a face from the start of one of its edges, and what lies across its edges from that one on."""
        order = [(edge + k) % 3 for k in range(3)]
        a, b, c = (int(self.triangles[face, k]) for k in order)
        return (a, b, c), [(int(self.neighbours[face, k]), int(self.neighbour_edge[face, k])) for k in order]

    def split_edge(self, face: int, edge: int, point: Floats) -> int:
        """Set a vertex onto an edge; the faces beside it become two each. Its number."""
        self._room()
        (a, b, c), (across, to_c, to_a) = self._turned(face, edge)
        p, g = self._vertex(point), self._face(face)
        if ordered(a, b) in self.marked:
            self.marked.remove(ordered(a, b))
            self.marked |= {ordered(a, p), ordered(p, b)}
        if across[0] < 0:
            self._set(face, (a, p, c), ((-1, -1), (g, 2), to_a))
            self._set(g, (p, b, c), ((-1, -1), to_c, (face, 1)))
            return p
        h = across[0]
        (_, _, d), (_, to_d, to_b) = self._turned(*across)
        i = self._face(h)
        self._set(face, (a, p, c), ((i, 0), (g, 2), to_a))
        self._set(g, (p, b, c), ((h, 0), to_c, (face, 1)))
        self._set(h, (b, p, d), ((g, 0), (i, 2), to_b))
        self._set(i, (p, a, d), ((face, 0), to_d, (h, 1)))
        return p

    def split_face(self, face: int, point: Floats) -> int:
        """Set a vertex into a face, which becomes three. Its number."""
        self._room()
        (a, b, c), (over_ab, over_bc, over_ca) = self._turned(face, 0)
        p, g, h = self._vertex(point), self._face(face), self._face(face)
        self._set(face, (a, b, p), (over_ab, (g, 2), (h, 1)))
        self._set(g, (b, c, p), (over_bc, (h, 2), (face, 1)))
        self._set(h, (c, a, p), (over_ca, (face, 2), (g, 1)))
        return p

    def insert(self, whole: int, point: Floats) -> int:
        """A vertex at a point (3,) of a face of the mesh as it was; an old one where one is near."""
        face, weights = max(
            ((f, self._weights(f, point)) for f in self._pieces.get(whole, [whole])), key=lambda held: held[1].min()
        )
        k = int(weights.argmin())
        if weights.max() > 1.0 - NEAR:
            return int(self.triangles[face, weights.argmax()])
        if weights[k] < NEAR:  # on the edge across corner k
            return self.on_edge(face, (k + 1) % 3, float(weights[(k + 2) % 3] / (1.0 - weights[k])))
        return self.split_face(face, point)

    def on_edge(self, face: int, edge: int, share: float) -> int:
        """A vertex at a share of the way along an edge of a face; one of its ends where that is near."""
        a, b = int(self.triangles[face, edge]), int(self.triangles[face, (edge + 1) % 3])
        if share < NEAR or share > 1.0 - NEAR:
            return a if share < 0.5 else b
        return self.split_edge(face, edge, (1.0 - share) * self.points[a] + share * self.points[b])

    def _weights(self, face: int, point: Floats) -> Floats:
        """Barycentric coordinates (3,) of a point in the plane of a face."""
        a, b, c = self.points[self.triangles[face]]
        normal = np.cross(b - a, c - a)
        at = [np.cross(c - b, point - b), np.cross(a - c, point - c), np.cross(b - a, point - a)]
        return np.asarray([w @ normal for w in at]) / float(normal @ normal)

    def around(self, vertex: int) -> list[tuple[int, int]]:
        """The faces at a vertex, each with the number of the corner that is there."""
        start = int(self.face_at[vertex])
        fan = [(start, self._corner(start, vertex))]
        for forward in (True, False):  # counter-clockwise; where that ends at a rim, clockwise as well
            face, corner = fan[0]
            while True:
                edge = (corner + 2) % 3 if forward else corner
                across = int(self.neighbours[face, edge])
                if across == start:
                    return fan
                if across < 0:
                    break
                face, corner = across, self._corner(across, vertex)
                fan.append((face, corner))
        return fan

    def _corner(self, face: int, vertex: int) -> int:
        return int(np.flatnonzero(self.triangles[face] == vertex)[0])
