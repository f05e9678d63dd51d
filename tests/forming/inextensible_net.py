"""The strip of an inextensible net, solved by itself: no mesh of triangles, no dynamics, no yarn strain.

R. S. Rivlin (Arch. Rational Mech. Anal. 2 (1959) 447): where yarns do not stretch, places are r = A(u) + B(v) with
unit slopes, so that the warp has one direction a(u) along each weft line, the weft one direction b(v) along each warp
line. Lines that meet a clamp keep the directions that they had. What is left are a on the warp between the clamps and
b on the weft, which minimise the energy of the sheared resin for the given displacement of the clamp.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import minimize

PLANE, POISSON = 45.0 / (1.0 - 0.45**2), 0.45


def trellis_energy(shear: np.ndarray) -> np.ndarray:
    """Energy per volume, MPa, of resin in trellis shear (rad): ½ ln U : C₀ : ln U, its stretches cos ± sin of half."""
    c, s = np.cos(0.5 * shear), np.sin(0.5 * shear)
    p, m = np.log(c + s), np.log(c - s)
    return 0.5 * PLANE * (p * p + m * m + 2.0 * POISSON * p * m)


def trellis_slope(shear: np.ndarray) -> np.ndarray:
    """Its derivative, MPa."""
    c, s = np.cos(0.5 * shear), np.sin(0.5 * shear)
    up, down = c + s, c - s
    first, second = (PLANE * (np.log(a) + POISSON * np.log(b)) for a, b in ((up, down), (down, up)))
    return 0.5 * (first * down / up - second * up / down)


@dataclass
class NetStrip:
    """A strip of length, width and thickness mm whose warp lies at an angle (deg) from its length."""

    length: float
    width: float
    thickness: float
    angle: float
    parts: int = 120

    def __post_init__(self) -> None:
        t = np.deg2rad(self.angle)
        self.start = np.array([0.5 * np.pi - t, np.pi - t])  # warp and weft from +x; the length lies along y
        clamp = self.width * np.array([np.sin(t), np.cos(t)])
        self.free = np.array([self.length * np.cos(t) - clamp[0], self.length * np.sin(t) - clamp[1]])
        self.counts = np.maximum(8, np.round(self.parts * self.free / self.free.sum()).astype(int))
        self.weights = self._areas(t, clamp)

    def _areas(self, t: float, clamp: np.ndarray) -> np.ndarray:
        """Area (mm²) of the strip in each band of warp (clamped, free…, clamped) and of weft."""
        # u runs from the lower left corner along warp, v along weft; the lower right corner lies at v < 0
        edges_u = np.concatenate(
            [[0.0], clamp[0] + np.linspace(0.0, self.free[0], self.counts[0] + 1), [2 * clamp[0] + self.free[0]]]
        )
        edges_v = -clamp[1] + np.concatenate(
            [[0.0], clamp[1] + np.linspace(0.0, self.free[1], self.counts[1] + 1), [2 * clamp[1] + self.free[1]]]
        )
        out = np.zeros((len(edges_u) - 1, len(edges_v) - 1))
        warp, weft = (np.array([np.cos(a), np.sin(a)]) for a in self.start)
        for k, (lo, hi) in enumerate(pairwise(edges_u)):
            u = lo + (np.arange(400) + 0.5) * (hi - lo) / 400
            ends = []  # v where the line u leaves the strip 0 < x < W, 0 < y < L
            for axis, size in ((0, self.width), (1, self.length)):
                ends.append(
                    np.sort(
                        np.stack([(0.0 - u * warp[axis]) / weft[axis], (size - u * warp[axis]) / weft[axis]]), axis=0
                    )
                )
            low, high = np.maximum(ends[0][0], ends[1][0]), np.minimum(ends[0][1], ends[1][1])
            cover = np.minimum(high[:, None], edges_v[1:]) - np.maximum(low[:, None], edges_v[:-1])
            out[k] = np.maximum(cover, 0.0).mean(axis=0) * (hi - lo)
        return out

    def solve(self, displacements: list[float]) -> list[tuple[float, float]]:
        """Force N and shear (deg) in the middle at each of ascending displacements, mm."""
        first = np.concatenate([np.full(self.counts[0], self.start[0]), np.full(self.counts[1], self.start[1])])
        guess, results, h = first.copy(), [], 1e-3
        for d in displacements:
            energies = []
            for at in (d - h, d + h, d):
                guess, energy = self._least(guess, at)
                energies.append(energy)
            results.append(((energies[1] - energies[0]) / (2 * h), self._middle(guess)))
        return results

    def _angles(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        a, b = unknown[: self.counts[0]], unknown[self.counts[0] :]
        s = self.start
        return np.concatenate([[s[0]], a, [s[0]]]), np.concatenate([[s[1]], b, [s[1]]])

    def _middle(self, unknown: np.ndarray) -> float:
        a, b = unknown[: self.counts[0]], unknown[self.counts[0] :]
        return float(90.0 - np.rad2deg(b[len(b) // 2] - a[len(a) // 2]))

    def _least(self, guess: np.ndarray, displacement: float) -> tuple[np.ndarray, float]:
        steps = np.concatenate([np.full(n, f / n) for n, f in zip(self.counts, self.free, strict=True)])
        rest = np.concatenate([np.full(self.counts[0], self.start[0]), np.full(self.counts[1], self.start[1])])
        goal = np.array([steps @ np.cos(rest), steps @ np.sin(rest) + displacement])
        scale = self.thickness * PLANE * self.length

        def energy(x: np.ndarray) -> tuple[float, np.ndarray]:
            a, b = self._angles(x)
            shear = 0.5 * np.pi - (b[None, :] - a[:, None])
            slope = self.thickness * self.weights * trellis_slope(shear)
            total = float(np.sum(self.thickness * self.weights * trellis_energy(shear)))
            return total / scale, np.concatenate([slope.sum(axis=1)[1:-1], -slope.sum(axis=0)[1:-1]]) / scale

        constraint = {
            "type": "eq",
            "fun": lambda x: np.array([steps @ np.cos(x), steps @ np.sin(x)]) - goal,
            "jac": lambda x: np.stack([-steps * np.sin(x), steps * np.cos(x)]),
        }
        found = minimize(
            energy, guess, jac=True, method="SLSQP", constraints=[constraint], options={"ftol": 1e-15, "maxiter": 500}
        )
        return found.x, float(found.fun) * scale
