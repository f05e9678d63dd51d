"""How the resin forgets stress: a Prony series, and three readings of the paper's Table 1.

The table lists six numbers beside the times 0.01 to 1000 s and calls them ``C12^mk`` of the shear; neither unit nor
meaning is given (A. Cherouat, H. Borouchaki, Materials 2 (2009) 1835). Each reading is a preset:

- ``table``: they are the shares g_k of Eq. 5, dimensionless. Their sum 0.5696 is below one, as it must be.
- ``creep``: they are samples of a creep compliance in 1/MPa; the first, 0.0233, is nearly 1/E = 0.0222. Inverted to a
  relaxation by the hereditary integral, taken straight in the logarithm of time between the samples. The compliance
  has a corner at 0.1 s that no Prony series follows: ∫ E(t − s) dJ(s) = 1, with E(0) = 1/0.02332 MPa, is met to
  33 % at it, to 17 % from 0.2 s, 7 % from 1 s and 3.3 % from 3 s on.
- ``single``: one time, the 15.5 s of the text (which is, to the digit, the shear modulus in MPa, so perhaps a slip),
  with the sum of the table as its share.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError

Array = NDArray[np.float64]

TABLE_TIMES = (0.01, 0.1, 1.0, 10.0, 100.0, 1000.0)
TABLE_SHARES = (0.02332, 0.023332, 0.083509, 0.11723, 0.14423, 0.178)
_SINGLE_TIME = 15.5
_CREEP_SHARES = (0.10718, 0.6634, 0.0515, 0.01528, 0.02049, 0.04518)
_CREEP_TIMES = (0.1194, 0.1893, 11.9432, 119.4322, 189.2872, 3000.0)


@dataclass(frozen=True)
class Relaxation:
    """g(t) = 1 − Σ shares_k (1 − exp(−t / times_k)); ``times`` in s, ascending.

    FormingError where the times do not ascend, or shares are negative or sum up to one or more.
    """

    shares: tuple[float, ...] = ()
    times: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if len(self.shares) != len(self.times):
            raise FormingError(
                f"a relaxation needs a time for each share; got {len(self.shares)} shares and {len(self.times)} times"
            )
        if not all(math.isfinite(x) and x > 0.0 for x in self.times):
            raise FormingError(f"relaxation times must be above 0 s; got {_listed(self.times)}")
        if any(a >= b for a, b in zip(self.times, self.times[1:], strict=False)):
            raise FormingError(f"relaxation times must ascend; sort {_listed(self.times)}, with their shares")
        if not all(math.isfinite(x) and x >= 0.0 for x in self.shares) or sum(self.shares) >= 1.0:
            raise FormingError(
                f"shares of a relaxation must be 0 or more and sum up to less than 1; got {_listed(self.shares)}"
            )

    @property
    def remaining(self) -> float:
        """What is left of the modulus after a long time, as a share of the instantaneous one."""
        return 1.0 - sum(self.shares)

    def at(self, time: Array | float) -> Array:
        """The modulus at ``time`` s (any shape) after a sudden strain, as a share of the instantaneous one."""
        t = np.asarray(time, dtype=np.float64)[..., None]
        lost = np.asarray(self.shares) * -np.expm1(-t / np.asarray(self.times))
        return np.asarray(1.0 - lost.sum(axis=-1))

    def after_ramp(self, time: Array | float) -> Array:
        """∫ g over (0, ``time``), s: the stress of a steady ramp over rate times instantaneous modulus."""
        t = np.asarray(time, dtype=np.float64)[..., None]
        g, tau = np.asarray(self.shares), np.asarray(self.times)
        return np.asarray(self.remaining * t[..., 0] + (g * tau * -np.expm1(-t / tau)).sum(axis=-1))

    def factors(self, step: float) -> tuple[Array, Array]:
        """What each term keeps (k,), and takes up of the change of the elastic stress (k,), in a step of ``step`` s.

        q_k ← keep_k q_k + take_k Δτ₀ is exact where the elastic stress is straight in time within steps
        (R. L. Taylor, K. S. Pister, G. L. Goudreau, Int. J. Numer. Meth. Eng. 2 (1970) 45).
        """
        x = step / np.asarray(self.times, dtype=np.float64)
        return np.exp(-x), np.asarray(self.shares) * -np.expm1(-x) / x


def _listed(numbers: tuple[float, ...]) -> str:
    return ", ".join(f"{x:g}" for x in numbers)


ELASTIC = Relaxation()
RELAXATIONS = {
    "table": Relaxation(TABLE_SHARES, TABLE_TIMES),
    "creep": Relaxation(_CREEP_SHARES, _CREEP_TIMES),
    "single": Relaxation((sum(TABLE_SHARES),), (_SINGLE_TIME,)),
    "elastic": ELASTIC,
}
"""Named relaxations; ``elastic`` has none: the instantaneous moduli."""
