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
from geomdrap.geodesic.compiled import inlined, kernel, tight
from geomdrap.geodesic.mesh import Mesh, in_space, normal_of

PRESENT = 1
OFF_PART = 2
MEETS_ITSELF = 6
NEEDS_DART = 13
WARP_PIECE = 1
WEFT_PIECE = 2

# A node is refused where a node of another stretch of the net is within NEAR sides of it, sideways, on the same
# sheet: SHEET sides along the normal, normals within 60°. Nodes up to APART in i and j are of one stretch, and so are
# those between which the net goes straight on, in the lattice, within ONE_PATCH sides: where cells shear by 80°
# nodes that are four apart come as near as that. Nodes SQUEEZED apart do so where all cells between them shear by
# 85°: there the net is folding.
NEAR = 0.75
SHEET = 0.35
ROUND_EDGE = 0.5  # sides: nodes this close are on one sheet round an edge of up to 107°, too
APART = 3
ONE_PATCH = 1.0
SQUEEZED = 8
NEAR_FOLD = 16  # apart in i or j: stretches that meet this near to what parts them need a dart there
# Space is hashed in cubes of CUBE sides, each with the range of i and j that it holds: as long as no two of them are
# more than APART from the node (``Grid.box[4]``), they need not be looked at one by one.
CUBE = 3.0
ROUNDED = 0.05  # of a side squared: the places in the hash have few digits
# columns of Grid.bucket: the node entered last as i + 1 and j, then the ranges
HEAD, HEAD_J, LEAST_I, MOST_I, LEAST_J, MOST_J = 0, 1, 2, 3, 4, 5


@inlined
def bucket_of(a: int, b: int, c: int, mask: int) -> int:
    """Bucket of a cube of the lattice."""
    return ((a * 73856093) ^ (b * 19349663) ^ (c * 83492791)) & mask


