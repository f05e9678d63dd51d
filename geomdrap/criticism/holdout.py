"""Hold-out by blocks of the fabric: how well a model foretells a patch of the ply that it was not fitted to.

Neighbours of a point know its scatter; holding out points at random would accept whatever is smooth. Whole blocks are
held out instead (V. Roy et al.; D. R. Roberts et al., Ecography 40, 2017, on spatial cross-validation).
"""

from __future__ import annotations

import numpy as np

BLOCKS = 8


def blocks_of(at: np.ndarray, count: int = BLOCKS) -> np.ndarray:
    """Block number (n,) of points (n, 2) mm: the patch halved across its longer side, again and again."""
    out = np.zeros(len(at), np.int64)
    groups = [np.arange(len(at))]
    while len(groups) < count:
        groups.sort(key=len)
        widest = groups.pop()
        axis = int(np.ptp(at[widest], axis=0).argmax()) if len(widest) else 0
        order = widest[np.argsort(at[widest, axis], kind="stable")]
        groups += [order[: len(order) // 2], order[len(order) // 2 :]]
    for k, group in enumerate(groups):
        out[group] = k
    return out


def held_out_error(residual: np.ndarray, slopes: np.ndarray, noise: np.ndarray, block: np.ndarray) -> float:
    """Root mean square of held-out residuals over the noise; 1 is a perfect model.

    ``residual`` (m,) and ``slopes`` (m, p) of a fitted model, ``noise`` (m,), ``block`` (m,) of each value. Without a
    block the parameters move to where the others want them, to first order.
    """
    r, a = residual / noise, slopes / noise[:, None]
    a = a / (np.linalg.norm(a, axis=0) + 1e-300)
    total = 0.0
    for k in np.unique(block):
        out = block == k
        step = np.linalg.lstsq(a[~out], r[~out], rcond=1e-9)[0] if a.size else np.zeros(0)
        left = r[out] - a[out] @ step
        total += float(left @ left)
    return float(np.sqrt(total / len(r)))
