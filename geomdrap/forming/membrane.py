"""Forces of the resin: constant-strain triangles in the frame of the yarns, many at a time.

With the edge vectors e of a triangle and those of its reference D, F = e D⁻¹ (3 × 2), C = FᵀF, U = √C in closed form.
T is the Kirchhoff stress turned into the frame of U (Green–Naghdi's); from it follow S = U⁻¹ T U⁻¹, P = F S and the
forces −V P D⁻ᵀ, so that the rotation itself is never formed. Stress power is V T : sym(U̇ U⁻¹).

Triangles are worked on in blocks of `WIDTH`, each quantity in a row of its own of one buffer: distances between rows
are constants, so that the compiler sees that they do not overlap, and does eight triangles at once.
"""

from __future__ import annotations

import math

from numpy.typing import NDArray

from geomdrap.forming.elementary import ln
from geomdrap.geodesic.compiled import kernel

WIDTH = 64
"""Elements in a block."""

SHAPE_ROWS = 5
(D11, D12, D21, D22, VOLUME) = (WIDTH * row for row in range(SHAPE_ROWS))
"""Rows of a block's shape: inverse of the reference edges (first index: edge), volume."""

(EAX, EAY, EAZ, EBX, EBY, EBZ) = (WIDTH * row for row in range(6))
(FUX, FUY, FUZ, FVX, FVY, FVZ) = (WIDTH * row for row in range(6, 12))
(C11, C12, C22, J, R, TRACE) = (WIDTH * row for row in range(12, 18))
(U11, U12, U22, T11, T12, T22) = (WIDTH * row for row in range(18, 24))
(FBX, FBY, FBZ, FCX, FCY, FCZ) = (WIDTH * row for row in range(24, 30))
WORK_ROWS = 30

(OLD11, OLD12, OLD22, LAST11, LAST12, LAST22) = (WIDTH * row for row in range(6))
FIRST_TERM = 6 * WIDTH
TERM = 3 * WIDTH
"""Rows of a block's history: elastic stress, stretch, then 11, 12, 22 of each term of the relaxation."""

(PLANE, POISSON, REMAINING, CONSTANT, FORM) = range(5)
"""Numbers of the law: E/(1−ν²), ν, lasting share, 1 where the thickness is constant, index in STRAIN_FORMS."""
HENCKY, RATE, GREEN = range(3)


@kernel
def membrane_forces(
    x: NDArray, f: NDArray, corners: NDArray, shape: NDArray, history: NDArray, law: NDArray, keep: NDArray,
    take: NDArray, work: NDArray,
) -> None:  # fmt: skip
    """Add the forces of the triangles at ``x`` (3n,) mm to ``f`` (3n,) N, and carry their history on.

    ``corners`` (m, 3) node numbers; ``shape`` (blocks, rows), ``history`` (blocks, rows) see above; ``keep``,
    ``take`` (k,) of the relaxation for the step; ``work`` (WORK_ROWS × WIDTH,) scratch.
    """
    for block in range(shape.shape[0]):
        first = block * WIDTH
        count = min(WIDTH, corners.shape[0] - first)
        for u in range(WIDTH):
            t = first + min(u, count - 1)
            a, b, c = 3 * corners[t, 0], 3 * corners[t, 1], 3 * corners[t, 2]
            work[EAX + u] = x[b] - x[a]
            work[EAY + u] = x[b + 1] - x[a + 1]
            work[EAZ + u] = x[b + 2] - x[a + 2]
            work[EBX + u] = x[c] - x[a]
            work[EBY + u] = x[c + 1] - x[a + 1]
            work[EBZ + u] = x[c + 2] - x[a + 2]
        stretches(work, shape[block])
        if law[FORM] == HENCKY:
            hencky_stress(work, law[PLANE], law[POISSON])
        elif law[FORM] == RATE:
            rate_stress(work, history[block], law[PLANE], law[POISSON])
        else:
            green_stress(work, law[PLANE], law[POISSON])
        relax(work, history[block], law[REMAINING], keep, take)
        corner_forces(work, shape[block], law[CONSTANT], law[FORM] == GREEN)
        for u in range(count):
            t = first + u
            a, b, c = 3 * corners[t, 0], 3 * corners[t, 1], 3 * corners[t, 2]
            for k in range(3):
                fb, fc = work[FBX + k * WIDTH + u], work[FCX + k * WIDTH + u]
                f[b + k] += fb
                f[c + k] += fc
                f[a + k] -= fb + fc


