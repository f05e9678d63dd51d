"""Relaxed nets: the energy of all nodes at once brought to its minimum, by Levenberg-Marquardt on sparse matrices.

Unknown are the plan points of the nodes, so that the net stays on the sheet exactly; the seed is held.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.blind.energy import HELD, KEPT, Block, Topology, blocks, sines, strains, topology
from geomdrap.blind.recipe import Recipe
from geomdrap.blind.sheet import Sheet, normals, turnings
from geomdrap.blind.terms import Array
from geomdrap.errors import GeomdrapError

STEPS = 300
SMALL_STEP = 1e-6  # of a side
SETTLED = 1e-9  # of the energy, the least share worth another step: softly held nets still turn at 1e-6
NO_CELL = "the seed of the blind part has no cell beside it along the warp; put it further from the edge"
DAMPED = 1e-2  # damping above which a small gain says nothing


def relaxed(sheet: Sheet, plan: Array, recipe: Recipe, side: float) -> Array:
    """Give the plan points (n, n, 2) of least energy, from the geometric net ``plan``.

    Nodes of no whole cell are left out, and cells that no side joins to those beside the seed: nothing holds what
    hangs on a single yarn. NoMinimumError if no minimum is found in STEPS steps.
    """
    known = _joined(np.isfinite(plan[..., 0]))
    if not known.any():
        raise GeomdrapError(NO_CELL)
    plan = np.where(known[..., None], plan, np.nan)
    net = topology(known)
    seed = int(np.cumsum(known)[np.ravel_multi_index((plan.shape[0] // 2,) * 2, known.shape)]) - 1
    problem = _Problem(sheet, net, recipe, side, plan[known], seed)
    moved = plan.copy()
    moved[known] = _minimum(problem, plan[known])
    return moved


def _joined(known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Nodes (n, n) of cells whose four nodes are ``known``, joined by sides to those beside the first warp side."""
    from scipy.ndimage import label

    corners = np.s_[:-1, :-1], np.s_[1:, :-1], np.s_[1:, 1:], np.s_[:-1, 1:]
    patch, _ = label(np.logical_and.reduce([known[corner] for corner in corners]))
    m = len(known) // 2
    beside = patch[m, m - 1 : m + 1]
    whole = np.isin(patch, beside[beside > 0])
    kept = np.zeros_like(known)
    for corner in corners:
        kept[corner] |= whole
    return kept


class NoMinimumError(GeomdrapError):
    """The relaxed net did not come to rest; a blind set is drawn anew then."""


