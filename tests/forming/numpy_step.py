"""The whole step once more, in vectorised numpy: other formulas, no blocks, no compiler. Slow and independent."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix

from geomdrap.forming import Model


class NumpyStep:
    """Steps the free nodes of a model (no tools, no grips, no damping), with its own state."""

    def __init__(self, model: Model, velocity: np.ndarray | None = None):
        sheet, resin = model.sheet, model.cloth.resin
        self.model, self.x = model, sheet.points.copy()
        flat = sheet.fabric[sheet.triangles]
        edges = np.stack([flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]], axis=-1)
        self.inverse = np.linalg.inv(edges)
        self.volume = model.cloth.thickness * sheet.weight * 0.5 * np.abs(np.linalg.det(edges))
        nu = resin.poisson
        self.law = resin.modulus / (1 - nu**2) * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, 1 - nu]])  # 12 as tensor
        share, tau = np.asarray(resin.relaxation.shares), np.asarray(resin.relaxation.times)
        self.keep, self.take = np.exp(-model.step / tau), -share * np.expm1(-model.step / tau) / (model.step / tau)
        self.lasting = 1.0 - share.sum()
        self.old = np.zeros((len(flat), 3))
        self.terms = np.zeros((len(share), len(flat), 3))
        families = [model.cloth.families[k] for k in sheet.family]
        self.length = np.linalg.norm(np.diff(sheet.fabric[sheet.pieces], axis=1)[:, 0], axis=1)
        self.section = np.array([f.share for f in families]) * model.cloth.thickness * sheet.width
        self.modulus, self.crimp, self.push = (
            np.array([getattr(f, n) for f in families]) for n in ("modulus", "undulation", "compression")
        )
        nodes = np.concatenate([sheet.triangles.ravel(), sheet.pieces.ravel()])
        self.gather = csr_matrix((np.ones(len(nodes)), (nodes, np.arange(len(nodes)))), (len(self.x), len(nodes)))
        self.f = self.forces()
        self.v = np.zeros_like(self.x)
        if velocity is not None:
            self.v = velocity - 0.5 * model.step * self.f / model.mass[:, None]

    def forces(self) -> np.ndarray:
        """Forces (n, 3) of the fabric; the history is carried on."""
        sheet = self.model.sheet
        p = self.x[sheet.triangles]
        deformation = np.stack([p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]], axis=-1) @ self.inverse
        c = np.swapaxes(deformation, 1, 2) @ deformation
        c11, c12, c22 = c[:, 0, 0], c[:, 0, 1], c[:, 1, 1]
        mean, radius = 0.5 * (c11 + c22), np.sqrt((0.5 * (c11 - c22)) ** 2 + c12**2)
        j = np.sqrt(c11 * c22 - c12**2)
        with np.errstate(invalid="ignore", divide="ignore"):
            factor = np.where(radius > 1e-9, np.arctanh(radius / mean) / (2 * radius), 0.5 / mean)
        h = np.stack([0.5 * np.log(j) + factor * (c11 - mean), 0.5 * np.log(j) + factor * (c22 - mean), factor * c12], 1)
        elastic = h @ self.law.T
        change, self.old = elastic - self.old, elastic
        self.terms = self.keep[:, None, None] * self.terms + self.take[:, None, None] * change
        t = self.lasting * elastic + self.terms.sum(axis=0)
        inverse_u = np.empty_like(c)
        root = np.sqrt(c11 + c22 + 2 * j)
        inverse_u[:, 0, 0], inverse_u[:, 1, 1] = (c22 + j) / (root * j), (c11 + j) / (root * j)
        inverse_u[:, 0, 1] = inverse_u[:, 1, 0] = -c12 / (root * j)
        stress = np.empty_like(c)
        stress[:, 0, 0], stress[:, 1, 1], stress[:, 0, 1], stress[:, 1, 0] = t[:, 0], t[:, 1], t[:, 2], t[:, 2]
        piola = deformation @ inverse_u @ stress @ inverse_u
        edge = -self.volume[:, None, None] * piola @ np.swapaxes(self.inverse, 1, 2)
        corner = np.stack([-edge.sum(axis=2), edge[:, :, 0], edge[:, :, 1]], axis=1)
        return self.gather @ np.concatenate([corner.reshape(-1, 3), self._yarns()])

    def _yarns(self) -> np.ndarray:
        ends = self.x[self.model.sheet.pieces]
        along = ends[:, 1] - ends[:, 0]
        length = np.linalg.norm(along, axis=1)
        strain = np.log(length / self.length)
        crimp = np.where(self.crimp > 0, self.crimp, 1.0)
        slack = np.where(self.crimp > 0, crimp * (1 - np.exp(-np.maximum(strain, 0) / crimp)), 0.0)
        force = self.section * self.modulus * np.where(strain > 0, strain - slack, self.push * strain)
        pull = (force / length)[:, None] * along
        return np.stack([pull, -pull], axis=1).reshape(-1, 3)

    def step(self) -> None:
        """One step."""
        self.v = self.v + self.model.step * self.f / self.model.mass[:, None]
        self.x = self.x + self.model.step * self.v
        self.f = self.forces()
