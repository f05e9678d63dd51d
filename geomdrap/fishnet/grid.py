"""The net while it grows: a node per crossing of a warp and a weft yarn, and the yarn pieces between them."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np


class Status(IntEnum):
    """Why a node of the net is there, or is not."""

    UNREACHED = 0
    PRESENT = 1
    OFF_PART = 2
    IN_HOLE = 3
    FOLDED = 4
    BEHIND_FOLD = 5
    MEETS_ITSELF = 6
    NOT_CLOSED = 7
    BLANK = 8
    TOO_NARROW = 9
    TOO_SHEARED = 10
    DOUBLED = 11
    SLIT = 12
    NEEDS_DART = 13
    DRAWN_IN = 14

    @property
    def reason(self) -> str:
        """The status in words."""
        return _REASONS[self]


_REASONS = {
    Status.UNREACHED: "no yarn leads here",
    Status.PRESENT: "present",
    Status.OFF_PART: "off the part",
    Status.IN_HOLE: "in a hole of the part",
    Status.FOLDED: "cell folded: it would have to shear beyond 90°",
    Status.BEHIND_FOLD: "behind a folded cell: a dart or a cut is needed",
    Status.MEETS_ITSELF: "the net meets itself here",
    Status.NOT_CLOSED: "no point of the surface closes the cell",
    Status.BLANK: "beyond the blank",
    Status.TOO_SHEARED: "sheared too far for the net to be carried on to the rim",
    Status.DOUBLED: "would lie double in the flat pattern: a smaller pitch, or a dart, is needed",
    Status.SLIT: "fabric from two sides meets here: a dart is needed",
    Status.NEEDS_DART: "folded: parts of the net lie on each other here, a dart or a cut is needed",
    Status.TOO_NARROW: "narrower than the pitch: use a smaller one",
    Status.DRAWN_IN: "the net has turned or drawn in as it came to rest, and does not reach here",
}


class Grid(NamedTuple):
    """State of the march; index [i, j] is the i-th warp and j-th weft position.

    ``face`` holds the face number + 1 (0: no node). ``node`` (nu, nv, 11) holds the point in the frame of that face
    and the unit directions of the yarns there, each (x, y): see the column numbers below; *out* is how a yarn leaves
    the node toward +u (+v), *in* how it arrives; and the strain of its weft piece to j + 1. ``marks`` (nu, nv, 3)
    holds the status; the pieces that exist (bit 1: warp to i + 1, bit 2: weft to j + 1); and a bit per sense of march
    in which the node's cell was attempted. ``sides_u`` (nu - 1,) and ``sides_v`` (nv - 1,) are the lengths of the
    cell sides, mm. ``bucket`` and ``following`` are the spatial hash in which the net looks for itself (links are
    (i << 32 | j) + 1), ``place`` (nu, nv, 3) where the nodes are, mm from ``centre`` (3,), in few digits and for
    that alone; ``box`` holds the least and greatest i, then j, of the nodes, and the spread of one sheet (see the
    module ``place``). Few arrays, because each costs time at every call of a kernel.
    """

    face: np.ndarray
    node: np.ndarray
    marks: np.ndarray
    sides_u: np.ndarray
    sides_v: np.ndarray
    bucket: np.ndarray
    following: np.ndarray
    place: np.ndarray
    centre: np.ndarray
    box: np.ndarray


POINT, WARP_OUT, WARP_IN, WEFT_OUT, WEFT_IN, STRAIN = 0, 2, 4, 6, 8, 10  # columns of Grid.node
STATUS, PIECES, TRIED = 0, 1, 2  # columns of Grid.marks

BYTES_PER_NODE = 4 + 11 * 8 + 3 + 8 + 6 + 12 + 24 + 16  # grid, hash chain, buckets and places, points, shears


def empty_grid(sides_u: np.ndarray, sides_v: np.ndarray, centre: np.ndarray, one_sheet: int) -> Grid:
    """Grid of (len(sides_u) + 1, len(sides_v) + 1) absent nodes; memory is taken only where it is touched."""
    shape = (len(sides_u) + 1, len(sides_v) + 1)
    buckets = 1 << max(8, int(np.ceil(np.log2(shape[0] * shape[1]))) - 2)
    return Grid(
        face=np.zeros(shape, np.int32),
        node=np.zeros((*shape, 11)),
        marks=np.zeros((*shape, 3), np.uint8),
        sides_u=np.ascontiguousarray(sides_u, dtype=float),
        sides_v=np.ascontiguousarray(sides_v, dtype=float),
        bucket=np.zeros((buckets, 6), np.int32),
        following=np.zeros(shape, np.int64),
        place=np.empty((*shape, 3), np.float32),
        centre=np.array(centre, dtype=float),
        box=np.array([shape[0], -1, shape[1], -1, one_sheet]),
    )
