"""Sides of a net, found again by shooting from node to node: independent of how the cells were closed.

A side that no straight line finds must go through a vertex of negative deficit: straight to it, and on from it with
half a turn of faces or more on either hand.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from geomdrap.fishnet.laid_down import SPREAD
from geomdrap.fishnet.pivot import vertex_between
from geomdrap.geodesic.mesh import mesh_of
from geomdrap.geodesic.unfold import shoot
from geomdrap.geodesic.vertex import go_straight_through, total_angle

ENOUGH = 1e-7  # of the side: found


@njit
def miss_at(row, link, frames, face, x, y, turn, length, target):
    """Distance from a target at which the line of one heading ends."""
    _, f, ex, ey, dx, dy, _, _ = shoot(row, link, face, x, y, np.cos(turn), np.sin(turn), length)
    x, y = ex + length * dx, ey + length * dy
    end = frames[f, :3] + x * frames[f, 3:6] + y * frames[f, 6:]
    return np.sqrt(((end - target) ** 2).sum())


@njit
def least_miss(row, link, frames, face, point, target, length, width, steps):
    """Least such distance over the headings within ``width`` (radians) of the chord."""
    away = point - frames[face, :3]
    x, y = away @ frames[face, 3:6], away @ frames[face, 6:]
    chord = target - point
    first = np.arctan2(chord @ frames[face, 6:], chord @ frames[face, 3:6])
    step = width / steps
    best, at = np.inf, first
    for k in range(-steps, steps + 1):
        miss = miss_at(row, link, frames, face, x, y, first + step * k, length, target)
        if miss < best:
            best, at = miss, first + step * k
    found, at = closer(row, link, frames, face, x, y, length, target, at - step, at + step)
    best = min(best, found)
    if best > ENOUGH * length:
        line = np.array([x, y, 0.0, 0.0, length, 0.0, 0.0, 0.0])
        for beside in (1e-9, 1e-7, 1e-5, 1e-3):
            best = min(best, miss_through_vertex(row, link, frames, face, line, at - beside, at + beside, target))
        for k in range(-steps, steps):  # the wedge may be so wide that lines beside it end nowhere near
            if best <= ENOUGH * length:
                break
            low = first + step * k
            best = min(best, miss_through_vertex(row, link, frames, face, line, low, low + step, target))
    return best


@njit
def closer(row, link, frames, face, x, y, length, target, low, high):
    """Least miss between two headings, and where it is."""
    for _ in range(80):  # golden section: needs no derivative, which vertices would spoil
        a, b = low + 0.381966 * (high - low), low + 0.618034 * (high - low)
        if miss_at(row, link, frames, face, x, y, a, length, target) < miss_at(
            row, link, frames, face, x, y, b, length, target
        ):
            high = b
        else:
            low = a
    at = 0.5 * (low + high)
    return miss_at(row, link, frames, face, x, y, at, length, target), at


@njit
def miss_through_vertex(row, link, frames, face, line, low, high, target):
    """Least miss of lines that pivot at the first vertex that two headings pass on either hand."""
    right, left = (np.cos(low), np.sin(low)), (np.cos(high), np.sin(high))
    f, corner, way, _, dx, dy = vertex_between(row, link, face, line, right, left)
    if f < 0 or total_angle(row, link, f, corner) <= 2 * np.pi:
        return np.inf
    half = 0.5 * total_angle(row, link, f, corner) - np.pi
    f, k, dx, dy = go_straight_through(row, link, f, corner, dx, dy)
    ahead, x, y = np.arctan2(dy, dx), row[f, 2 * k], row[f, 2 * k + 1]
    best = np.inf
    pieces = 1 + int(half / 0.02)
    for n in range(pieces):
        a = ahead - half - 1e-6 + 2.0 * (half + 1e-6) * n / pieces
        b = a + 2.0 * (half + 1e-6) / pieces
        best = min(best, closer(row, link, frames, f, x, y, line[4] - way, target, a, b)[0])
    return best


@njit
def all_misses(row, link, frames, faces, starts, far_faces, targets, length):
    """Least miss of each side, from either of its ends: near a vertex only one of them may see the other."""
    out = np.empty(len(faces))
    for n in range(len(faces)):
        best = np.inf
        for width, steps in ((0.6, 60), (np.pi, 600)):
            there = least_miss(row, link, frames, faces[n], starts[n], targets[n], length, width, steps)
            back = least_miss(row, link, frames, far_faces[n], targets[n], starts[n], length, width, steps)
            best = min(best, there, back)
            if best < ENOUGH * length:
                break
        out[n] = best
    return out


def side_misses(net):
    """For each side of each valid cell, how far from one node the best line of a pitch from the other ends, mm."""
    mesh = mesh_of(net.surface.lidded, SPREAD * net.pitch)
    warp = np.zeros(net.face.shape, bool)
    weft = np.zeros(net.face.shape, bool)
    warp[:-1, :-1] |= net.cell_valid
    warp[:-1, 1:] |= net.cell_valid
    weft[:-1, :-1] |= net.cell_valid
    weft[1:, :-1] |= net.cell_valid
    misses = []
    for sides, (di, dj) in ((warp, (1, 0)), (weft, (0, 1))):
        i, j = np.nonzero(sides)
        ends = [(net.face[k, m].astype(np.int64), net.points[k, m]) for k, m in ((i, j), (i + di, j + dj))]
        misses.append(all_misses(mesh.row, mesh.link, mesh.frames, *ends[0], *ends[1], net.pitch))
    return np.concatenate(misses)