@tight
def between(mesh: Mesh, grid: Grid, i: int, j: int, k: int, m: int, px: float, py: float, pz: float) -> int:
    """What lies straight between two nodes in the lattice: PRESENT where that is net near (px, py, pz) mm.

    NEEDS_DART where the net between them is squeezed together, or where they are near in the lattice and what lies
    between them is folded or has no room on the part: they meet beyond the tip of a cone. MEETS_ITSELF where the net
    leads away on its way from one to the other.
    """
    di, dj = k - i, m - j
    steps = max(abs(di), abs(dj))
    most = (ONE_PATCH * grid.sides_u[0]) ** 2
    one, torn = True, False
    for n in range(1, steps):  # rounded away from (i, j), so that no sense of u or v is preferred
        a = i + (1 if di > 0 else -1) * ((2 * n * abs(di) + steps) // (2 * steps))
        b = j + (1 if dj > 0 else -1) * ((2 * n * abs(dj) + steps) // (2 * steps))
        status = grid.marks[a, b, STATUS]
        torn = torn or status not in (PRESENT, OFF_PART)
        if one and status == PRESENT:
            qx, qy, qz = in_space(mesh.frames, grid.face[a, b] - 1, grid.node[a, b, 0], grid.node[a, b, 1])
            one = (qx - px) ** 2 + (qy - py) ** 2 + (qz - pz) ** 2 <= most
        else:
            one = False
    if torn and steps <= NEAR_FOLD:
        return NEEDS_DART
    if not one:
        return MEETS_ITSELF
    return PRESENT if steps < SQUEEZED else NEEDS_DART


@tight
def is_near(mesh: Mesh, grid: Grid, face: int, px: float, py: float, pz: float, k: int, m: int) -> bool:
    """Whether node (k, m) lies where a point of a face does, on the same sheet; either sees it from the other."""
    side = grid.sides_u[0]
    other = grid.face[k, m] - 1
    qx, qy, qz = in_space(mesh.frames, other, grid.node[k, m, 0], grid.node[k, m, 1])
    qx, qy, qz = qx - px, qy - py, qz - pz
    away2 = qx * qx + qy * qy + qz * qz
    if away2 > (NEAR * NEAR + SHEET * SHEET) * side * side:
        return False
    nx, ny, nz = normal_of(mesh.frames, face)
    ox, oy, oz = normal_of(mesh.frames, other)
    alike = ox * nx + oy * ny + oz * nz
    off = max(abs(qx * nx + qy * ny + qz * nz), abs(qx * ox + qy * oy + qz * oz))
    if alike > 0.5 and away2 - off * off < (NEAR * side) ** 2 and off < SHEET * side:
        return True
    return alike > -0.3 and away2 < (ROUND_EDGE * side) ** 2


@inlined
def stranger_in(
    mesh: Mesh, grid: Grid, key: int, i: int, j: int, face: int, px: float, py: float, pz: float
) -> int:
    """Why node (i, j) cannot lie here because of another stretch of the net in a bucket; 0 if it can."""
    why = 0
    far2 = (NEAR * NEAR + SHEET * SHEET + ROUNDED) * grid.sides_u[0] ** 2
    x, y, z = px - grid.centre[0], py - grid.centre[1], pz - grid.centre[2]
    there = grid.place
    link = head_of(grid, key)
    while link > 0:
        k, m = (link - 1) >> 32, (link - 1) & 0xFFFFFFFF
        link = grid.following[k, m]
        if (
            (abs(k - i) > APART or abs(m - j) > APART)
            and (there[k, m, 0] - x) ** 2 + (there[k, m, 1] - y) ** 2 + (there[k, m, 2] - z) ** 2 < far2
            and is_near(mesh, grid, face, px, py, pz, k, m)
        ):
            found = between(mesh, grid, i, j, k, m, px, py, pz)
            if found == MEETS_ITSELF:
                return MEETS_ITSELF
            if found != PRESENT:
                why = max(why, found)
    return why


@inlined
def meets_itself(mesh: Mesh, grid: Grid, i: int, j: int, face: int, px: float, py: float, pz: float) -> int:
    """Why node (i, j) cannot lie at a point because of another stretch of the net (a Status); 0 if it can."""
    mask = len(grid.bucket) - 1
    per = 1.0 / (CUBE * grid.sides_u[0])
    reach = NEAR / CUBE
    one_sheet = grid.box[4]
    x, y, z = px * per, py * per, pz * per
    why = 0
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
                    why = max(why, stranger_in(mesh, grid, key, i, j, face, px, py, pz))
    return why


@inlined
def head_of(grid: Grid, key: int) -> int:
    """Link to the node that was entered last into a bucket, 0 for none."""
    i = int(grid.bucket[key, HEAD])
    return ((i - 1) << 32 | int(grid.bucket[key, HEAD_J])) + 1 if i > 0 else 0


@inlined
def key_of(grid: Grid, px: float, py: float, pz: float) -> int:
    """Bucket of a point in space."""
    per = 1.0 / (CUBE * grid.sides_u[0])
    return bucket_of(math.floor(px * per), math.floor(py * per), math.floor(pz * per), len(grid.bucket) - 1)


@inlined
def enter(grid: Grid, i: int, j: int, px: float, py: float, pz: float) -> None:
    """Enter node (i, j) into the hash."""
    key = key_of(grid, px, py, pz)
    grid.following[i, j] = head_of(grid, key)
    first = grid.bucket[key, HEAD] == 0
    grid.bucket[key, HEAD], grid.bucket[key, HEAD_J] = i + 1, j
    grid.bucket[key, LEAST_I] = i if first else min(grid.bucket[key, LEAST_I], i)
    grid.bucket[key, MOST_I] = i if first else max(grid.bucket[key, MOST_I], i)
    grid.bucket[key, LEAST_J] = j if first else min(grid.bucket[key, LEAST_J], j)
    grid.bucket[key, MOST_J] = j if first else max(grid.bucket[key, MOST_J], j)


@inlined
def place(mesh: Mesh, grid: Grid, i: int, j: int, face: int, x: float, y: float) -> bool:
    """Put node (i, j) on a face, for the time being; True if it may lie on another stretch of the net.

    Whether it does is decided by ``settle``, when all nodes of its rank are there.
    """
    px, py, pz = in_space(mesh.frames, face, x, y)
    doubtful = meets_itself(mesh, grid, i, j, face, px, py, pz) != 0
    enter(grid, i, j, px, py, pz)
    grid.place[i, j, 0], grid.place[i, j, 1], grid.place[i, j, 2] = (
        px - grid.centre[0],
        py - grid.centre[1],
        pz - grid.centre[2],
    )
    grid.face[i, j] = face + 1
    grid.node[i, j, POINT] = x
    grid.node[i, j, POINT + 1] = y
    grid.box[0] = min(grid.box[0], i)
    grid.box[1] = max(grid.box[1], i)
    grid.box[2] = min(grid.box[2], j)
    grid.box[3] = max(grid.box[3], j)
    grid.marks[i, j, STATUS] = PRESENT
    return doubtful


@kernel
def settle(mesh: Mesh, grid: Grid, nodes: np.ndarray, count: int) -> int:
    """Take back those of the ``nodes`` (count, 2) placed last that lie on another stretch of the net; how many.

    All are looked at before any is taken back: of two that lie on each other neither was first, and none stays.
    """
    why = np.zeros(count, np.uint8)
    gone = 0
    for n in range(count):
        i, j = nodes[n, 0], nodes[n, 1]
        if grid.face[i, j] > 0:
            face = grid.face[i, j] - 1
            px, py, pz = in_space(mesh.frames, face, grid.node[i, j, 0], grid.node[i, j, 1])
            why[n] = meets_itself(mesh, grid, i, j, face, px, py, pz)
    for n in range(count):
        if why[n] > 0:
            take_back(mesh, grid, nodes[n, 0], nodes[n, 1], why[n])
            gone += 1
    if gone > 0:
        shrink_box(grid)
    return gone


@tight
def take_back(mesh: Mesh, grid: Grid, i: int, j: int, why: int) -> None:
    """Remove node (i, j) and its pieces; its status says why."""
    px, py, pz = in_space(mesh.frames, grid.face[i, j] - 1, grid.node[i, j, 0], grid.node[i, j, 1])
    key = key_of(grid, px, py, pz)
    mine = (i << 32 | j) + 1
    link = head_of(grid, key)
    if link == mine:
        onward = grid.following[i, j]
        grid.bucket[key, HEAD] = ((onward - 1) >> 32) + 1
        grid.bucket[key, HEAD_J] = (onward - 1) & 0x7FFFFFFF
    while link > 0 and link != mine:
        k, m = (link - 1) >> 32, (link - 1) & 0xFFFFFFFF
        link = grid.following[k, m]
        if link == mine:
            grid.following[k, m] = grid.following[i, j]
    grid.face[i, j] = 0
    grid.marks[i, j, STATUS] = why
    grid.marks[i, j, PIECES] = 0
    if i > 0:
        grid.marks[i - 1, j, PIECES] &= ~WARP_PIECE
    if j > 0:
        grid.marks[i, j - 1, PIECES] &= ~WEFT_PIECE


@tight
def shrink_box(grid: Grid) -> None:
    """Fit the box to the nodes that are left."""
    while grid.box[0] < grid.box[1] and not grid.face[grid.box[0]].any():
        grid.box[0] += 1
    while grid.box[1] > grid.box[0] and not grid.face[grid.box[1]].any():
        grid.box[1] -= 1
    while grid.box[2] < grid.box[3] and not grid.face[:, grid.box[2]].any():
        grid.box[2] += 1
    while grid.box[3] > grid.box[2] and not grid.face[:, grid.box[3]].any():
        grid.box[3] -= 1


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


@tight
def place_seed(
    mesh: Mesh, grid: Grid, i: int, j: int, face: int, x: float, y: float, dx: float, dy: float, weft_rad: float
) -> None:
    """Put the seed, with the warp in direction (dx, dy) of its face's frame and the weft turned from it."""
    place(mesh, grid, i, j, face, x, y)
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
