"""Measured tables: reading, matching to a net, noise, outliers."""

from geomdrap.measurement.measurement import Measurement
from geomdrap.measurement.read import read_measurement
from geomdrap.measurement.setup import Setup, read_setup

__all__ = ["Measurement", "Setup", "read_measurement", "read_setup"]
