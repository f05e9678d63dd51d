"""Straightest geodesics across unfolded triangles."""

from geomdrap.geodesic.trace import Stop, Trace, trace

__all__ = ["Stop", "Trace", "trace"]
