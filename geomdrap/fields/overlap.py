"""Where facets laid out flat lie upon each other, found exactly: with a grid, and by clipping triangles."""

from __future__ import annotations

import numpy as np

from geomdrap.geodesic.compiled import inlined, kernel

LEAST = 1e-7  # cells²: facets that share an edge overlap by no more than rounding
PER_BOX = 1.5  # boxes are so many times the mean size of a facet


@kernel
def clip(polygon: np.ndarray, n: int, px: float, py: float, dx: float, dy: float, out: np.ndarray) -> int:
    """Keep of a polygon (n, 2) what lies left of the line through (px, py) along (dx, dy); returns its corners."""
    count = 0
    for i in range(n):
        ax, ay = polygon[i]
        bx, by = polygon[(i + 1) % n]
        a = dx * (ay - py) - dy * (ax - px)
        b = dx * (by - py) - dy * (bx - px)
        if a >= 0.0:
            out[count, 0], out[count, 1] = ax, ay
            count += 1
        if (a > 0.0 and b < 0.0) or (a < 0.0 and b > 0.0):
            t = a / (a - b)
            out[count, 0], out[count, 1] = ax + t * (bx - ax), ay + t * (by - ay)
            count += 1
    return count


@kernel
def turned(a: np.ndarray) -> float:
    """Twice the signed area of a triangle (3, 2)."""
    return (a[1, 0] - a[0, 0]) * (a[2, 1] - a[0, 1]) - (a[1, 1] - a[0, 1]) * (a[2, 0] - a[0, 0])


@kernel
def common_area(a: np.ndarray, b: np.ndarray, low: np.ndarray, high: np.ndarray, work: np.ndarray) -> float:
    """Area that triangles a and b (3, 2) share within the rectangle from ``low`` to ``high`` (2,).

    ``work`` (2, 16, 2) is room to work in.
    """
    n = 3
    work[0, :3] = a
    sense = 1.0 if turned(b) > 0.0 else -1.0
    for k in range(7):
        if k < 3:
            m = (k + 1) % 3
            px, py = b[k]
            dx, dy = sense * (b[m, 0] - b[k, 0]), sense * (b[m, 1] - b[k, 1])
        else:
            px, py = low if k < 5 else high
            dx, dy = ((1.0, 0.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 1.0))[k - 3]
        n = clip(work[k % 2], n, px, py, dx, dy, work[(k + 1) % 2])
        if n < 3:
            return 0.0
    total = 0.0
    p = work[1]
    for k in range(1, n - 1):
        total += (p[k, 0] - p[0, 0]) * (p[k + 1, 1] - p[0, 1]) - (p[k, 1] - p[0, 1]) * (p[k + 1, 0] - p[0, 0])
    return 0.5 * abs(total)


@kernel
def boxes_of(
    low: np.ndarray, high: np.ndarray, origin: np.ndarray, size: float, nx: int, ny: int, f: int
) -> tuple[int, int, int, int]:
    """First and last box of facet f along x and along y."""
    x0 = min(int((low[f, 0] - origin[0]) / size), nx - 1)
    x1 = min(int((high[f, 0] - origin[0]) / size), nx - 1)
    y0 = min(int((low[f, 1] - origin[1]) / size), ny - 1)
    y1 = min(int((high[f, 1] - origin[1]) / size), ny - 1)
    return x0, x1, y0, y1


@kernel
def fill_boxes(
    low: np.ndarray, high: np.ndarray, origin: np.ndarray, size: float, nx: int, ny: int
) -> tuple[np.ndarray, np.ndarray]:
    """Facets by box: where each box begins (nx ny + 1,) in the list of facets that follows."""
    begin = np.zeros(nx * ny + 1, np.int64)
    for f in range(len(low)):
        x0, x1, y0, y1 = boxes_of(low, high, origin, size, nx, ny, f)
        for x in range(x0, x1 + 1):
            for y in range(y0, y1 + 1):
                begin[x * ny + y + 1] += 1
    for b in range(nx * ny):
        begin[b + 1] += begin[b]
    at = begin[:-1].copy()
    inside = np.empty(begin[-1], np.int64)
    for f in range(len(low)):
        x0, x1, y0, y1 = boxes_of(low, high, origin, size, nx, ny, f)
        for x in range(x0, x1 + 1):
            for y in range(y0, y1 + 1):
                inside[at[x * ny + y]] = f
                at[x * ny + y] += 1
    return begin, inside


