"""Putting nodes and yarn pieces into the grid; a net that comes back over itself is stopped here."""

from __future__ import annotations

import math

import numpy as np

from geomdrap.fishnet.grid import (
    PIECES,
    POINT,
    STATUS,
    STRAIN,
    WARP_IN,
    WARP_OUT,
    WEFT_IN,
    WEFT_OUT,
    Grid,
)
from geomdrap.geodesic.compiled import inlined, kernel
from geomdrap.geodesic.mesh import Mesh, in_space, normal_of

PRESENT = 1
MEETS_ITSELF = 6
WARP_PIECE = 1
WEFT_PIECE = 2

# A node is refused where a node of another stretch of the net is within NEAR sides of it, sideways, on the same
# sheet: SHEET sides along the normal, normals within 60°. Stretches differ by more than APART in i or j: cells
# sheared by 80° still keep nodes that are 4 apart 1.4 sides away from each other.
NEAR = 0.75
SHEET = 0.35
ROUND_EDGE = 0.5  # sides: nodes this close are on one sheet round an edge of up to 107°, too
APART = 3
# Space is hashed in cubes of CUBE sides, each with the range of i and j that it holds: as long as no two of them are
# more than APART from the node (``Grid.box[4]``), they need not be looked at one by one.
CUBE = 4.0
HEAD, LEAST_I, MOST_I, LEAST_J, MOST_J = 0, 1, 2, 3, 4  # columns of Grid.bucket


@inlined
def bucket_of(a: int, b: int, c: int, mask: int) -> int:
    """Bucket of a cube of the lattice."""
    return ((a * 73856093) ^ (b * 19349663) ^ (c * 83492791)) & mask


@kernel
def is_near_stranger(
    mesh: Mesh, grid: Grid, key: int, i: int, j: int, face: int, px: float, py: float, pz: float, side: float
) -> bool:
    """Whether a bucket holds a node of another stretch of the net, on the same sheet and near."""
    nx, ny, nz = normal_of(mesh.frames, face)
    link = grid.bucket[key, HEAD]
    while link > 0:
        k, m = (link - 1) >> 32, (link - 1) & 0xFFFFFFFF
        link = grid.following[k, m]
        if abs(k - i) > APART or abs(m - j) > APART:
            other = grid.face[k, m] - 1
            qx, qy, qz = in_space(mesh.frames, other, grid.node[k, m, 0], grid.node[k, m, 1])
            qx, qy, qz = qx - px, qy - py, qz - pz
            off = qx * nx + qy * ny + qz * nz
            away2 = qx * qx + qy * qy + qz * qz
            if away2 - off * off < (NEAR * side) ** 2 and abs(off) < SHEET * side:
                ox, oy, oz = normal_of(mesh.frames, other)
                if ox * nx + oy * ny + oz * nz > 0.5:
                    return True
            if away2 < (ROUND_EDGE * side) ** 2:
                ox, oy, oz = normal_of(mesh.frames, other)
                if ox * nx + oy * ny + oz * nz > -0.3:
                    return True
    return False


@inlined
def meets_itself(
    mesh: Mesh, grid: Grid, i: int, j: int, face: int, px: float, py: float, pz: float, side: float
) -> bool:
    """Whether another stretch of the net lies where node (i, j) is about to be put."""
    mask = len(grid.bucket) - 1
    per = 1.0 / (CUBE * side)
    reach = NEAR / CUBE
    one_sheet = grid.box[4]
    x, y, z = px * per, py * per, pz * per
    found = False
    for a in range(math.floor(x - reach), math.floor(x + reach) + 1):
        for b in range(math.floor(y - reach), math.floor(y + reach) + 1):
            for c in range(math.floor(z - reach), math.floor(z + reach) + 1):
                key = bucket_of(a, b, c, mask)
                if grid.bucket[key, HEAD] > 0 and (
                    i - grid.bucket[key, LEAST_I] > one_sheet
                    or grid.bucket[key, MOST_I] - i > one_sheet
                    or j - grid.bucket[key, LEAST_J] > one_sheet
                    or grid.bucket[key, MOST_J] - j > one_sheet
                ):
                    found = found or is_near_stranger(mesh, grid, key, i, j, face, px, py, pz, side)
    return found


@inlined
def enter(grid: Grid, i: int, j: int, px: float, py: float, pz: float, side: float) -> None:
    """Enter node (i, j) into the hash."""
    per = 1.0 / (CUBE * side)
    key = bucket_of(math.floor(px * per), math.floor(py * per), math.floor(pz * per), len(grid.bucket) - 1)
    grid.following[i, j] = grid.bucket[key, HEAD]
    first = grid.bucket[key, HEAD] == 0
    grid.bucket[key, HEAD] = (i << 32 | j) + 1
    grid.bucket[key, LEAST_I] = i if first else min(grid.bucket[key, LEAST_I], i)
    grid.bucket[key, MOST_I] = i if first else max(grid.bucket[key, MOST_I], i)
    grid.bucket[key, LEAST_J] = j if first else min(grid.bucket[key, LEAST_J], j)
    grid.bucket[key, MOST_J] = j if first else max(grid.bucket[key, MOST_J], j)