@kernel
def stretches(w: NDArray, d: NDArray) -> None:
    """Columns of F, C, J = √det C, U = (C + J) / √(tr C + 2J)."""
    for u in range(WIDTH):
        w[FUX + u] = w[EAX + u] * d[D11 + u] + w[EBX + u] * d[D21 + u]
        w[FUY + u] = w[EAY + u] * d[D11 + u] + w[EBY + u] * d[D21 + u]
        w[FUZ + u] = w[EAZ + u] * d[D11 + u] + w[EBZ + u] * d[D21 + u]
        w[FVX + u] = w[EAX + u] * d[D12 + u] + w[EBX + u] * d[D22 + u]
        w[FVY + u] = w[EAY + u] * d[D12 + u] + w[EBY + u] * d[D22 + u]
        w[FVZ + u] = w[EAZ + u] * d[D12 + u] + w[EBZ + u] * d[D22 + u]
    for u in range(WIDTH):
        c11 = w[FUX + u] * w[FUX + u] + w[FUY + u] * w[FUY + u] + w[FUZ + u] * w[FUZ + u]
        c12 = w[FUX + u] * w[FVX + u] + w[FUY + u] * w[FVY + u] + w[FUZ + u] * w[FVZ + u]
        c22 = w[FVX + u] * w[FVX + u] + w[FVY + u] * w[FVY + u] + w[FVZ + u] * w[FVZ + u]
        nx = w[FUY + u] * w[FVZ + u] - w[FUZ + u] * w[FVY + u]
        ny = w[FUZ + u] * w[FVX + u] - w[FUX + u] * w[FVZ + u]
        nz = w[FUX + u] * w[FVY + u] - w[FUY + u] * w[FVX + u]
        j = math.sqrt(nx * nx + ny * ny + nz * nz)
        trace = math.sqrt(c11 + c22 + 2.0 * j)
        w[C11 + u], w[C12 + u], w[C22 + u], w[J + u] = c11, c12, c22, j
        w[U11 + u], w[U12 + u], w[U22 + u] = (c11 + j) / trace, c12 / trace, (c22 + j) / trace


@kernel
def hencky_stress(w: NDArray, plane: float, poisson: float) -> None:
    """Elastic stress T of the strain ln U = ½ ln C; ln C from the mean m and the radius d of its principal values.

    ln U = ½ ln J + (C − m) artanh(d/m) / (2d), and artanh(d/m) = ln((m + d)/J); for small d/m, its series.
    """
    for u in range(WIDTH):
        m, e = 0.5 * (w[C11 + u] + w[C22 + u]), 0.5 * (w[C11 + u] - w[C22 + u])
        d2 = e * e + w[C12 + u] * w[C12 + u]
        r = d2 / (m * m)
        series = 1.0 / 15.0
        series = series * r + 1.0 / 13.0
        series = series * r + 1.0 / 11.0
        series = series * r + 1.0 / 9.0
        series = series * r + 1.0 / 7.0
        series = series * r + 1.0 / 5.0
        series = series * r + 1.0 / 3.0
        d = math.sqrt(d2)
        far = ln((m + d) / w[J + u]) / (d + 1e-300)
        w[R + u] = 0.5 * ((1.0 + r * series) / m if r < 0.01 else far)
    for u in range(WIDTH):
        area = 0.5 * ln(w[J + u])
        e = 0.5 * (w[C11 + u] - w[C22 + u]) * w[R + u]
        w[T11 + u] = plane * ((1.0 + poisson) * area + (1.0 - poisson) * e)
        w[T22 + u] = plane * ((1.0 + poisson) * area - (1.0 - poisson) * e)
        w[T12 + u] = plane * (1.0 - poisson) * w[C12 + u] * w[R + u]


@kernel
def green_stress(w: NDArray, plane: float, poisson: float) -> None:
    """Elastic second Piola–Kirchhoff stress of Green's strain ½ (C − 1)."""
    for u in range(WIDTH):
        e11, e22 = 0.5 * (w[C11 + u] - 1.0), 0.5 * (w[C22 + u] - 1.0)
        w[T11 + u] = plane * (e11 + poisson * e22)
        w[T22 + u] = plane * (e22 + poisson * e11)
        w[T12 + u] = plane * (1.0 - poisson) * 0.5 * w[C12 + u]


