"""Sides of a net, found again by shooting from node to node: independent of how the cells were closed."""

from __future__ import annotations

import importlib

import numpy as np
from numba import njit

from geomdrap.geodesic.mesh import mesh_of
from geomdrap.geodesic.unfold import shoot


@njit
def end_in_space(row, link, frames, face, x, y, turn, length):
    status, f, ex, ey, dx, dy = shoot(row, link, face, x, y, np.cos(turn), np.sin(turn), length)
    x, y = ex + length * dx, ey + length * dy
    out = frames[f, :3] + x * frames[f, 3:6] + y * frames[f, 6:]
    return out, frames[f, 3:6] * -dy + frames[f, 6:] * dx


@njit
def least_miss(row, link, frames, face, point, target, length):
    """Least distance from a target at which a line of a given length ends, over its headings near the chord."""
    away = point - frames[face, :3]
    x, y = away @ frames[face, 3:6], away @ frames[face, 6:]
    chord = target - point
    first = np.arctan2(chord @ frames[face, 6:], chord @ frames[face, 3:6])
    best, at = np.inf, first
    for k in range(-60, 61):
        end, _ = end_in_space(row, link, frames, face, x, y, first + 0.01 * k, length)
        miss = np.sqrt(((end - target) ** 2).sum())
        if miss < best:
            best, at = miss, first + 0.01 * k
    low, high = at - 0.01, at + 0.01
    for _ in range(80):  # golden section: needs no derivative, which vertices would spoil
        a, b = low + 0.381966 * (high - low), low + 0.618034 * (high - low)
        end_a, _ = end_in_space(row, link, frames, face, x, y, a, length)
        end_b, _ = end_in_space(row, link, frames, face, x, y, b, length)
        if ((end_a - target) ** 2).sum() < ((end_b - target) ** 2).sum():
            high = b
        else:
            low = a
    end, _ = end_in_space(row, link, frames, face, x, y, 0.5 * (low + high), length)
    return np.sqrt(((end - target) ** 2).sum())


@njit
def all_misses(row, link, frames, faces, starts, targets, length):
    out = np.empty(len(faces))
    for n in range(len(faces)):
        out[n] = least_miss(row, link, frames, faces[n], starts[n], targets[n], length)
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
        arguments = net.face[i, j].astype(np.int64), net.points[i, j], net.points[i + di, j + dj]
        misses.append(all_misses(mesh.row, mesh.link, mesh.frames, *arguments, net.pitch))
    return np.concatenate(misses)
