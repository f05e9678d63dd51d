"""A relaxed net as a Net: positions, shear, directions and lengths renewed."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from geomdrap.fishnet.grid import Status
from geomdrap.fishnet.net import cells_of
from geomdrap.fishnet.relax import GOOD_ENOUGH, placed, relax
from geomdrap.fishnet.relax_problem import CORNERS, chord_sines, problem_of

UNREST = "has not come to rest"  # of the warning that says so
ON_RIM = 1e-6  # of the pitch: a node no further beyond the rim is on it

if TYPE_CHECKING:
    from geomdrap.fishnet.net import Net
    from geomdrap.fishnet.relax import Relaxed
    from geomdrap.fishnet.relax_problem import Problem


class Balance(NamedTuple):
    """What a net of least energy came from: the geometric net as it was ``laid``, the problem, what was found."""

    laid: Net
    problem: Problem
    found: Relaxed


def relaxed(net: Net, near: Net | None = None) -> Net:
    """The net of least energy of ``net.fabric``, from the geometric net or where the nodes of another have gone.

    A warning of the net says so where the forces do not come into balance.
    """
    problem = problem_of(net)
    if near is None or near.moved is None:
        found = relax(problem, problem.footing)
    else:
        start = gone_along(problem.on_net(problem.footing.point, math.nan), net, near)
        found = relax(problem, placed(problem, start))
    moved = found.footing.point - problem.footing.point
    balance = Balance(net, problem, found)
    return replace(as_net(net, problem, found), moved=problem.on_net(moved, math.nan), balance=balance)


def gone_along(start: np.ndarray, net: Net, near: Net) -> np.ndarray:
    """Nodes ``start`` (nu, nv, 3) mm of a net, moved as far as those of a net ``near`` have, between its by cubics.

    Nodes that the other net has not go with it as a whole, and from there as those nearest to them do.
    """
    from scipy.ndimage import distance_transform_edt

    assert near.moved is not None
    across = _between(near.moved.swapaxes(0, 1), net.v, near.v).swapaxes(0, 1)
    moved = _between(across, net.u, near.u) @ (frame(near.warp0, near.normal0).T @ frame(net.warp0, net.normal0))
    known = np.isfinite(moved - start).all(axis=2)
    if not known.any():
        return start
    there = start + moved
    turned = _turned(start, start[known], there[known])
    near_to = distance_transform_edt(~known, return_distances=False, return_indices=True)
    more = (there - turned)[tuple(near_to)]
    # straight on, where the node on the other side of the nearest one is known: else the rim is strained at once
    beyond = 2 * near_to - np.indices(known.shape)
    inside = ((beyond >= 0) & (beyond < np.reshape(known.shape, (2, 1, 1)))).all(axis=0)
    behind = np.where(inside, beyond, near_to)
    straight = known[tuple(behind)]
    more[straight] = 2.0 * more[straight] - (there - turned)[tuple(behind)][straight]
    return np.asarray(turned + more)


def frame(warp: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Orthonormal vectors (3, 3) at a seed: the warp across the unit normal, across both, and the normal."""
    across = np.cross(normal, warp)
    across /= np.linalg.norm(across)
    return np.array([np.cross(across, normal), across, normal])


def _turned(points: np.ndarray, some: np.ndarray, there: np.ndarray) -> np.ndarray:
    """Points (..., 3) moved as a rigid body, as ``some`` (n, 3) of them best come to lie ``there`` (n, 3).

    They are not turned where those lie on one line, for which many turns are as good.
    """
    from scipy.spatial.transform import Rotation

    middle, other = some.mean(axis=0), there.mean(axis=0)
    if min(np.linalg.matrix_rank(x, tol=1e-6 * (1.0 + np.abs(x).max())) for x in (some - middle, there - other)) < 2:
        return np.asarray(points + (other - middle))
    turn, _ = Rotation.align_vectors(there - other, some - middle)
    return np.asarray(other + (points - middle) @ turn.as_matrix().T)


def _between(values: np.ndarray, line: np.ndarray, there: np.ndarray) -> np.ndarray:
    """Values (m, ...) at the yarns ``there`` (m,) mm carried over to a ``line`` (n,) mm: by cubics, else straight.

    They are not numbers beyond the ends.
    """
    place = np.round((line - there[0]) / (there[1] - there[0]), 6)
    inside = (place >= 0.0) & (place <= len(there) - 1)
    before = np.floor(np.where(inside, place, 0.0)).astype(int)
    w = np.where(inside, place - before, math.nan).reshape(-1, *[1] * (values.ndim - 1))
    padded = np.pad(values, [(1, 2), *[(0, 0)] * (values.ndim - 1)], constant_values=math.nan)
    a, b, c, d = (padded[before + k] for k in range(4))
    straight = (1.0 - w) * b + w * c
    bent = straight - w * (1.0 - w) / 6.0 * ((2.0 - w) * (a - 2.0 * b + c) + (1.0 + w) * (b - 2.0 * c + d))
    return np.where(w == 0.0, b, np.where(np.isfinite(bent), bent, straight))


