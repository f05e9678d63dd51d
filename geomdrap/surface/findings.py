"""What was found in a mesh and what was repaired, in a form to read and a form to store."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from typing import Any

Point = tuple[float, float, float]
#: how many of a kind are described one by one; all are counted
LISTED = 20


@dataclass(frozen=True)
class Component:
    """A piece of the part that hangs together by edges; area mm², center mm."""

    faces: int
    area: float
    center: Point
    closed: bool
    orientable: bool
    doubled: bool


@dataclass(frozen=True)
class Loop:
    """A closed line of boundary edges: length and center mm; a component's longest is its outer contour."""

    component: int
    edges: int
    length: float
    center: Point
    outer: bool


@dataclass(frozen=True)
class Findings:
    """Counts and places of what is unusual in a mesh. Lengths in mm, areas in mm².

    Lists (components, loops, places) hold the largest or first LISTED; the counts beside them count all.
    """

    faces_input: int
    points_input: int
    faces: int
    points: int
    weld_tolerance: float
    welded: int
    unused_points: int
    degenerate_faces: int
    flipped_edges: int
    turned_faces: int
    duplicate_faces: int
    n_components: int
    n_closed: int
    components: tuple[Component, ...]
    n_loops: int
    loops: tuple[Loop, ...]
    n_non_manifold: int
    non_manifold: tuple[Point, ...]
    n_bow_ties: int
    bow_ties: tuple[Point, ...]
    n_slivers: int
    worst_sliver: float
    n_cracks: int
    cracks: tuple[Point, ...]
    unit_hint: str
    notes: tuple[str, ...] = ()

    @property
    def n_holes(self) -> int:
        """Number of boundary loops beyond one outer contour for each open component."""
        open_components = self.n_components - self.n_closed
        return max(0, self.n_loops - open_components)

    def as_dict(self) -> dict[str, Any]:
        """Plain numbers, strings, lists: ready for JSON."""
        return {**asdict(self), "n_holes": self.n_holes}

    def lines(self) -> tuple[str, ...]:
        """One readable sentence for each thing found or repaired; empty where the mesh is clean."""
        return tuple(_sentences(self))


def place(point: Iterable[float]) -> str:
    """Write a point as (x, y, z) with six figures, and a millionth of the largest number as none."""
    numbers = [float(x) for x in point]
    least = 1e-6 * max((abs(x) for x in numbers), default=0.0)
    return "(" + ", ".join(f"{x if abs(x) > max(least, 1e-9) else 0.0:.6g}" for x in numbers) + ")"


def places(points: tuple[Point, ...], total: int, show: int = 3) -> str:
    """Write a few points and say how many more there are."""
    text = ", ".join(place(p) for p in points[:show])
    return text if total <= show else f"{text} and {total - show} more"


def count(n: int, singular: str, plural: str = "") -> str:
    """Write a number with its noun."""
    return f"{n:,} {singular if n == 1 else plural or singular + 's'}"


def _sentences(found: Findings) -> Iterator[str]:
    yield from found.notes
    if found.unit_hint:
        yield found.unit_hint
    yield from _repairs(found)
    if found.n_components > 1:
        sizes = ", ".join(f"{c.area:.6g} mm² at {place(c.center)}" for c in found.components[:3])
        more = f" and {found.n_components - 3} more" if found.n_components > 3 else ""
        yield f"{found.n_components} separate components: {sizes}{more}"
    holes = [loop for loop in found.loops if not loop.outer]
    if found.n_holes:
        text = ", ".join(f"{h.length:.6g} mm round {place(h.center)}" for h in holes[:3])
        more = f" and {found.n_holes - 3} more" if found.n_holes > 3 else ""
        yield f"{count(found.n_holes, 'hole')}: {text}{more}"
    if found.n_non_manifold:
        yield (
            f"{count(found.n_non_manifold, 'edge')} with more than two faces (not a surface there) "
            f"at {places(found.non_manifold, found.n_non_manifold)}"
        )
    if any(not c.orientable for c in found.components):
        yield "a component has only one side (Möbius strip): no consistent normal"
    if any(c.doubled for c in found.components):
        yield "a component is there twice (every triangle has a twin)"
    if found.n_cracks:
        yield (
            f"{count(found.n_cracks, 'vertex', 'vertices')} on the middle of another face's edge (crack, "
            f"T-junction: the net stops there) at {places(found.cracks, found.n_cracks)}"
        )
    if found.n_slivers:
        yield (
            f"{count(found.n_slivers, 'sliver face')} (height under 1/1000 of the longest edge; "
            f"the worst {found.worst_sliver:.2g})"
        )


def _repairs(found: Findings) -> Iterator[str]:
    if found.degenerate_faces:
        yield f"{count(found.degenerate_faces, 'face')} without area dropped"
    if found.flipped_edges:
        yield f"{count(found.flipped_edges, 'flat face')} merged with the neighbour by turning the long edge"
    if found.duplicate_faces:
        yield f"{count(found.duplicate_faces, 'face')} there more than once: kept once"
    if found.turned_faces:
        yield f"{count(found.turned_faces, 'face')} turned over so that all face the same way"
    if found.unused_points:
        yield f"{count(found.unused_points, 'vertex', 'vertices')} without a face dropped"
    if found.n_bow_ties:
        yield (
            f"{count(found.n_bow_ties, 'vertex', 'vertices')} where faces touch only in a point, "
            f"parted, at {places(found.bow_ties, found.n_bow_ties)}"
        )
