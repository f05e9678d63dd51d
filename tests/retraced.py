"""Sides of a net, found again by shooting from node to node: independent of how the cells were closed."""

from __future__ import annotations

import importlib

import numpy as np
from numba import njit

from geomdrap.geodesic.mesh import mesh_of
from geomdrap.geodesic.unfold import shoot

ENOUGH = 1e-7  # of the side: found


@njit
def miss_at(row, link, frames, face, x, y, turn, length, target):
    """Distance from a target at which the line of one heading ends."""
    _, f, ex, ey, dx, dy = shoot(row, link, face, x, y, np.cos(turn), np.sin(turn), length)
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
    low, high = at - step, at + step
    for _ in range(80):  # golden section: needs no derivative, which vertices would spoil
        a, b = low + 0.381966 * (high - low), low + 0.618034 * (high - low)
        if miss_at(row, link, frames, face, x, y, a, length, target) < miss_at(
            row, link, frames, face, x, y, b, length, target
        ):
            high = b
        else:
            low = a
    return min(best, miss_at(row, link, frames, face, x, y, 0.5 * (low + high), length, target))


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
    spread = importlib.import_module("geomdrap.fishnet.drape").SPREAD  # the name is the function's as well
    mesh = mesh_of(net.surface.lidded, spread * net.pitch)
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
