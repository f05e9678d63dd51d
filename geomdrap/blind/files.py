"""Files of a blind set: the part as STL, the measured table, and what the person who measured believes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geomdrap.blind.marks import Marks
from geomdrap.blind.terms import Array
from geomdrap.blind.tools import Tool

FACETS = 15_000
COLUMNS = {
    "all": ("u", "v", "x", "y", "z", "shear"),
    "positions": ("u", "v", "x", "y", "z"),
    "shear": ("x", "y", "z", "shear"),
    "directions": ("x", "y", "z", "warp_x", "warp_y", "warp_z", "weft_x", "weft_y", "weft_z"),
}
"""What was recorded, by name."""


def write_part(path: Path, tool: Tool) -> int:
    """Write the tool as binary STL of about FACETS facets, normals upward; gives their number."""
    facets = _facets(tool)
    edges = facets[:, 1:] - facets[:, :1]
    normal = np.cross(edges[:, 0], edges[:, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    record = np.zeros(len(facets), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    record["normal"], record["corners"] = normal, facets
    head = f"blind part {tool.name}".encode().ljust(80)
    path.write_bytes(head + np.uint32(len(facets)).tobytes() + record.tobytes())
    return len(facets)


def _facets(tool: Tool) -> Array:
    """Corners (f, 3, 3) of two facets per square of a grid, the diagonals in turn."""
    across = np.sqrt(FACETS / 2.0 * tool.half[0] / tool.half[1])
    nx, ny = round(across), round(FACETS / 2.0 / across)
    x, y = (np.linspace(-half, half, n + 1) for half, n in zip(tool.half, (nx, ny), strict=True))
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    p = np.concatenate([grid, tool.height(grid[..., 0], grid[..., 1])[..., None]], axis=-1)
    a, b, c, d = (q.reshape(-1, 3) for q in (p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]))
    odd = (np.add.outer(np.arange(nx), np.arange(ny)) % 2 == 1).ravel()
    one = np.where(odd[:, None, None], np.stack([a, b, c], axis=1), np.stack([a, b, d], axis=1))
    two = np.where(odd[:, None, None], np.stack([a, c, d], axis=1), np.stack([b, c, d], axis=1))
    return np.concatenate([one, two])


def write_measured(path: Path, marks: Marks, columns: str) -> None:
    """Write the table with the ``columns`` (a key of COLUMNS), mm and deg."""
    every = np.column_stack([marks.uv, marks.points, marks.shear, marks.warp, marks.weft])
    names = [*COLUMNS["all"], *COLUMNS["directions"][3:]]
    at = [names.index(name) for name in COLUMNS[columns]]
    rows = [",".join(COLUMNS[columns]), *(",".join(f"{value:.4f}" for value in row) for row in every[:, at])]
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")


def write_setup(path: Path, origin: Array, angle: float, sigma_xyz: float, sigma_shear: float) -> None:
    """Write what the person who measured believes: ``origin`` (3,) mm, ``angle`` deg, instrument noise."""
    x, y, z = origin
    path.write_text(
        f"origin = [{x:.4f}, {y:.4f}, {z:.4f}]   # mm\n"
        f"angle = {angle:.4f}   # degrees from the part's +x, in the tangent plane\n"
        f"sigma_xyz = {sigma_xyz:.6g}   # mm, instrument\n"
        f"sigma_shear = {sigma_shear:.6g}   # degrees, instrument\n",
        encoding="utf-8",
    )
