"""The library of physical effects: what the fishnet leaves out, a file each, found by name."""

from geomdrap.effects.model_file import read_layup, read_model, write_model
from geomdrap.effects.plugin import load_plugin
from geomdrap.effects.registry import available, find, make, parse, register

__all__ = ["available", "find", "load_plugin", "make", "parse", "read_layup", "read_model", "register", "write_model"]