@kernel
def rate_stress(w: NDArray, h: NDArray, plane: float, poisson: float) -> None:
    """Elastic stress summed up from C₀ : sym(ΔU U⁻¹), U at the middle of the step (Eq. 3 and 4)."""
    for u in range(WIDTH):
        d11, d12, d22 = w[U11 + u] - h[LAST11 + u], w[U12 + u] - h[LAST12 + u], w[U22 + u] - h[LAST22 + u]
        m11, m12, m22 = w[U11 + u] - 0.5 * d11, w[U12 + u] - 0.5 * d12, w[U22 + u] - 0.5 * d22
        inverse = 1.0 / (m11 * m22 - m12 * m12)
        r11 = (d11 * m22 - d12 * m12) * inverse
        r22 = (d22 * m11 - d12 * m12) * inverse
        r12 = 0.5 * (d12 * m11 - d11 * m12 + d12 * m22 - d22 * m12) * inverse
        w[T11 + u] = h[OLD11 + u] + plane * (r11 + poisson * r22)
        w[T22 + u] = h[OLD22 + u] + plane * (r22 + poisson * r11)
        w[T12 + u] = h[OLD12 + u] + plane * (1.0 - poisson) * r12
        h[LAST11 + u], h[LAST12 + u], h[LAST22 + u] = w[U11 + u], w[U12 + u], w[U22 + u]


@kernel
def relax(w: NDArray, h: NDArray, remaining: float, keep: NDArray, take: NDArray) -> None:
    """T = g_∞ T₀ + Σ q_k, with q_k ← keep_k q_k + take_k ΔT₀."""
    for row in range(3):
        old, new = h[row * WIDTH : (row + 1) * WIDTH], w[T11 + row * WIDTH : T11 + (row + 1) * WIDTH]
        change = w[FBX + row * WIDTH : FBX + (row + 1) * WIDTH]  # free until the forces are worked out
        for u in range(WIDTH):
            change[u] = new[u] - old[u]
            old[u] = new[u]
            new[u] = remaining * new[u]
        for k in range(keep.shape[0]):
            a, b = keep[k], take[k]
            start = FIRST_TERM + k * TERM + row * WIDTH
            q = h[start : start + WIDTH]
            for u in range(WIDTH):
                q[u] = a * q[u] + b * change[u]
                new[u] += q[u]


@kernel
def corner_forces(w: NDArray, d: NDArray, constant: float, is_second_piola: bool) -> None:
    """Forces on the second and third corner, N, from T (or from S itself)."""
    if not is_second_piola:
        for u in range(WIDTH):
            j = w[J + u]
            a, b, c = w[U22 + u], -w[U12 + u], w[U11 + u]  # J U⁻¹
            p, q = a * w[T11 + u] + b * w[T12 + u], a * w[T12 + u] + b * w[T22 + u]
            r, s = b * w[T11 + u] + c * w[T12 + u], b * w[T12 + u] + c * w[T22 + u]
            scale = (1.0 + constant * (j - 1.0)) / (j * j)
            w[T11 + u], w[T12 + u] = (p * a + q * b) * scale, (p * b + q * c) * scale
            w[T22 + u] = (r * b + s * c) * scale
    for u in range(WIDTH):
        v, s11, s12, s22 = d[VOLUME + u], w[T11 + u], w[T12 + u], w[T22 + u]
        b1, b2 = -v * (s11 * d[D11 + u] + s12 * d[D12 + u]), -v * (s12 * d[D11 + u] + s22 * d[D12 + u])
        c1, c2 = -v * (s11 * d[D21 + u] + s12 * d[D22 + u]), -v * (s12 * d[D21 + u] + s22 * d[D22 + u])
        w[FBX + u] = b1 * w[FUX + u] + b2 * w[FVX + u]
        w[FBY + u] = b1 * w[FUY + u] + b2 * w[FVY + u]
        w[FBZ + u] = b1 * w[FUZ + u] + b2 * w[FVZ + u]
        w[FCX + u] = c1 * w[FUX + u] + c2 * w[FVX + u]
        w[FCY + u] = c1 * w[FUY + u] + c2 * w[FVY + u]
        w[FCZ + u] = c1 * w[FUZ + u] + c2 * w[FVZ + u]
