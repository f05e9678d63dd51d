"""Runs of a test with the same masses and the same steps, so that its curve is a smooth function of the cloth.

With masses and steps of its own each cloth would vibrate in another rhythm, and its forces would jump by some 0.1 %
from one cloth to the next: more than what a slope by differences is made of.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.forming.biaxial import biaxial_specimen
from geomdrap.forming.cloth import Cloth, changed
from geomdrap.forming.coupon import enough_steps
from geomdrap.forming.identify import ResizedError
from geomdrap.forming.specimen import Specimen
from geomdrap.forming.stable_step import row_sums
from geomdrap.forming.uniaxial import strip_specimen

Array = NDArray[np.float64]

MARGIN = 2.0
"""Masses are sized for a cloth so many times stiffer than the one at hand."""
FINER = 2.0**0.5
"""Steps over those of a single run, to make up for the `MARGIN` of the masses."""
WILD = 16.0
"""Times the stiffness that is held, or the square of the steps, from which a cloth is not run at all."""
CRIMPED = 1.0
"""Undulation beyond which no cloth is: yarns would be nearly three times as long as their cloth."""
SOFT = 1e7
"""Times the modulus of the resin from which on that of the yarns has nothing to do with it."""
SIZES = ("length", "width", "angle", "ratio", "cells")
"""Settings that make the specimen; the others are those of its run."""


class Held:
    """Masses and steps for the cloths that a fit of ``test`` with ``settings`` tries; at first for ``cloth``.

    They last for yarns up to `MARGIN` times stiffer, and for a ratio of yarn to shear stiffness up to `FINER`² times
    larger. ``settings`` with the steps given keep to these. A picture frame has neither inertia nor steps that depend
    on the cloth.
    """

    def __init__(self, test: str, settings: Mapping[str, Any], cloth: Cloth):
        self.test, self.given = test, dict(settings)
        self._made = None if self.is_frame else specimen_of(test, settings, cloth)
        self._size(cloth)

    @property
    def settings(self) -> dict[str, Any]:
        """Those of a run with what is held."""
        return dict(self.given) if self.is_frame else {**self.given, "steps": self.steps, "sized_for": self.stiffest}

    @property
    def is_frame(self) -> bool:
        """Whether there is nothing to hold."""
        return self.test == "picture-frame"

    def takes(self, cloth: Cloth) -> bool:
        """Whether ``cloth`` can be run with what is held; false where it is too wild to be run at all.

        ResizedError where it asks for more than is held, which has been enlarged then.
        """
        if is_absurd(cloth):
            return False
        need = 0.0 if self.is_frame else max(self._stiffness(cloth), self._slowness(cloth))
        if need > WILD:
            return False
        if need > 1.0:
            self._size(cloth, self.stiffest, self.steps)
            raise ResizedError
        return True

    def _size(self, cloth: Cloth, before: Cloth | None = None, steps: int = 0) -> None:
        if self.is_frame:
            return
        self.stiffest = stiffer(cloth, MARGIN)
        if before is not None:
            self.stiffest = stiffer_of(self.stiffest, before)
        self._rows = row_sums(self._specimen(cloth).sheet, self.stiffest)
        self.steps = self.given.get("steps") or max(round(FINER * self._enough(cloth)), steps)

    def _stiffness(self, cloth: Cloth) -> float:
        """The largest stiffness of a node over the one that is held."""
        rows = row_sums(self._specimen(cloth).sheet, cloth)
        stiff = self._rows > 0.0
        return float(np.max(rows[stiff] / self._rows[stiff]))

    def _slowness(self, cloth: Cloth) -> float:
        """The square of the steps that ``cloth`` asks for over those that are held."""
        return 0.0 if self.given.get("steps") else (self._enough(cloth) / self.steps) ** 2

    def _enough(self, cloth: Cloth) -> int:
        return enough_steps(self._specimen(cloth))

    def _specimen(self, cloth: Cloth) -> Specimen:
        assert self._made is not None  # a picture frame asks for none
        return replace(self._made, cloth=cloth)


def is_absurd(cloth: Cloth) -> bool:
    """Whether values lie where no cloth is, and where a fit would only lose its way."""
    stiffest = max(f.modulus for f in cloth.families)
    return max(f.undulation for f in cloth.families) > CRIMPED or stiffest > SOFT * cloth.resin.modulus > 0.0


def specimen_of(test: str, settings: Mapping[str, Any], cloth: Cloth) -> Specimen:
    """The specimen of a ``test`` other than the picture frame; settings of its run are left alone."""
    sizes = {key: value for key, value in settings.items() if key in SIZES}
    return biaxial_specimen(cloth, **sizes) if test == "biaxial" else strip_specimen(cloth, **sizes)


def stiffer(cloth: Cloth, times: float) -> Cloth:
    """``cloth`` with all moduli ``times`` as large."""
    warp, weft = (changed(f, modulus=times * f.modulus) for f in cloth.families)
    return changed(cloth, warp=warp, weft=weft, resin=changed(cloth.resin, modulus=times * cloth.resin.modulus))


def stiffer_of(a: Cloth, b: Cloth) -> Cloth:
    """``a`` with each modulus the larger of the two."""
    warp, weft = (changed(f, modulus=max(f.modulus, g.modulus)) for f, g in zip(a.families, b.families, strict=True))
    return changed(a, warp=warp, weft=weft, resin=changed(a.resin, modulus=max(a.resin.modulus, b.resin.modulus)))
