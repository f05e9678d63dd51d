"""The tool as a frozen triangle surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface import defects, lids, topology, unfold
from geomdrap.surface.cut import Line, cut_along
from geomdrap.surface.findings import Findings
from geomdrap.surface.inspection import component_sums, inspect
from geomdrap.surface.nearest import Nearest, NearestTree, nearest_to_one, of_lowest_number
from geomdrap.surface.prepare import Prepared, prepare, take_component, turn_over
from geomdrap.surface.types import Floats, Ints
from geomdrap.surface.weld import edge_lengths_squared, used_points

#: arrays of the prepared mesh that a Surface shows
SHOWN = (
    "points",
    "triangles",
    "source_face",
    "vertex_of_input",
    "neighbours",
    "neighbour_edge",
    "component",
    "n_components",
)
#: sizes [mm] between which squares and cubes of lengths keep their digits
SIZES = 1e-9, 1e12
FEW = 8  # single points: of more the nearest are found by a tree of the whole part
CUT_OFF = 0.01  # of the part's diagonal: a line to cut along that lies further off is not meant for it


class Surface:
    """A part as triangles, welded, consistently oriented and connected; never changes once made.

    points (n_input, 3) mm, triangles (m_input, 3) vertex numbers from 0. source names the part in messages;
    face_numbers (m_input,) gives the number of each triangle's face in the file (quads that were split);
    notes say what the reader had to do. Raises SurfaceError for coordinates that are not finite, vertex
    numbers out of range, and parts without area. Defects that only draping minds are kept and found:
    see findings and require_drapable.

    Arrays, all read-only: points (n, 3), triangles (m, 3) int32; source_face (m,) number of the face in the
    input; vertex_of_input (n_input,) new number of each input vertex, -1 where dropped; neighbours (m, 3)
    int32 the face across the edge from corner k to (k + 1) % 3, -1 at a boundary; neighbour_edge (m, 3) int8
    the number of that edge there; component (m,) int32 labels.
    """

    points: Floats
    triangles: Ints
    source_face: Ints
    vertex_of_input: Ints
    neighbours: Ints
    neighbour_edge: Ints
    component: Ints
    n_components: int
    source: str
    notes: tuple[str, ...]
    _mesh: Prepared

    def __init__(
        self,
        points: Any,
        triangles: Any,
        *,
        source: str = "surface",
        face_numbers: Ints | None = None,
        notes: tuple[str, ...] = (),
    ) -> None:
        vertices, faces = _checked(points, triangles, source)
        mesh = prepare(vertices, faces, source)
        if face_numbers is not None:
            numbers = np.asarray(face_numbers, dtype=np.int64)
            mesh = Prepared(**{**mesh.__dict__, "source_face": numbers[mesh.source_face]})
        self._hold(mesh, source, notes)

    @classmethod
    def _of(cls, mesh: Prepared, source: str, notes: tuple[str, ...], findings: Findings) -> Surface:
        surface = cls.__new__(cls)
        surface._hold(mesh, source, notes)
        surface.__dict__["findings"] = findings
        return surface

    def _hold(self, mesh: Prepared, source: str, notes: tuple[str, ...]) -> None:
        for value in mesh.__dict__.values():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
        self.__dict__.update({name: getattr(mesh, name) for name in SHOWN})
        self.__dict__.update(_mesh=mesh, source=source, notes=notes)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a Surface never changes: {name} cannot be set")

    def __getstate__(self) -> dict[str, Any]:
        kept = ("_mesh", "source", "notes", "findings")  # the tree of boxes cannot be pickled, nor need be
        return {name: self.__dict__[name] for name in kept if name in self.__dict__}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._hold(state.pop("_mesh"), state.pop("source"), state.pop("notes"))
        self.__dict__.update(state)

    def __repr__(self) -> str:
        return f"<Surface {self.source}: {len(self.triangles):,} faces, {self.area:.6g} mm²>"

    @cached_property
    def findings(self) -> Findings:
        """What was found in the mesh and repaired."""
        return inspect(self._mesh, self.areas, self.notes)

    @cached_property
    def _frames(self) -> tuple[Floats, Floats, Floats, Floats]:
        return _frozen(*unfold.face_frames(self.points, self.triangles))

    @cached_property
    def origin(self) -> Floats:
        """Corner 0 of each face (m, 3): the origin of its plane frame."""
        return _frozen(self.points[self.triangles[:, 0]])[0]

    @property
    def e1(self) -> Floats:
        """First axis of each face's frame (m, 3): along corner 0 → corner 1."""
        return self._frames[0]

    @property
    def e2(self) -> Floats:
        """Second axis of each face's frame (m, 3): normal × e1."""
        return self._frames[1]

    @property
    def normals(self) -> Floats:
        """Unit normals of the faces (m, 3)."""
        return self._frames[2]

    @property
    def areas(self) -> Floats:
        """Areas of the faces (m,) mm²."""
        return self._frames[3]

    @cached_property
    def unfolded(self) -> Floats:
        """Plane corners and edge crossings (m, 16): see unfold.unfold."""
        rows = unfold.unfold(self.points, self.triangles, self.neighbours, self.neighbour_edge)
        return _frozen(rows)[0]

    @cached_property
    def vertex_normals(self) -> Floats:
        """Unit normals at the vertices (n, 3), weighted by angle."""
        count = len(self.points)
        return _frozen(unfold.vertex_normals(self.triangles, self.normals, self.corner_angles, count))[0]

    @cached_property
    def corner_angles(self) -> Floats:
        """Interior angles of the faces at their corners (m, 3) radians."""
        return _frozen(unfold.corner_angles(self.points, self.triangles))[0]

    @cached_property
    def deficits(self) -> Floats:
        """Angle deficits at the vertices (n,) radians: 2π less the angles of the faces there; 0 on the rim."""
        count = len(self.points)
        return _frozen(unfold.angle_deficits(self.triangles, self.neighbours, self.corner_angles, count))[0]

    @cached_property
    def area(self) -> float:
        """Area of the whole part, mm²."""
        return float(self.areas.sum())

    @cached_property
    def bounds(self) -> Floats:
        """Least and greatest coordinates (2, 3) mm."""
        return _frozen(np.array([self.points.min(axis=0), self.points.max(axis=0)]))[0]

    @cached_property
    def diagonal(self) -> float:
        """Length of the bounding box's diagonal, mm."""
        return float(np.linalg.norm(self.bounds[1] - self.bounds[0]))

    @cached_property
    def mean_edge(self) -> float:
        """Mean length of the faces' edges, mm."""
        return float(np.sqrt(edge_lengths_squared(self.points, self.triangles)).mean())

    @cached_property
    def closed(self) -> bool:
        """Whether every edge has two faces."""
        return bool((self.neighbours >= 0).all())

    @cached_property
    def centroid(self) -> Floats:
        """Centre of the area (3,) mm; it need not lie on the surface."""
        _, area, center = component_sums(self.points, self.triangles, self.areas, self.component, self.n_components)
        return _frozen((center * (area / self.area)[:, None]).sum(axis=0))[0]

    @cached_property
    def boundary_loops(self) -> tuple[Ints, ...]:
        """Closed loops of boundary edges, each (k,) int64 of 3 * face + edge, in the faces' direction."""
        walk, start = topology.boundary_walk(self.triangles, self.neighbours, len(self.points))
        return tuple(_frozen(*np.split(walk, start[1:-1]))) if len(walk) else ()

    @cached_property
    def lidded(self) -> Surface:
        """The same part with its holes covered; lids are the faces behind its own. Itself if it has no hole."""
        mesh = lids.cover(self._mesh, self.boundary_loops, self.normals)
        return self if mesh is self._mesh else Surface._of(mesh, self.source, self.notes, self.findings)

    @cached_property
    def _pieces(self) -> dict[int, Surface]:
        """The components that were asked for: what is prepared for one is kept with it."""
        return {}

    @cached_property
    def on_rim(self) -> np.ndarray:
        """Whether each vertex (n,) is on the rim."""
        out = np.zeros(len(self.points), np.bool_)
        f, k = np.nonzero(self.neighbours < 0)
        out[self.triangles[f, k]] = True
        out[self.triangles[f, (k + 1) % 3]] = True
        return out

    @cached_property
    def _tree(self) -> NearestTree:
        return NearestTree(self.points, self.triangles)

    def nearest(self, points: Any) -> Nearest:
        """Nearest points of the surface to points (k, 3) mm; exact at any scale."""
        queries = np.atleast_2d(np.asarray(points, dtype=np.float64))
        return self._nearest_to_one(queries) if len(queries) == 1 else self._tree.query(queries)

    def _nearest_to_one(self, query: Floats) -> Nearest:
        """As of ``nearest``, without a tree of the whole part for the first few of which that is asked."""
        asked, key = self._asked, query.tobytes()
        if key in asked:
            return asked[key]
        if len(asked) < FEW and "_tree" not in self.__dict__:
            found = nearest_to_one(self.points, self.triangles, query)
        else:
            found = self._tree.query(query)
        found = of_lowest_number(found, self.points, self.triangles)
        _frozen(found.face, found.point, found.distance)
        # a new one in its place, never one that changes: threads may share a part
        self.__dict__["_asked"] = dict([*asked.items(), (key, found)][-FEW:])
        return found

    @cached_property
    def _asked(self) -> dict[bytes, Nearest]:
        """The single points last asked for: a drape asks for its origin several times."""
        return {}

    def only_component(self, face: int) -> Surface:
        """The component that contains the face; source_face and vertex_of_input still refer to the input."""
        if self.n_components == 1:
            return self
        label = int(self.component[face])
        if label not in self._pieces:
            mesh = take_component(self._mesh, label)
            self._pieces[label] = Surface._of(mesh, self.source, self.notes, self.findings)
        return self._pieces[label]

    def numbered_as_welded(self) -> Surface:
        """The same part, with its own vertex numbers taken for those of the input."""
        mesh = replace(self._mesh, vertex_of_input=np.arange(len(self.points)))
        return Surface._of(mesh, self.source, self.notes, self.findings)

    def numbered_by(self, vertex_of_input: Ints) -> Surface:
        """The same part, with the vertex numbers of the input of another (k,), whose vertices come first in this."""
        own = self._mesh.vertex_of_input
        numbers = np.where(vertex_of_input >= 0, own[vertex_of_input], -1)
        return Surface._of(replace(self._mesh, vertex_of_input=numbers), self.source, self.notes, self.findings)

    def moved(self, points: Floats) -> Surface:
        """The same triangles with their vertices at other points (n, 3) mm; findings are those of this surface."""
        mesh = replace(self._mesh, points=np.array(points, dtype=np.float64, order="C"))
        return Surface._of(mesh, self.source, self.notes, self.findings)

    def cut(self, *lines: Any, names: Sequence[str] | None = None) -> Surface:
        """The same part with a slit along each line through points (k, 3) mm, which a ply does not cross.

        Between its points a line follows the section of the part along the normals there; lines may cross and touch.
        ``names`` are how messages call them. Raises SurfaceError for fewer than two points, points further from the
        part than a hundredth of its diagonal, lines that do not run over the part, and cuts that cut nothing.
        """
        if not lines:
            raise SurfaceError(f"{self.source}: there is no line to cut along; give one at least")
        called = list(names) if names is not None else [f"cut {n}" for n in range(1, len(lines) + 1)]
        laid = [self._laid(_line(points, name), name) for points, name in zip(lines, called, strict=True)]
        mesh, length = cut_along(self._mesh, laid)
        if length == 0.0:
            raise SurfaceError(f"{', '.join(called)}: the line runs along the rim and cuts nothing; draw it inwards")
        mesh = replace(mesh, cuts=(*mesh.cuts, *called), cut_length=mesh.cut_length + length)
        return Surface._of(mesh, self.source, self.notes, self.findings)

    def _laid(self, points: Floats, name: str) -> Line:
        near = self.nearest(points)
        far = int(near.distance.argmax())
        if near.distance[far] > CUT_OFF * self.diagonal:
            x, y, z = points[far]
            raise SurfaceError(
                f"{name} leaves {self.source}: ({x:.6g}, {y:.6g}, {z:.6g}) lies {near.distance[far]:.4g} mm off; "
                "draw it on the part; its unit is mm, whatever --unit the part has"
            )
        return Line(near.point, near.face, self.normals[near.face], name)

    @property
    def cuts(self) -> tuple[str, ...]:
        """Names of the lines that the part was cut along."""
        return self._mesh.cuts

    @property
    def cut_length(self) -> float:
        """Length of all its cuts, mm."""
        return self._mesh.cut_length

    def doubted(self, hint: str) -> Surface:
        """The same part with a hint on its unit among its findings."""
        return Surface._of(self._mesh, self.source, self.notes, replace(self.findings, unit_hint=hint))

    def flipped(self) -> Surface:
        """The same part with all normals turned."""
        return Surface._of(turn_over(self._mesh), self.source, self.notes, self.findings)

    def require_drapable(self) -> None:
        """Raise SurfaceError, with positions, where the part is not a surface that a ply can lie on."""
        defects.require_drapable(self._mesh, self.source)


