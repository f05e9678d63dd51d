"""The tool: reading, repairing and asking a triangle surface."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from geomdrap.surface.findings import Findings
from geomdrap.surface.nearest import Nearest
from geomdrap.surface.surface import Surface

__all__ = ["Findings", "Nearest", "Surface", "check", "read_surface", "samples", "shapes"]


def __getattr__(name: str) -> Any:
    """Load readers, shapes, samples and the check only where they are used."""
    if name == "read_surface":
        return import_module("geomdrap.surface.read").read_surface
    if name in ("check", "samples", "shapes"):
        return import_module(f"geomdrap.surface.{name}")
    raise AttributeError(f"module 'geomdrap.surface' has no attribute {name!r}")
