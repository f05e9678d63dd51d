"""What is held fixed while a net relaxes: the part, the cells, the lengths of the yarns, the law of the fabric."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.fishnet.relax_energy import Law
from geomdrap.fishnet.relax_surface import smooth_normals, stand

if TYPE_CHECKING:
    from geomdrap.fishnet.fabric import Fabric
    from geomdrap.fishnet.net import Net
    from geomdrap.surface import Surface

DEFAULT_RATIO = 0.003  # shear stiffness where only its asymmetry is given
FRICTION = 0.05  # on the tool where only a locking angle is given: without it many nets are minimal
LOCK_STIFFNESS = 1.0  # of the yarns: resistance to shear beyond the locking angle


@dataclass(frozen=True, eq=False)
class Problem:
    """What is held fixed while a net relaxes; arrays as in ``relax_energy``.

    ``x0`` (nu, nv, 3) is the geometric net, ``nodes`` the places (i, j) of the n that move, ``number`` (nu, nv) of
    these, -1 for others; ``fixed`` node and ``guided`` node, which moves only in the plane through the seed across
    ``side``, and where they are, ``held`` (2, 3) mm; ``friction`` per mm² of the law on a net of this area.
    """

    surface: Surface
    corner_normals: np.ndarray
    valid: np.ndarray
    target: np.ndarray
    x0: np.ndarray
    rest_u: np.ndarray
    rest_v: np.ndarray
    law: Law
    friction: float
    nodes: tuple[np.ndarray, np.ndarray]
    number: np.ndarray
    fixed: tuple[int, int]
    guided: tuple[int, int]
    held: np.ndarray
    side: np.ndarray


def law_of(fabric: Fabric) -> Law:
    """The energy of a fabric; where only a locking angle is given, nothing but friction resists below it."""
    angle = fabric.locking_angle
    default = DEFAULT_RATIO if fabric.shear_asymmetry else 0.0
    ratio = fabric.shear_stiffness or default
    return Law(
        ratio=ratio,
        alpha=fabric.shear_asymmetry or 0.0,
        lock=0.0 if angle is None else LOCK_STIFFNESS,
        lock_sine=1.0 if angle is None else math.sin(math.radians(angle)),
        friction=0.0 if ratio else FRICTION,
    )


def pose(net: Net, law: Law) -> Problem:
    """The problem of relaxing a net under a law. Raises DrapeError where the seed has no cell beside it."""
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
    beside = [k for k in (i + 1, i - 1) if 0 <= k < len(net.u) and warp[min(i, k), j]]
    if not beside:
        raise DrapeError("the seed has no cell beside it from which a net could relax; move it away from the rim")
    i_moves, j_moves = np.nonzero(moves)
    nodes = i_moves, j_moves
    number = np.full(moves.shape, -1)
    number[nodes] = np.arange(len(i_moves))
    surface = net.surface.lidded
    normals = smooth_normals(surface.triangles, surface.normals, surface.corner_angles, len(surface.points))
    x = np.full(lattice.shape, np.nan)
    x[nodes] = stand(surface, normals, lattice[nodes]).lifted
    rest_u, rest_v = (np.linalg.norm(np.diff(x, axis=axis), axis=2) for axis in (0, 1))
    area = float(valid.sum() * rest_u[warp].mean() * rest_v[weft].mean())
    return Problem(
        surface=surface,
        corner_normals=normals,
        valid=valid,
        target=np.zeros((*valid.shape, 2, 2)),
        x0=x,
        rest_u=np.where(warp, rest_u, 0.0),
        rest_v=np.where(weft, rest_v, 0.0),
        law=law,
        friction=law.friction / area,
        nodes=nodes,
        number=number,
        fixed=(i, j),
        guided=(beside[0], j),
        held=lattice[[i, beside[0]], j],
        side=np.cross(net.normal0, net.warp0),
    )