@inlined
def place(mesh: Mesh, grid: Grid, i: int, j: int, face: int, x: float, y: float, side: float) -> bool:
    """Put node (i, j) on a face unless the net is there already; False (with the status set) if it is."""
    px, py, pz = in_space(mesh.frames, face, x, y)
    free = not meets_itself(mesh, grid, i, j, face, px, py, pz, side)
    if free:
        enter(grid, i, j, px, py, pz, side)
        grid.face[i, j] = face + 1
        grid.node[i, j, POINT] = x
        grid.node[i, j, POINT + 1] = y
        grid.box[0] = min(grid.box[0], i)
        grid.box[1] = max(grid.box[1], i)
        grid.box[2] = min(grid.box[2], j)
        grid.box[3] = max(grid.box[3], j)
    grid.marks[i, j, STATUS] = PRESENT if free else MEETS_ITSELF
    return free


@inlined
def has_piece(grid: Grid, i: int, j: int, di: int, dj: int) -> bool:
    """Whether the yarn piece from node (i, j) to (i + di, j + dj) exists."""
    if dj == 0:
        return (grid.marks[i if di > 0 else i - 1, j, PIECES] & WARP_PIECE) != 0
    return (grid.marks[i, j if dj > 0 else j - 1, PIECES] & WEFT_PIECE) != 0


@inlined
def departure(grid: Grid, i: int, j: int, di: int, dj: int) -> tuple[float, float]:
    """Direction, in the frame of node (i, j), in which the existing piece toward (i + di, j + dj) leaves it."""
    sign = di + dj
    at = (WARP_OUT if di > 0 else WARP_IN) if dj == 0 else (WEFT_OUT if dj > 0 else WEFT_IN)
    return sign * grid.node[i, j, at], sign * grid.node[i, j, at + 1]


@inlined
def depart_as(grid: Grid, i: int, j: int, di: int, dj: int, x: float, y: float) -> None:
    """Set the direction in which the piece toward (i + di, j + dj) leaves node (i, j)."""
    sign = di + dj
    at = (WARP_OUT if di > 0 else WARP_IN) if dj == 0 else (WEFT_OUT if dj > 0 else WEFT_IN)
    grid.node[i, j, at] = sign * x
    grid.node[i, j, at + 1] = sign * y


@inlined
def add_piece(grid: Grid, i: int, j: int, di: int, dj: int, ox: float, oy: float, ax: float, ay: float) -> None:
    """Add the piece from (i, j) to (i + di, j + dj) that leaves in direction o and arrives in direction a."""
    depart_as(grid, i, j, di, dj, ox, oy)
    depart_as(grid, i + di, j + dj, -di, -dj, -ax, -ay)
    if dj == 0:
        grid.marks[i if di > 0 else i - 1, j, PIECES] |= WARP_PIECE
    else:
        grid.marks[i, j if dj > 0 else j - 1, PIECES] |= WEFT_PIECE


@inlined
def side_between(grid: Grid, i: int, j: int, di: int, dj: int) -> float:
    """Length of the piece from (i, j) to (i + di, j + dj), mm."""
    if dj == 0:
        return grid.sides_u[i if di > 0 else i - 1]
    low = j if dj > 0 else j - 1
    return grid.sides_v[low] * (1.0 + grid.node[i, low, STRAIN])


@kernel
def place_seed(
    mesh: Mesh, grid: Grid, i: int, j: int, face: int, x: float, y: float, dx: float, dy: float, weft_rad: float
) -> None:
    """Put the seed, with the warp in direction (dx, dy) of its face's frame and the weft turned from it."""
    place(mesh, grid, i, j, face, x, y, grid.sides_u[0])
    c, s = math.cos(weft_rad), math.sin(weft_rad)
    ex, ey = c * dx - s * dy, s * dx + c * dy
    depart_as(grid, i, j, 1, 0, dx, dy)
    depart_as(grid, i, j, -1, 0, -dx, -dy)
    depart_as(grid, i, j, 0, 1, ex, ey)
    depart_as(grid, i, j, 0, -1, -ex, -ey)


@kernel
def all_in_space(mesh: Mesh, grid: Grid, i0: int, i1: int, j0: int, j1: int) -> np.ndarray:
    """Nodes [i0:i1, j0:j1] in space (i1 - i0, j1 - j0, 3), NaN where there is none."""
    points = np.full((i1 - i0, j1 - j0, 3), np.nan)
    for i in range(i0, i1):
        for j in range(j0, j1):
            if grid.face[i, j] > 0:
                p = in_space(mesh.frames, grid.face[i, j] - 1, grid.node[i, j, 0], grid.node[i, j, 1])
                points[i - i0, j - j0, 0], points[i - i0, j - j0, 1], points[i - i0, j - j0, 2] = p
    return points
