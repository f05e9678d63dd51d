"""Drape a woven composite ply over a mould.

Conventions, once: mm and degrees at every surface; u along the warp, v along the weft, both arc lengths
in the flat fabric from the origin; shear = 90° − angle(warp, weft), positive where +u and +v close.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_HOMES = {
    "DrapeError": "errors",
    "EffectError": "errors",
    "FormingError": "errors",
    "GeomdrapError": "errors",
    "MeasurementError": "errors",
    "PluginError": "errors",
    "SurfaceError": "errors",
    "SweepError": "errors",
    "Surface": "surface",
    "read_surface": "surface",
    "shapes": "surface",
    "trace": "geodesic",
    "Effect": "fishnet",
    "Parameter": "fishnet",
    "Fabric": "fishnet",
    "Net": "fishnet",
    "Measurement": "measurement",
    "read_measurement": "measurement",
    "read_setup": "measurement",
    "compare": "criticism",
    "diagnose": "criticism",
    "improve": "criticism",
    "drape": "fishnet",
    "evaluate": "fields",
}

_PACKAGES = ("effects", "forming", "sweep")

__all__ = [
    "DrapeError",
    "Effect",
    "EffectError",
    "Fabric",
    "FormingError",
    "GeomdrapError",
    "Measurement",
    "MeasurementError",
    "Net",
    "Parameter",
    "PluginError",
    "Surface",
    "SurfaceError",
    "SweepError",
    "__version__",
    "compare",
    "diagnose",
    "drape",
    "effects",
    "evaluate",
    "forming",
    "improve",
    "read_measurement",
    "read_setup",
    "read_surface",
    "shapes",
    "sweep",
    "trace",
]


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used, so that ``import geomdrap`` stays instant."""
    if name in _PACKAGES:
        return import_module(f"geomdrap.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module 'geomdrap' has no attribute {name!r}")
    return getattr(import_module(f"geomdrap.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
