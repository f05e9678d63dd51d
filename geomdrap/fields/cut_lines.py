"""What cuts into the part come to in the flat fabric: lines that stay shut, and tears beyond their ends."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fields.slit import seams

if TYPE_CHECKING:
    from geomdrap.fields.trim import Trimmed

SHUT = 1e-3  # of the pitch: sides nearer than this lie upon each other, and no contour shows them


def shut_cuts(trimmed: Trimmed, pitch: float, reach: tuple[float, float] | None) -> tuple[np.ndarray, ...]:
    """Pieces (2, 2) mm of the flat fabric along which it is cut, but both sides stay where they are.

    Those beyond the blank, ``reach`` half lengths mm, are left out, by their middles.
    """
    half = np.inf if reach is None else np.asarray(reach)
    mesh, at = trimmed.mesh, trimmed.at
    face, edge = np.nonzero((mesh.neighbours < 0) & (trimmed.kind > 0)[:, None])
    after = (edge + 1) % 3
    ends = mesh.points[mesh.triangles[face, edge]], mesh.points[mesh.triangles[face, after]]
    flat = np.stack([at[face, edge], at[face, after]], axis=1)
    # the two sides of a cut have the same places in space, one there and one back
    there = {np.concatenate([a, b]).tobytes(): n for n, (a, b) in enumerate(zip(*ends, strict=True))}
    found = []
    for n, (a, b) in enumerate(zip(*ends, strict=True)):
        m = there.get(np.concatenate([b, a]).tobytes(), -1)
        within = (np.abs(flat[n].mean(axis=0)) <= half).all()
        if m > n and within and np.abs(flat[n] - flat[m][::-1]).max() < SHUT * pitch:
            found.append(flat[n])
    return tuple(found)


def torn(trimmed: Trimmed, pitch: float) -> tuple[float, float]:
    """Length, mm, of the lines on which draped facets side by side do not join in the fabric, and the widest gap."""
    mesh, at = trimmed.mesh, trimmed.at
    face, edge = np.divmod(seams(at / pitch, trimmed.kind, mesh.neighbours, mesh.neighbour_edge), 3)
    if not len(face):
        return 0.0, 0.0
    other, slot = mesh.neighbours[face, edge], mesh.neighbour_edge[face, edge].astype(np.int64)
    gap = np.linalg.norm(
        [at[face, edge] - at[other, (slot + 1) % 3], at[face, (edge + 1) % 3] - at[other, slot]], axis=2
    )
    ends = mesh.points[mesh.triangles[face, edge]], mesh.points[mesh.triangles[face, (edge + 1) % 3]]
    return float(np.linalg.norm(ends[1] - ends[0], axis=1).sum()), float(gap.max())
