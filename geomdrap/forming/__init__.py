"""The mechanical model: yarns as trusses in a viscoelastic membrane, stepped explicitly.

Units: mm, N, s, MPa, tonne. A `Sheet` (mesh) of a `Cloth` (laws) makes a `Model`, which is constant; a `State`
changes. Test specimens are in the modules ``coupon`` and ``fit_coupon``.
"""

from importlib import import_module
from types import ModuleType

from geomdrap.forming.cloth import Cloth, Fibre, Resin
from geomdrap.forming.contact import Tool
from geomdrap.forming.ledger import Ledger, ledger_of
from geomdrap.forming.model import Model, make_model
from geomdrap.forming.relaxation import ELASTIC, RELAXATIONS, Relaxation
from geomdrap.forming.run import Frame, Run, drive
from geomdrap.forming.sheet import Sheet, rectangle
from geomdrap.forming.state import State, start, take_steps

__all__ = [
    "ELASTIC",
    "RELAXATIONS",
    "Cloth",
    "Fibre",
    "Frame",
    "Ledger",
    "Model",
    "Relaxation",
    "Resin",
    "Run",
    "Sheet",
    "State",
    "Tool",
    "drive",
    "ledger_of",
    "make_model",
    "rectangle",
    "start",
    "take_steps",
]

_TESTS = ("coupon", "fit_coupon")


def __getattr__(name: str) -> ModuleType:
    """Load the modules of test specimens and of their fit when they are first used."""
    if name not in _TESTS:
        raise AttributeError(f"module 'geomdrap.forming' has no attribute {name!r}")
    return import_module(f"geomdrap.forming.{name}")
