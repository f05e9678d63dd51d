"""Signatures of effects on the measured points: which look alike, and how small an effect would still be seen."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geomdrap.criticism.likelihood import Judge, Scatter
from geomdrap.criticism.model import Fitted

ALIKE = 0.9  # cosine between two signatures
POWER = 0.84  # standard normal quantile of 80 %: the chance to see it


def beside_base(judge: Judge, scatter: Scatter, rows: np.ndarray, base: Fitted, trial: Fitted) -> np.ndarray:
    """Whitened slopes (m, k) of a trial's own parameters, less what the base's parameters could imitate."""
    whiten = judge.whiten(scatter)
    p = len(base.values)
    slopes = whiten(trial.fit.slopes[rows])
    size = np.linalg.norm(slopes, axis=0) + 1e-300
    q = np.linalg.qr(slopes[:, :p] / size[:p])[0]
    own = slopes[:, p:]
    return np.asarray(own - q @ (q.T @ own))


def look_alike(signatures: Sequence[np.ndarray]) -> np.ndarray:
    """Largest cosine (k, k) between what any mixture of two signatures' columns can give."""
    bases = [np.linalg.qr(s / (np.linalg.norm(s, axis=0) + 1e-300))[0] for s in signatures]
    silent = [np.linalg.norm(s) < 1e-9 for s in signatures]
    out = np.eye(len(bases))
    for a in range(len(bases)):
        for b in range(a):
            if not (silent[a] or silent[b]):
                cosine = np.linalg.svd(bases[a].T @ bases[b], compute_uv=False).max(initial=0.0)
                out[a, b] = out[b, a] = min(float(cosine), 1.0)
    return out


def least_visible(signature: np.ndarray, tried: int, level: float) -> np.ndarray:
    """The smallest size (k,) of each parameter that would be found with 80 % power at a family level.

    The others of the same effect are free; infinite where the points do not see it.
    """
    from scipy.special import ndtri

    needed = POWER - float(ndtri(level / (2.0 * max(tried, 1))))
    size = np.linalg.norm(signature, axis=0)
    out = np.full(signature.shape[1], np.inf)
    seen = size > 1e-9
    if seen.any():
        a = signature[:, seen] / size[seen]
        spread = np.sqrt(np.diag(np.linalg.pinv(a.T @ a, rcond=1e-9))) / size[seen]
        out[seen] = needed * spread
    return out
