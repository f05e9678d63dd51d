"""The same step in warp-lang on the CPU: a kernel per element, sums by atomic addition, double precision."""

from __future__ import annotations

from typing import Any

import numpy as np
import warp as wp

from geomdrap.forming import Model

wp.config.quiet = True
wp.init()
d = wp.float64
vec3, vec2 = wp.vec3d, wp.vec2d
TERMS = 6


@wp.kernel
def _membrane(
    x: wp.array(dtype=vec3), f: wp.array(dtype=vec3), corners: wp.array2d(dtype=wp.int32), shape: wp.array2d(dtype=d),
    old: wp.array2d(dtype=d), terms: wp.array2d(dtype=d), keep: wp.array(dtype=d), take: wp.array(dtype=d), plane: d,
    nu: d, lasting: d,
):  # fmt: skip
    t = wp.tid()
    a, b, c = corners[t, 0], corners[t, 1], corners[t, 2]
    ea, eb = x[b] - x[a], x[c] - x[a]
    d11, d12, d21, d22 = shape[t, 0], shape[t, 1], shape[t, 2], shape[t, 3]
    fu, fv = ea * d11 + eb * d21, ea * d12 + eb * d22
    c11, c12, c22 = wp.dot(fu, fu), wp.dot(fu, fv), wp.dot(fv, fv)
    half, one, two = d(0.5), d(1.0), d(2.0)
    m, e = half * (c11 + c22), half * (c11 - c22)
    r = wp.sqrt(e * e + c12 * c12)
    j = wp.sqrt(c11 * c22 - c12 * c12)
    factor = half / m
    if r > d(1e-9):
        factor = wp.log((m + r) / j) / (two * r)
    area = half * wp.log(j)
    t11 = plane * ((one + nu) * area + (one - nu) * e * factor)
    t22 = plane * ((one + nu) * area - (one - nu) * e * factor)
    t12 = plane * (one - nu) * c12 * factor
    g11, g12, g22 = t11 - old[0, t], t12 - old[1, t], t22 - old[2, t]
    old[0, t] = t11
    old[1, t] = t12
    old[2, t] = t22
    t11, t12, t22 = lasting * t11, lasting * t12, lasting * t22
    for k in range(TERMS):
        q11 = keep[k] * terms[3 * k, t] + take[k] * g11
        q12 = keep[k] * terms[3 * k + 1, t] + take[k] * g12
        q22 = keep[k] * terms[3 * k + 2, t] + take[k] * g22
        terms[3 * k, t] = q11
        terms[3 * k + 1, t] = q12
        terms[3 * k + 2, t] = q22
        t11 += q11
        t12 += q12
        t22 += q22
    root = wp.sqrt(c11 + c22 + two * j) * j
    v11, v12, v22 = (c22 + j) / root, -c12 / root, (c11 + j) / root
    s11 = v11 * v11 * t11 + two * v11 * v12 * t12 + v12 * v12 * t22
    s12 = v11 * v12 * t11 + (v11 * v22 + v12 * v12) * t12 + v12 * v22 * t22
    s22 = v12 * v12 * t11 + two * v12 * v22 * t12 + v22 * v22 * t22
    volume = -shape[t, 4]
    pu, pv = (fu * s11 + fv * s12) * volume, (fu * s12 + fv * s22) * volume
    fb, fc = pu * d11 + pv * d12, pu * d21 + pv * d22
    wp.atomic_add(f, b, fb)
    wp.atomic_add(f, c, fc)
    wp.atomic_add(f, a, -fb - fc)


@wp.kernel
def _yarns(
    x: wp.array(dtype=vec3), f: wp.array(dtype=vec3), ends: wp.array2d(dtype=wp.int32), law: wp.array2d(dtype=d)
):
    t = wp.tid()
    i, j = ends[t, 0], ends[t, 1]
    along = x[j] - x[i]
    length = wp.length(along)
    strain = wp.log(length * law[t, 0])
    share = law[t, 4] * strain
    if strain > d(0.0):
        share = strain - law[t, 2] * (d(1.0) - wp.exp(-strain * law[t, 3]))
    pull = along * (law[t, 1] * share / length)
    wp.atomic_add(f, i, pull)
    wp.atomic_add(f, j, -pull)


@wp.kernel
def _move(x: wp.array(dtype=vec3), v: wp.array(dtype=vec3), f: wp.array(dtype=vec3), mass: wp.array(dtype=d), dt: d):
    n = wp.tid()
    v[n] = v[n] + f[n] * (dt / mass[n])
    x[n] = x[n] + v[n] * dt
    f[n] = vec3(d(0.0), d(0.0), d(0.0))


class WarpStep:
    """Steps the free nodes of a model (no tools, no grips, no damping), with its own state."""

    def __init__(self, model: Model, velocity: np.ndarray):
        from geomdrap.forming.membrane import WIDTH
        from geomdrap.forming.state import start

        def rows(blocks: np.ndarray, count: int) -> np.ndarray:
            return np.swapaxes(blocks.reshape(len(blocks), -1, WIDTH), 1, 2).reshape(-1, blocks.shape[1] // WIDTH)[:count]

        def given(values: Any, kind: Any = d) -> Any:
            return wp.array(np.ascontiguousarray(values), dtype=kind, device="cpu")

        self.model, count = model, len(model.corners)
        first = start(model, velocity)
        self.x, self.v, self.f = (given(a.reshape(-1, 3), vec3) for a in (first.x, first.v, first.f))
        self.corners, self.ends = given(model.corners, wp.int32), given(model.ends, wp.int32)
        self.shape, self.law = given(rows(model.shape, count)), given(rows(model.truss_law, len(model.ends)))
        self.old, self.terms = given(np.zeros((3, count))), given(np.zeros((3 * TERMS, count)))
        self.keep, self.take, self.mass = given(model.keep), given(model.take), given(model.mass)

    def steps(self, number: int) -> None:
        """Take ``number`` steps."""
        resin = self.model.cloth.resin
        numbers = [d(resin.plane_modulus), d(resin.poisson), d(resin.relaxation.remaining)]
        membrane = [self.x, self.f, self.corners, self.shape, self.old, self.terms, self.keep, self.take, *numbers]
        yarns, move = [self.x, self.f, self.ends, self.law], [self.x, self.v, self.f, self.mass, d(self.model.step)]
        for _ in range(number):
            wp.launch(_move, len(self.model.mass), move, device="cpu")
            wp.launch(_membrane, len(self.model.corners), membrane, device="cpu")
            wp.launch(_yarns, len(self.model.ends), yarns, device="cpu")

    def points(self) -> np.ndarray:
        """Positions (n, 3), mm."""
        return self.x.numpy()