@inlined
def box_of(low: np.ndarray, f: int, g: int, origin: np.ndarray, size: float, nx: int, ny: int) -> int:
    """Box of the lower left corner of what the bounds of two facets share, so that a pair is found once."""
    x = min(int((max(low[f, 0], low[g, 0]) - origin[0]) / size), nx - 1)
    y = min(int((max(low[f, 1], low[g, 1]) - origin[1]) / size), ny - 1)
    return x * ny + y


@kernel
def pairs_in_boxes(
    flat: np.ndarray, first: int, low: np.ndarray, high: np.ndarray, origin: np.ndarray, size: float,
    nx: int, ny: int, least: np.ndarray, most: np.ndarray,
) -> list[tuple[int, int]]:
    """Pairs (f, g), f < g, of facets that lie upon each other in the rectangle from ``least`` to ``most`` (2,).

    Only those with f < ``first`` are looked for.
    """
    begin, inside = fill_boxes(low, high, origin, size, nx, ny)
    found = [(0, 0) for _ in range(0)]
    work = np.empty((2, 16, 2))
    for box in range(nx * ny):
        for n in range(begin[box], begin[box + 1]):
            f = inside[n]
            if f >= first:
                break
            for m in range(n + 1, begin[box + 1]):
                g = inside[m]
                if (
                    max(low[f, 0], low[g, 0]) < min(high[f, 0], high[g, 0])
                    and max(low[f, 1], low[g, 1]) < min(high[f, 1], high[g, 1])
                    and box_of(low, f, g, origin, size, nx, ny) == box
                    and common_area(flat[f], flat[g], least, most, work) > LEAST
                ):
                    found.append((f, g))
    return found


def overlapping_pairs(flat: np.ndarray, first: int, half: np.ndarray | None = None) -> np.ndarray:
    """Pairs (n, 2) of flat facets (m, 3, 2), lengths in cells, that lie upon each other.

    Only pairs with at least one facet before ``first``, that share more than ``LEAST``; with ``half`` (2,), within
    |u| ≤ half[0] and |v| ≤ half[1].
    """
    low, high = flat.min(axis=1), flat.max(axis=1)
    size, origin = PER_BOX * float((high - low).mean()), low.min(axis=0)
    nx, ny = (int(n) + 1 for n in (high.max(axis=0) - origin) / size)
    most = high.max(axis=0) if half is None else np.asarray(half)
    least = origin if half is None else -most
    pairs = pairs_in_boxes(flat, first, low, high, origin, size, nx, ny, least, most)
    return np.array(pairs, np.int64).reshape(-1, 2)


def doubled(at: np.ndarray, movable: np.ndarray, rest: np.ndarray, half: np.ndarray | None = None) -> np.ndarray:
    """Which of the facets ``movable`` (k,) must go so that none of them lies upon another or upon the ``rest`` (n,).

    ``at`` (m, 3, 2) cells. Of two movable ones the later in the list goes. Pairs within the rest stay.
    """
    gone = np.zeros(len(movable) + len(rest), bool)
    pairs = overlapping_pairs(at[np.concatenate([movable, rest])], len(movable), half)
    pairs = np.where(pairs[:, 1:] < len(movable), pairs, pairs[:, ::-1])  # the rest are not to go: they come first
    for earlier, later in pairs[np.argsort(pairs[:, 1], kind="stable")]:
        gone[later] |= not gone[earlier]
    return movable[gone[: len(movable)]]
