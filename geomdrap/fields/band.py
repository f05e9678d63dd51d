"""What of a plane region lies between two lines along the warp, as closed contours of its own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.fields.contour import TOUCH, signed_area, winding

Past = tuple[float, float]

ROUNDING = 1e-3
"""mm by which crossings of a line may be out of order: contours are smoothed by a tenth of it."""
SPECK = 1e-9
"""mm²: contours that enclose less are rounding."""


def band(contours: Sequence[np.ndarray], low: float, high: float, past: Past = (0.0, 0.0)) -> tuple[np.ndarray, ...]:
    """Contours (k, 2) of what lies at ``low`` ≤ v ≤ ``high``; outer ones counter-clockwise, openings clockwise.

    Where the line falls a region apart, each part is a contour of its own: none runs back and forth on the line.
    ``past``: how far, mm, the band reaches past its lower and upper line where the region goes on across them, as far
    as the region does: straight on, so that it gets no tail along an edge that lies near the line.
    Raises DrapeError for contours that cross themselves.
    """
    turned = [-ring for ring in contours]  # by 180°
    upper = below(contours, high, *flaps(contours, high, past[1]))
    return tuple(-ring for ring in below([-ring for ring in upper], -low, *flaps(turned, -low, past[0])))


def below(
    contours: Sequence[np.ndarray], level: float, over: Sequence[np.ndarray] = (), holes: Sequence[np.ndarray] = ()
) -> list[np.ndarray]:
    """Contours (k, 2) of what lies at v ≤ ``level``, and of ``flaps`` over it.

    Each contour falls into chains that come down over the line and go up again. The region lies left of them, so
    that along the line it begins where one comes down and ends where one goes up: there the chains are joined.
    """
    whole, chains = parted(contours, level)
    return [r for r in (*whole, *holes, *joined([*chains, *over], level)) if abs(signed_area(r)) > SPECK]


def parted(contours: Sequence[np.ndarray], level: float) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Contours that lie below a line, and chains (k, 2) of those that reach it."""
    whole: list[np.ndarray] = []
    chains: list[np.ndarray] = []
    for ring in contours:
        over = ring[:, 1] >= level - TOUCH  # a side that lies on the line bounds nothing below it
        if not over.any():
            whole.append(ring)
        elif not over.all():
            chains += chains_below(ring, over, level)
    return whole, chains


def flaps(contours: Sequence[np.ndarray], level: float, past: float) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Chains (k, 2) round what lies up to ``past`` straight over a line and hangs on it, and holes in that."""
    if past <= TOUCH:
        return [], []
    over = [quarter_turned(ring) for ring in band(contours, level, level + past)]
    rings = [ring for u in across(contours, level) for ring in band(over, u[0], u[1])]
    whole, chains = parted([quarter_turned(ring) for ring in rings], -level)
    loose = [ring for ring in whole if signed_area(ring) > 0.0]
    holes = [ring for ring in whole if signed_area(ring) < 0.0 and not any(winding(r, ring[0]) for r in loose)]
    return [-chain for chain in chains], [-ring for ring in holes]


def quarter_turned(ring: np.ndarray) -> np.ndarray:
    """Points (k, 2) turned by 90°, counter-clockwise; twice is by 180°."""
    return np.column_stack([-ring[:, 1], ring[:, 0]])


def across(contours: Sequence[np.ndarray], level: float) -> np.ndarray:
    """Stretches (k, 2), from u to u, of a line that have the region on both sides of them."""
    lower = ends_on_line(parted(contours, level)[1])
    upper = -ends_on_line(parted([-ring for ring in contours], -level)[1])[:, ::-1]
    both = np.stack(
        [np.maximum(lower[:, None, 0], upper[None, :, 0]), np.minimum(lower[:, None, 1], upper[None, :, 1])], axis=-1
    ).reshape(-1, 2)
    both = both[both[:, 1] - both[:, 0] > TOUCH]
    return both[np.argsort(both[:, 0])]


def ends_on_line(chains: Sequence[np.ndarray]) -> np.ndarray:
    """Stretches (k, 2), from u to u, of the line between chains whose ends lie on it."""
    return np.column_stack([np.sort([c[0, 0] for c in chains]), np.sort([c[-1, 0] for c in chains])])


def chains_below(ring: np.ndarray, over: np.ndarray, level: float) -> list[np.ndarray]:
    """Stretches (k, 2) of a contour that are not ``over`` (n,) the line, from crossing to crossing."""
    after = np.roll(over, -1)
    downs = np.flatnonzero(over & ~after)
    ups = np.flatnonzero(~over & after)
    ups = np.roll(ups, -int(np.searchsorted(ups, downs[0])))  # the way up after each way down
    return [
        np.vstack([crossing(ring, down, level), ring[between(down, up, len(ring))], crossing(ring, up, level)])
        for down, up in zip(downs.tolist(), ups.tolist(), strict=True)
    ]


def between(down: int, up: int, n: int) -> np.ndarray:
    """Numbers of the corners after side ``down`` up to the start of side ``up``, round and round."""
    return (down + 1 + np.arange((up - down - 1) % n + 1)) % n


def crossing(ring: np.ndarray, side: int, level: float) -> np.ndarray:
    """Place (2,) where a side of a contour crosses the line."""
    a, b = ring[side], ring[(side + 1) % len(ring)]
    share = min(max((level - a[1]) / (b[1] - a[1]), 0.0), 1.0)
    return np.array([a[0] + share * (b[0] - a[0]), level])


def joined(chains: Sequence[np.ndarray], level: float) -> list[np.ndarray]:
    """Closed contours of chains whose ends lie on the line."""
    if not chains:
        return []
    start, end = np.array([c[0, 0] for c in chains]), np.array([c[-1, 0] for c in chains])
    starts, ends = np.argsort(start, kind="stable"), np.argsort(end, kind="stable")
    left, right = start[starts], end[ends]
    if (left > right + ROUNDING).any() or (right[:-1] > left[1:] + ROUNDING).any():
        raise DrapeError(
            f"the flat pattern crosses itself at v = {level:.4g} mm, so that it cannot be laid in strips of a roll: "
            "use another origin or heading, a smaller pitch, or leave --roll-width out"
        )
    follows = np.empty(len(chains), int)
    follows[ends] = starts
    return [np.vstack([chains[n] for n in cycle]) for cycle in cycles(follows)]


def cycles(follows: np.ndarray) -> list[list[int]]:
    """The closed sequences of a permutation (n,)."""
    left, found = set(range(len(follows))), []
    while left:
        n = min(left)
        cycle = []
        while n in left:
            left.remove(n)
            cycle.append(n)
            n = int(follows[n])
        found.append(cycle)
    return found
