"""Criticism of a model by measurements: where it fails, what is missing, and the model made better."""

from geomdrap.criticism.compare import compare, compare_net
from geomdrap.criticism.comparison import Comparison
from geomdrap.criticism.diagnose import diagnose
from geomdrap.criticism.diagnosis import Diagnosis
from geomdrap.criticism.improve import Improvement, improve

__all__ = ["Comparison", "Diagnosis", "Improvement", "compare", "compare_net", "diagnose", "improve"]