class _Problem:
    """Residuals and their sparse Jacobian by the plan points of all nodes but the seed."""

    def __init__(self, sheet: Sheet, net: Topology, recipe: Recipe, side: float, xy: Array, seed: int):
        self.sheet, self.net, self.recipe, self.side, self.seed = sheet, net, recipe, side, seed
        points, along_x, along_y = sheet(xy)
        strain = np.asarray(recipe.extension)[net.along]
        self.rest = side * (1.0 + strain)
        self.aim = _relieved(sines(points, net.corners, net.sign).value, recipe)
        self.first = self._first_warp_side()
        chord = points[self.first] - points[seed]
        left = np.cross(np.cross(along_x[seed], along_y[seed]), chord)
        self.left = left / np.linalg.norm(left)
        self.size = 2 * len(xy)
        self.sums = self._sums()

    def _first_warp_side(self) -> int:
        net = self.net
        warp = net.sides[(net.along == 0) & (net.sides[:, 0] == self.seed)]
        if len(warp) == 0:
            raise GeomdrapError(NO_CELL)
        return int(warp[0, 1])

    def energy(self, xy: Array) -> float:
        """The energy at the plan points ``xy`` (n, 2)."""
        p, normal, _, _ = self._at(xy)
        kept = self._kept(p)
        return float(sum(np.sum(block.value**2) for block in self._blocks(p, normal)) + kept @ kept)

    def linear(self, xy: Array) -> tuple[Any, Any, Array]:
        """JᵀJ of the sparse residuals (2n, 2n), J of those along whole yarns (y, 2n), gradient Jᵀr of all (2n,)."""
        from scipy.sparse import vstack

        p, normal, px, py = self._at(xy)
        found = self._blocks(p, normal)
        jacobian = vstack([self._matrix(block, px, py) for block in found], format="csr")
        gradient = jacobian.T @ np.concatenate([block.value for block in found])
        along = self.sums @ self._matrix(strains(p, self.net.sides, self.rest), px, py)
        return (jacobian.T @ jacobian).tocsc(), along, gradient + along.T @ self._kept(p)

    def _at(self, xy: Array) -> tuple[Array, tuple[Array, Array], Array, Array]:
        p, px, py = self.sheet(xy)
        normal = (normals(self.sheet, xy), turnings(self.sheet, xy)) if self.recipe.bending else (p, p)
        return p, normal, px, py

    def _blocks(self, p: Array, normal: tuple[Array, Array]) -> list[Block]:
        return [*blocks(p, normal, self.net, self.rest, self.side, self.recipe, self.aim), self._held(p)]

    def _matrix(self, block: Block, px: Array, py: Array) -> Any:
        """The block's derivatives by the plan points, (m, 2n)."""
        from scipy.sparse import csr_matrix

        by_x = np.sum(block.slope * px[block.nodes], axis=2)
        by_y = np.sum(block.slope * py[block.nodes], axis=2)
        entries = np.stack([by_x, by_y], axis=2)
        entries[block.nodes == self.seed] = 0.0
        columns = np.stack([2 * block.nodes, 2 * block.nodes + 1], axis=2)
        width = entries[0].size
        starts = width * np.arange(len(entries) + 1)
        shape = (len(entries), self.size)
        return csr_matrix((entries.ravel(), columns.ravel(), starts), shape=shape)

    def _held(self, p: Array) -> Block:
        """What the first warp side's end moves sideways, in sides."""
        value = HELD / self.side * (p[self.first] - p[self.seed]) @ self.left
        slope = HELD / self.side * self.left[None, None]
        return Block(np.array([value]), np.array([[self.first]]), slope)

    def _kept(self, p: Array) -> Array:
        """Mean strain of each yarn times √(its sides · KEPT): yarns that slip keep their total length; (y,)."""
        return self.sums @ strains(p, self.net.sides, self.rest).value

    def _sums(self) -> Any:
        """The matrix (y, sides) that takes strains of sides to those residuals; no rows where nothing slips."""
        from scipy.sparse import csr_matrix

        if not self.recipe.share:
            return csr_matrix((0, len(self.net.sides)))
        _, at, count = np.unique(self.net.yarn, return_inverse=True, return_counts=True)
        return csr_matrix((np.sqrt(KEPT / count)[at], (at, np.arange(len(at)))))


def _relieved(sine: Array, recipe: Recipe) -> Array:
    """sin of γ − share (|γ| − onset)₊ sign γ: the shear that slipping crossings go for; γ itself if none slip."""
    gamma = np.arcsin(np.clip(sine, -0.9999, 0.9999))
    beyond = np.maximum(np.abs(gamma) - np.deg2rad(recipe.onset), 0.0)
    return np.sin(gamma - recipe.share * beyond * np.sign(gamma))


def _minimum(problem: _Problem, xy: Array) -> Array:
    """Levenberg-Marquardt from the plan points ``xy`` (n, 2)."""
    energy = problem.energy(xy)
    damping = 1e-6
    terms = problem.linear(xy)
    for _ in range(STEPS):
        step = _step(*terms, damping, problem.seed)
        trial = xy + step.reshape(-1, 2)
        after = problem.energy(trial)
        settled = abs(energy - after) <= SETTLED * energy and damping < DAMPED
        if after <= energy:
            xy, energy, damping = trial, after, max(damping / 5.0, 1e-9)
            if settled:
                return xy
            terms = problem.linear(xy)
        elif settled or np.max(np.abs(step)) < SMALL_STEP * problem.side:
            return xy
        else:
            damping *= 10.0
    raise NoMinimumError("the relaxed net of this blind set found no minimum; take another --seed")


def _step(normal: Any, along: Any, gradient: Array, damping: float, seed: int) -> Array:
    """Solve (H + AᵀA) dx = −g, H = ``normal`` with damping, A = ``along``: few rows, so by Woodbury's formula."""
    from scipy.sparse import diags
    from scipy.sparse.linalg import splu

    extra = damping * normal.diagonal()
    extra[2 * seed : 2 * seed + 2] += 1.0  # nothing moves the seed
    factors = splu(normal + diags(extra, format="csc"), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    step = -factors.solve(gradient)
    if along.shape[0] == 0:
        return step
    across = factors.solve(along.T.toarray())
    return step - across @ np.linalg.solve(np.eye(along.shape[0]) + along @ across, along @ step)
