"""Whether a ply locks, and how sharply its locking angle is known.

The angle is read twice: from the net that fits all readings best, and from where the measured shear stops. What the
two differ by, and how far the shear of the net itself runs beyond its angle, is in the interval.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.evidence import FAMILY, FORETELLS, LEAST_SHARE, MOST
from geomdrap.criticism.plateau import Plateau, plateau

if TYPE_CHECKING:
    from geomdrap.criticism.experiment import Experiment
    from geomdrap.criticism.likelihood import Scatter
    from geomdrap.criticism.model import Fitted
    from geomdrap.criticism.search import Round

LOCKING = "locking"


def shear_stops(experiment: Experiment, model: Fitted, scatter: Scatter) -> Plateau | None:
    """The plateau of the shear where a model foretells more, if shear was measured and has one."""
    if "shear" not in experiment.channels:
        return None
    own = experiment.channel_of() == experiment.channels.index("shear")
    measured, predicted = experiment.measured[own], (experiment.measured - model.fit.residual)[own]
    noise = float(np.median(experiment.noise[own]))
    # a model that is off makes its misfit pass for scatter: the noise alone is tried as well
    return plateau(measured, predicted, noise) or plateau(measured, predicted, float(np.hypot(noise, scatter.shear)))


def locks(experiment: Experiment, first: Round) -> bool:
    """Whether the shear stops at an angle, and locking explains a good share of the misfit, or more than all others.

    Yarns that buckled as the ply locked lie where no net foretells, and leave a small share to any of them. Where
    another effect explains nearly all, a small share of locking is of what looks like it.
    """
    own = next((e for e in first.evidence if e.name == LOCKING), None)
    if own is None or own.p_family >= FAMILY or not own.in_range:
        return False
    best = own.cv_ratio < FORETELLS and all(e.gain <= own.gain for e in first.evidence)
    small = own.share < LEAST_SHARE or (own.share < MOST and any(e.found and e.share >= MOST for e in first.evidence))
    return (best or not small) and first_stop(experiment, first) is not None


def first_stop(experiment: Experiment, first: Round) -> Plateau | None:
    """Where the measured shear stops against what the net without effects foretells."""
    return shear_stops(experiment, first.base, min(first.scatter, key=lambda s: s.size))


def doubted(experiment: Experiment, first: Round, model: Fitted) -> Fitted:
    """The model with the doubt of its locking angle, degrees, beside what the pitch adds."""
    k = next(k for k, (name, _) in enumerate(model.model.parameters) if name == LOCKING)
    angle, stop = float(model.values[k]), first_stop(experiment, first)
    net = experiment.draped(model.model.built(model.values), experiment.pitches[1])
    beyond = np.abs(net.cell_shear) - angle
    beyond = beyond[beyond > 0.0]
    doubt = np.zeros(len(model.values)) if model.doubt is None else model.doubt.copy()
    softness = float(np.sqrt(np.mean(beyond**2))) if len(beyond) else 0.0
    doubt[k] = np.linalg.norm([doubt[k], softness, 0.0 if stop is None else stop.angle - angle])
    return replace(model, doubt=doubt)
