"""Blind tests: measurements by an independent simulator, with a hidden effect, the truth under seal.

Nothing here uses the product's own geometry, net or effects (a test checks it), so that finding the hidden effect
proves something: the tools are analytic, the cells are chords, the generators straightest polygons, the relaxed nets
a global minimum.
"""

from geomdrap.blind.draw import KINDS_OF_SET
from geomdrap.blind.hidden import HIDDEN, LIBRARY, OUTSIDE
from geomdrap.blind.judge import GOOD, grade, parameters
from geomdrap.blind.make import make
from geomdrap.blind.seal import read_seal, unseal
from geomdrap.blind.tools import TOOLS

__all__ = [
    "GOOD",
    "HIDDEN",
    "KINDS_OF_SET",
    "LIBRARY",
    "OUTSIDE",
    "TOOLS",
    "grade",
    "make",
    "parameters",
    "read_seal",
    "unseal",
]