def as_net(net: Net, problem: Problem, found: Relaxed) -> Net:
    """The net with its nodes where they came to rest; those beyond the rim, or without a cell, are off the part."""
    nodes = problem.nodes
    off = np.ones(problem.number.shape, bool)
    off[nodes] = found.footing.outside > ON_RIM * net.pitch
    lattice = np.full(found.x.shape, np.nan)
    lattice[nodes] = found.footing.point
    lattice[off] = np.nan
    face = np.full(off.shape, -1)
    face[nodes] = found.footing.face
    face[off | (face >= len(net.surface.triangles))] = -1
    face[~np.isfinite(net.points[..., 0])] = -1  # in a hole
    points = np.where(face[..., None] < 0, np.nan, lattice)
    status = net.status_around.copy()
    status[1:-1, 1:-1][np.isfinite(net.lattice[..., 0]) & off] = Status.OFF_PART
    lattice_valid = net.lattice_valid & np.isfinite(cells_of(lattice[..., 0])).all(axis=0)
    cell_valid = net.cell_valid & np.isfinite(cells_of(points[..., 0])).all(axis=0)
    before, after = (chord_shears(x, net.lattice_valid) for x in (problem.x0, found.x))
    return replace(
        net,
        points=points,
        face=face.astype(net.face.dtype),
        status_around=status,
        lattice=lattice,
        lattice_valid=lattice_valid,
        cell_valid=cell_valid,
        cell_shear=np.where(cell_valid, net.cell_shear + after[0] - before[0], np.nan),
        shear=np.where(np.isfinite(points[..., 0]), net.shear + after[1] - before[1], np.nan),
        yarns=_yarns(lattice, found, nodes),
        sides=_sides(net, problem, found),
        notes=(*net.notes, _said(net, problem, found)),
        warnings=(*net.warnings, *_doubts(net, found)),
    )


def _said(net: Net, problem: Problem, found: Relaxed) -> str:
    """How well the forces balance, and what holds the heading: on a small ply that may be less than was asked for."""
    held = abs(problem.guided[0] - problem.fixed[0]) * net.pitch
    over = f", its heading held over {held:g} mm" if net.fabric.held_length else ""
    return f"net of least energy{over}, forces balanced to {found.unrest:.0e} in {found.rounds} rounds"


def _sides(net: Net, problem: Problem, found: Relaxed) -> tuple[np.ndarray, np.ndarray]:
    """Lengths of warp and weft pieces: those of the geometric net, stretched as the lines between the nodes are."""
    lengths = net.sides or (np.diff(net.u)[:, None], np.diff(net.v)[None, :])
    rests = (np.where(rest > 0.0, rest, np.nan) for rest in (problem.rest_u, problem.rest_v))
    chords = (np.linalg.norm(np.diff(found.x, axis=axis), axis=2) for axis in (0, 1))
    warp, weft = (c / r * length for c, r, length in zip(chords, rests, lengths, strict=True))
    return warp, weft


def _doubts(net: Net, found: Relaxed) -> tuple[str, ...]:
    """A warning where the net is not at rest."""
    if found.unrest <= GOOD_ENOUGH:
        return ()
    return (
        f"the net of {net.surface.source} {UNREST} (forces out of balance by {found.unrest:.1g}): the "
        "part has sharp edges, or the fabric locks; use a finer mesh, another pitch, or a smaller blank and compare",
    )


def chord_shears(x: np.ndarray, valid: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shear of cells (nu - 1, nv - 1) and at nodes (nu, nv), degrees, from the straight lines between nodes."""
    sines = chord_sines(x, valid)
    total, count = np.zeros(x.shape[:2]), np.zeros(x.shape[:2])
    for at, corner in enumerate(CORNERS):
        total[corner] += np.degrees(np.arcsin(sines[:, :, at // 2, at % 2]))
        count[corner] += valid
    cells = np.where(valid, np.degrees(np.arcsin(sines.mean(axis=(2, 3)))), np.nan)
    return cells, np.where(count > 0, total / np.maximum(count, 1), np.nan)


def _yarns(lattice: np.ndarray, found: Relaxed, nodes: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Unit directions of warp and weft (2, nu, nv, 3) in the tangent plane: the mean of both pieces at a node."""
    normal = np.zeros(lattice.shape)
    normal[nodes] = found.footing.normal
    out = np.zeros((2, *lattice.shape))
    for family in range(2):
        piece = np.nan_to_num(np.diff(lattice, axis=family))
        length = np.linalg.norm(piece, axis=2, keepdims=True)
        unit = piece / np.where(length > 0.0, length, 1.0)
        low = (np.s_[:-1], np.s_[:, :-1])[family]
        high = (np.s_[1:], np.s_[:, 1:])[family]
        out[family][low] += unit
        out[family][high] += unit
    out -= (out * normal).sum(axis=3, keepdims=True) * normal
    length = np.linalg.norm(out, axis=3, keepdims=True)
    yarns: np.ndarray = np.where(length > 0.0, out / np.where(length > 0.0, length, 1.0), np.nan).astype(np.float32)
    return yarns
