"""What is held fixed while a net relaxes: the part, the cells, the lengths of the yarns, the law of the fabric."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.fishnet.relax_bending import smooth_bends
from geomdrap.fishnet.relax_energy import Law
from geomdrap.fishnet.relax_surface import Footing, stand

if TYPE_CHECKING:
    from geomdrap.fishnet.fabric import Fabric
    from geomdrap.fishnet.net import Net
    from geomdrap.surface import Surface

DEFAULT_RATIO = 0.003  # shear stiffness where only its asymmetry is given
BENT_RATIO = 0.001  # where only bending is given: it meets the length, and the net hardly depends on this
HELD = 0.02  # shear stiffness about the ply as it was laid, where only a locking angle is given
LOCK_STIFFNESS = 1.0  # of the yarns: resistance to shear beyond the locking angle


@dataclass(frozen=True, eq=False)
class Problem:
    """What is held fixed while a net relaxes; arrays as in ``relax_energy``.

    ``x0`` (nu, nv, 3) is the geometric net, ``nodes`` the places (i, j) of the n that move, ``number`` (nu, nv) of
    these, -1 for others; ``fixed`` node and ``guided`` node, which moves only in the plane through the seed across
    ``side``, and where they are, ``held`` (2, 3) mm; ``smooth`` as of ``smooth_bends``; ``footing`` of the n in the
    geometric net.
    """

    surface: Surface
    valid: np.ndarray
    target: np.ndarray
    x0: np.ndarray
    rest_u: np.ndarray
    rest_v: np.ndarray
    law: Law
    nodes: tuple[np.ndarray, np.ndarray]
    number: np.ndarray
    fixed: tuple[int, int]
    guided: tuple[int, int]
    held: np.ndarray
    side: np.ndarray
    smooth: np.ndarray
    footing: Footing

    def on_net(self, vectors: np.ndarray, elsewhere: float = 0.0) -> np.ndarray:
        """Vectors (n, 3) of the nodes that move as (nu, nv, 3), with another value elsewhere."""
        return on_net(self.x0.shape, self.nodes, vectors, elsewhere)


def on_net(
    shape: tuple[int, ...], nodes: tuple[np.ndarray, np.ndarray], vectors: np.ndarray, elsewhere: float = 0.0
) -> np.ndarray:
    """Vectors (n, 3) of ``nodes`` on a net of that shape, with another value elsewhere."""
    out = np.full(shape, elsewhere)
    out[nodes] = vectors
    return out


def law_of(fabric: Fabric) -> Law:
    """The energy of a fabric; where only a locking angle is given, friction at the crossings resists below it."""
    angle, length = fabric.locking_angle, fabric.bending_length or 0.0
    default = BENT_RATIO if length else DEFAULT_RATIO if fabric.shear_asymmetry else HELD
    ratio = fabric.shear_stiffness or default
    return Law(
        ratio=ratio,
        alpha=fabric.shear_asymmetry or 0.0,
        lock=0.0 if angle is None else LOCK_STIFFNESS,
        lock_sine=1.0 if angle is None else math.sin(math.radians(angle)),
        bend=ratio * length**2,
    )


def problem_of(net: Net) -> Problem:
    """The problem of relaxing a net of its fabric. Raises DrapeError where the seed has no cell beside it."""
    problem = pose(net, law_of(net.fabric))
    if needs_no_hold(net.fabric):
        return problem
    # without a stiffness in shear many nets are minimal, and yarns under pressure buckle from node to node
    return replace(problem, target=chord_sines(problem.x0, problem.valid))


def needs_no_hold(fabric: Fabric) -> bool:
    """Whether a fabric resists shear of any size, so that one net alone is minimal."""
    return bool(fabric.shear_stiffness or fabric.shear_asymmetry or fabric.bending_length)


def pose(net: Net, law: Law) -> Problem:
    """The problem of relaxing a net under a law, its heading held over the fabric's ``held_length`` where it goes.

    Raises DrapeError where the seed has no cell beside it.
    """
    lattice, valid = net.lattice, net.lattice_valid
    moves = np.zeros(net.face.shape, bool)
    for corner in (np.s_[:-1, :-1], np.s_[1:, :-1], np.s_[1:, 1:], np.s_[:-1, 1:]):
        moves[corner] |= valid
    warp, weft = np.zeros(lattice[1:, :, 0].shape, bool), np.zeros(lattice[:, 1:, 0].shape, bool)
    warp[:, :-1] |= valid
    warp[:, 1:] |= valid
    weft[:-1] |= valid
    weft[1:] |= valid
    i, j = int(np.abs(net.u).argmin()), int(np.abs(net.v).argmin())
    guided = _guided(warp[:, j], i, max(round((net.fabric.held_length or 0.0) / net.pitch), 1))
    i_moves, j_moves = np.nonzero(moves)
    nodes = i_moves, j_moves
    number = np.full(moves.shape, -1)
    number[nodes] = np.arange(len(i_moves))
    surface = net.surface.lidded
    x = np.full(lattice.shape, np.nan)
    face = net.face[nodes]
    footing = stand(surface, lattice[nodes], face if (face >= 0).all() else None)
    x[nodes] = footing.lifted
    rest_u, rest_v = (np.linalg.norm(np.diff(x, axis=axis), axis=2) for axis in (0, 1))
    return Problem(
        surface=surface,
        valid=valid,
        target=np.zeros((*valid.shape, 2, 2)),
        x0=x,
        rest_u=np.where(warp, rest_u, 0.0),
        rest_v=np.where(weft, rest_v, 0.0),
        law=law,
        nodes=nodes,
        number=number,
        fixed=(i, j),
        guided=(guided, j),
        held=lattice[[i, guided], j],
        side=np.cross(net.normal0, net.warp0),
        smooth=smooth_bends(on_net(lattice.shape, nodes, footing.normal)),
        footing=footing,
    )


def _guided(pieces: np.ndarray, seed: int, count: int) -> int:
    """The node at the end of ``count`` pieces of the warp from the seed, forwards if there are as many as backwards.

    ``pieces`` (nu - 1,) bool: which there are. Raises DrapeError for none beside the seed.
    """
    found = []
    for step, first in ((1, seed), (-1, seed - 1)):
        row = pieces[first:] if step > 0 else pieces[first::-1] if first >= 0 else pieces[:0]
        found.append(step * int(np.logical_and.accumulate(row[:count]).sum()))
    furthest = max(found, key=abs)
    if furthest == 0:
        raise DrapeError("the seed has no cell beside it from which a net could relax; move it away from the rim")
    return seed + furthest


CORNERS = np.s_[:-1, :-1], np.s_[:-1, 1:], np.s_[1:, :-1], np.s_[1:, 1:]  # (i, j), (i, j + 1), ... of each cell


def chord_sines(x: np.ndarray, valid: np.ndarray) -> np.ndarray:
    """Sines of the shear at the corners of cells (nu - 1, nv - 1, 2, 2), from the straight lines between nodes."""
    sines = np.zeros((*valid.shape, 2, 2))
    for at, corner in enumerate(CORNERS):
        di, dj = divmod(at, 2)
        beside_u, beside_v = x[CORNERS[2 - 2 * di + dj]] - x[corner], x[CORNERS[2 * di + 1 - dj]] - x[corner]
        size = np.linalg.norm(beside_u, axis=2) * np.linalg.norm(beside_v, axis=2)
        cosine = (beside_u * beside_v).sum(axis=2) / np.where(valid, size, 1.0)
        sines[:, :, di, dj] = np.where(valid, (1 - 2 * (di ^ dj)) * np.clip(cosine, -1.0, 1.0), 0.0)
    return sines
