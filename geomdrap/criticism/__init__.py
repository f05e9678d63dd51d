"""Criticism of a model by measurements: where it fails, what is missing, and the model made better."""

from geomdrap.criticism.compare import compare, compare_net
from geomdrap.criticism.comparison import Comparison

__all__ = ["Comparison", "compare", "compare_net"]
