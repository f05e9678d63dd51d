"""Finite element meshes (VTU, VTK, Gmsh, Abaqus, Nastran) through meshio: their shells, as triangles."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path
from typing import Any

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface.formats.raw import RawMesh
from geomdrap.surface.types import Floats, Ints

TRIANGLES = ("triangle", "triangle6", "triangle7", "triangle10")
QUADS = ("quad", "quad8", "quad9")
NOT_SURFACE = ("vertex", "line", "line3")


def read(path: Path, tolerance: float | None) -> RawMesh:
    """Merge all shell elements; quads are split, second-order elements taken by their corners.

    Raises SurfaceError where there are only volume elements, lines or points.
    """
    import meshio

    try:
        # meshio prints its complaints, and leaves by SystemExit where no reader fits
        with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()):
            mesh = meshio.read(path)
        points = np.asarray(mesh.points, dtype=np.float64)
    except (Exception, SystemExit) as error:
        reason = (str(error).strip().splitlines() or [""])[0][:120]
        if isinstance(error, UnicodeDecodeError):
            reason = "it is neither text nor what its name says"
        detail = f" ({reason})" if reason and not reason.isdigit() else ""
        raise SurfaceError(
            f"{path.name} cannot be read as a {path.suffix} mesh{detail}; export the part again"
        ) from None
    if points.ndim == 2 and points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    triangles, numbers = _shells(points, mesh.cells, path.name)
    return RawMesh(points, triangles, numbers, _notes(mesh.cells))


def _shells(points: Floats, blocks: Any, name: str) -> tuple[Ints, Ints]:
    """Triangles (m, 3) of all shell elements and the element's number, counted over shell elements only."""
    triangles, numbers, done = [], [], 0
    for block in blocks:
        if block.type not in TRIANGLES + QUADS:
            continue
        corners = np.asarray(block.data, dtype=np.int64)
        if len(corners) and (corners.min() < 0 or corners.max() >= len(points)):
            raise SurfaceError(f"{name}: an element names a node that is not there; export the part again")
        number = np.arange(done, done + len(corners))
        done += len(corners)
        if block.type in QUADS:
            triangles.append(split_quads(points, corners[:, :4]))
            number = np.repeat(number, 2)
        else:
            triangles.append(corners[:, :3])
        numbers.append(number)
    if done == 0:
        kinds = sorted({block.type for block in blocks})
        volume = [kind for kind in kinds if kind not in NOT_SURFACE]
        what = f"only volume elements ({', '.join(volume)})" if volume else "only points or lines, no faces"
        raise SurfaceError(f"{name} holds {what}; export the surface of the part as triangles or quads")
    return np.concatenate(triangles), np.concatenate(numbers)


def split_quads(points: Floats, quads: Ints) -> Ints:
    """Two triangles (2 q, 3) for each quad (q, 4), next to each other, split along the shorter diagonal.

    A quad with a corner pushed in is split from that corner, the only diagonal that lies inside.
    """
    a, b, c, d = (points[quads[:, i]] for i in range(4))
    by_ac = _agreement(a, b, c, d)
    by_bd = _agreement(b, c, d, a)
    shorter = np.linalg.norm(a - c, axis=1) <= np.linalg.norm(b - d, axis=1)
    use_ac = np.where((by_ac > 0) == (by_bd > 0), shorter, by_ac > 0)
    first = np.where(use_ac[:, None], quads[:, [0, 1, 2]], quads[:, [1, 2, 3]])
    second = np.where(use_ac[:, None], quads[:, [0, 2, 3]], quads[:, [1, 3, 0]])
    return np.stack([first, second], axis=1).reshape(-1, 3)


def _agreement(a: Floats, b: Floats, c: Floats, d: Floats) -> Floats:
    """Positive where triangles abc and acd face the same way."""
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), np.cross(c - a, d - a))


def _notes(blocks: Any) -> tuple[str, ...]:
    number = {block.type: 0 for block in blocks}
    for block in blocks:
        number[block.type] += len(block.data)
    quads = sum(number.get(kind, 0) for kind in QUADS)
    curved = sum(n for kind, n in number.items() if kind in TRIANGLES[1:] + QUADS[1:])
    volume = sum(n for kind, n in number.items() if kind not in TRIANGLES + QUADS + NOT_SURFACE)
    notes = []
    if quads:
        notes.append(f"{quads:,} quads split into triangles")
    if curved:
        notes.append(f"{curved:,} second-order elements taken by their corners")
    if volume:
        notes.append(f"{volume:,} volume elements left out: only the shells are the tool")
    return tuple(notes)
