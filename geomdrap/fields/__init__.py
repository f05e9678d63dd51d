"""What a net comes to on the part and in the flat fabric."""

from geomdrap.fields.evaluate import evaluate
from geomdrap.fields.result import Drape, FlatPattern

__all__ = ["Drape", "FlatPattern", "evaluate"]
