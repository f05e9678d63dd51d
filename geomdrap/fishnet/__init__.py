"""The fishnet: cells of inextensible yarn pieces, closed one by one from a seed."""

from geomdrap.fishnet.drape import drape
from geomdrap.fishnet.effect import Effect
from geomdrap.fishnet.fabric import Fabric
from geomdrap.fishnet.grid import Status
from geomdrap.fishnet.net import Net
from geomdrap.fishnet.parameter import Parameter
from geomdrap.fishnet.shift import Shift

__all__ = ["Effect", "Fabric", "Net", "Parameter", "Shift", "Status", "drape"]
