"""What a model leaves unexplained: is it noise, lay-up scatter, or structure that needs a cause?

Scatter is smooth over some cells and goes nowhere in particular. Structure shows in four ways that scatter cannot:
it spans the part, so that low polynomials of the fabric coordinates catch it; it moves yarns as wholes, as a bend or
a kink of a generator moves every yarn that crosses it; it lifts the ply off the tool; or it shears the ply without
moving it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geomdrap.criticism.evidence import chance
from geomdrap.criticism.experiment import Experiment
from geomdrap.criticism.likelihood import Judge, Residuals, Scatter, spanned, square_beside
from geomdrap.criticism.scatter import DEG

DEGREE = 3  # of the polynomials
MOST_KNOTS = 16  # of what moves yarns as wholes, over the patch
ROUGHLY = 50.0  # times less a chance must be there: how scatter adds up over whole yarns is known only roughly
LEAST = 1e-4  # chance of so much structure where there is only noise and scatter
DOUBTFUL = 0.02  # the same: it may still be a further effect, which scatter takes for its own
NOISE = 0.5  # of the noise: a leftover smaller than this is no matter


@dataclass(frozen=True)
class Leftover:
    """What is left: ``p_value`` of as much structure by chance; ``size``: its root mean square over the noise.

    ``channels`` names where it is, the largest part first; ``structured`` is the verdict.
    """

    p_value: float
    size: float
    channels: tuple[str, ...]

    @property
    def structured(self) -> bool:
        """Whether something is left that needs a cause."""
        return self.p_value < LEAST and self.size > NOISE

    @property
    def doubtful(self) -> bool:
        """Whether what is left is more than scatter leaves as a rule, if not for certain."""
        return self.p_value < DOUBTFUL and self.size > NOISE


def leftover(experiment: Experiment, rows: np.ndarray, judge: Judge, model: Residuals, scatter: Scatter) -> Leftover:
    """Judge the residuals of a fitted model, on the values ``rows`` (m,) bool."""
    at = experiment.at[experiment.point_of()[rows]]
    channel = np.array(experiment.channels)[experiment.channel_of()[rows]]
    whiten = judge.whiten(scatter)
    residual, slopes = whiten(model.residual), whiten(model.slopes)
    before = square_beside(residual, slopes)
    sought = [(smooth_fields(at, channel), 1.0), (yarn_fields(at, channel), ROUGHLY)]
    chances = []
    for fields, rough in sought:
        both = np.hstack([slopes, whiten(fields)])
        more = spanned(both).shape[1] - spanned(slopes).shape[1]
        chances.append(rough * chance(before - square_beside(residual, both), more))
    p_value = min(len(sought) * min(chances), 1.0)
    # its size where it was measured, channel by channel
    fields = np.hstack([fields for fields, _ in sought])
    both = np.hstack([slopes, whiten(fields)])
    norm = np.linalg.norm(both, axis=0) + 1e-300
    step = np.linalg.lstsq(both / norm, residual, rcond=1e-8)[0] / norm
    caught = np.abs(np.hstack([model.slopes, fields]) @ step) / judge.noise
    sizes = {str(c): float(np.sqrt(np.mean(caught[channel == c] ** 2))) for c in np.unique(channel)}
    order = sorted(sizes, key=lambda c: -sizes[c])
    return Leftover(p_value, max(sizes.values()), tuple(c for c in order if sizes[c] > NOISE))


def smooth_fields(at: np.ndarray, channel: np.ndarray) -> np.ndarray:
    """Polynomials of the fabric coordinates, as the values of all channels see them.

    ``at`` (m, 2) mm and ``channel`` (m,) of each value. Shifts along the part turn and shear the ply as they move it;
    on top of them a lift off the tool, and a shear that moves nothing. Gives fields (m, k).
    """
    middle, half = at.mean(axis=0), 0.5 * np.ptp(at, axis=0).max()
    x, y = ((at - middle) / half).T
    powers = [(a, b) for a in range(DEGREE + 1) for b in range(DEGREE + 1 - a)]
    columns = []
    for a, b in powers:
        value = x**a * y**b
        along_u = a * x ** max(a - 1, 0) * y**b / half * DEG
        along_v = b * x**a * y ** max(b - 1, 0) / half * DEG
        for seen in (
            {"along": value, "shear": along_v, "weft": -along_v},
            {"across": value, "shear": along_u, "warp": along_u},
            {"normal": value},
            {"shear": value},
        ):
            column = sum((np.where(channel == c, v, 0.0) for c, v in seen.items()), np.zeros(len(at)))
            if np.abs(column).max() > 0.0:
                columns.append(column)
    return np.column_stack(columns)


def yarn_fields(at: np.ndarray, channel: np.ndarray) -> np.ndarray:
    """Shifts of whole yarns along themselves, piecewise linear: of weft yarns by their u, of warp yarns by their v.

    Arguments as in ``smooth_fields``. Gives fields (m, k).
    """
    places = len(np.unique(np.round(at, 6), axis=0))
    count = min(max(int(np.sqrt(places)), 3), MOST_KNOTS)
    columns = []
    seen = (("across", {"shear": 1.0, "warp": 1.0}), ("along", {"shear": 1.0, "weft": -1.0}))
    for x, (shifted, turned) in zip(at.T, seen, strict=True):
        knots = np.linspace(x.min(), x.max(), count)
        wide = max(knots[1] - knots[0], 1e-12)
        for knot in knots:
            away = (x - knot) / wide
            hat = np.maximum(1.0 - np.abs(away), 0.0)
            slope = np.where(np.abs(away) < 1.0, -np.sign(away), 0.0) / wide * DEG
            column = np.where(channel == shifted, hat, 0.0)
            for name, sign in turned.items():
                column = column + np.where(channel == name, sign * slope, 0.0)
            columns.append(column)
    return np.column_stack(columns)