def _line(points: Any, name: str) -> Floats:
    """Points (k, 3) of a line, those that repeat the one before left out."""
    try:
        line = np.asarray(points, dtype=np.float64)
    except (TypeError, ValueError):
        line = np.empty(0)
    if line.ndim != 2 or line.shape[1] != 3 or not np.isfinite(line).all():
        raise SurfaceError(f"{name} must be points (k, 3) in mm, finite numbers x, y, z")
    line = line[np.concatenate([[True], (np.diff(line, axis=0) != 0.0).any(axis=1)])] if len(line) else line
    if len(line) < 2:
        raise SurfaceError(f"{name} must have two different points at least")
    return line


def _frozen(*arrays: Any) -> Any:
    for array in arrays:
        array.setflags(write=False)
    return arrays


def _checked(points: Any, triangles: Any, source: str) -> tuple[Floats, Ints]:
    """Arrays of the right shape with finite coordinates and vertex numbers in range."""
    try:
        # copies: the caller's arrays stay his, and kernels are compiled for one kind of array only
        vertices = np.array(points, dtype=np.float64, order="C")
        faces = np.asarray(triangles)
    except (TypeError, ValueError) as error:
        raise SurfaceError(f"{source}: points and triangles must be arrays of numbers ({error})") from None
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise SurfaceError(f"{source}: points must be an array (n, 3), not {vertices.shape}")
    if len(faces) == 0:
        raise SurfaceError(f"{source}: there are no triangles; export the part as a triangulated surface")
    if faces.ndim != 2 or faces.shape[1] != 3 or not np.issubdtype(faces.dtype, np.integer):
        raise SurfaceError(f"{source}: triangles must be integers (m, 3), not {faces.dtype} {faces.shape}")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise SurfaceError(
            f"{source}: triangles name vertices {faces.min()} to {faces.max()}, but there are {len(vertices)}"
        )
    if not np.isfinite(vertices).all():
        worst = int(np.flatnonzero(~np.isfinite(vertices).all(axis=1))[0])
        raise SurfaceError(f"{source}: vertex {worst} is not a point (NaN or infinite); repair the file")
    faces = np.array(faces, dtype=np.int64, order="C")
    _, low, high = used_points(vertices, faces)
    size = float((high - low).max())
    if max(high.max(), -low.min()) > SIZES[1] or 0.0 < size < SIZES[0]:
        raise SurfaceError(f"{source}: the part is {size:.3g} mm across or far away; check its unit")
    return vertices, faces
