"""The net: where every crossing of the fabric lies on the part, and how much each cell shears."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fishnet.fabric import Fabric

if TYPE_CHECKING:
    from geomdrap.fishnet.effect import Effect
    from geomdrap.fishnet.relax_net import Balance
    from geomdrap.surface import Surface


def cells_of(nodes: np.ndarray) -> np.ndarray:
    """The values (nu, nv) of the four corners of each cell, (4, nu - 1, nv - 1)."""
    return np.stack([nodes[:-1, :-1], nodes[1:, :-1], nodes[1:, 1:], nodes[:-1, 1:]])


@dataclass(frozen=True, eq=False)
class Net:
    """A draped fabric as a net of nodes.

    ``u`` (nu,), ``v`` (nv,) mm from the origin along warp and weft in the flat fabric; ``points`` (nu, nv, 3) mm,
    NaN where there is no node; ``face`` (nu, nv) the face of ``surface`` it lies on, -1 where none; ``status``
    (nu, nv) of ``Status``: why a node is absent; ``status_around`` (nu + 2, nv + 2) the same with a frame of
    one node more. ``cell_valid`` (nu - 1, nv - 1): the four sides of the cell exist. ``lattice`` and
    ``lattice_valid`` are ``points`` and ``cell_valid`` with the nodes over holes as well. ``yarns``
    (2, nu, nv, 3) are the unit directions of warp and weft at them. ``cell_shear`` (nu - 1, nv - 1) and ``shear``
    (nu, nv) are signed, in degrees, NaN where there is no cell or no node (see ``shears``). ``origin`` (3,) mm,
    ``warp0``, ``weft0``, ``normal0`` (3,) unit vectors there; ``angle`` degrees; ``pitch`` mm; ``reach`` half
    lengths of the blank, mm. ``sides`` are the lengths of the warp pieces (nu - 1, nv) and weft pieces (nu, nv - 1)
    as they lie, mm; None where all have the length that they have in the flat fabric. ``effects`` are those that
    acted, in their order. ``guided`` says that generators follow curves of the user's. ``moved`` (nu, nv, 3) mm: how
    far nodes have gone to where the energy is least, those beyond the rim too, and ``balance`` what that came from;
    None for a net that is not relaxed. ``slid``: likewise what crossings that have slid came from.
    ``notes`` say what was chosen, ``warnings`` what the user should look at.
    """

    surface: Surface
    fabric: Fabric
    origin: np.ndarray
    origin_face: int
    warp0: np.ndarray
    weft0: np.ndarray
    normal0: np.ndarray
    angle: float
    pitch: float
    reach: tuple[float, float] | None
    u: np.ndarray
    v: np.ndarray
    points: np.ndarray
    face: np.ndarray
    status_around: np.ndarray
    cell_valid: np.ndarray
    lattice: np.ndarray
    lattice_valid: np.ndarray
    yarns: np.ndarray
    cell_shear: np.ndarray
    shear: np.ndarray
    sides: tuple[np.ndarray, np.ndarray] | None = field(default=None)
    effects: tuple[Effect, ...] = field(default=())
    guided: bool = field(default=False)
    moved: np.ndarray | None = field(default=None)
    balance: Balance | None = field(default=None)
    slid: Balance | None = field(default=None)
    notes: tuple[str, ...] = field(default=())
    warnings: tuple[str, ...] = field(default=())

    def __repr__(self) -> str:
        acted = "".join(f" + {e.name}" for e in self.effects)
        nodes = int((self.face >= 0).sum())
        return f"<Net of {nodes:,} nodes, pitch {self.pitch:g} mm, on {self.surface.source!r}{acted}>"

    @property
    def status(self) -> np.ndarray:
        """Why each node is present or absent (nu, nv), values of ``Status``."""
        return self.status_around[1:-1, 1:-1]

    @property
    def is_geodesic(self) -> bool:
        """Whether its generators are geodesics at right angles and its shear is what the part's curvature gives."""
        from geomdrap.fishnet.effect import Effect

        plain = self.fabric.is_geodesic and not self.guided
        return plain and all(type(e).on_net is Effect.on_net for e in self.effects)

    def interpolate(self, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points (n, 3) mm on the surface and shear (n,) degrees at fabric coordinates u, v (n,) mm.

        Bilinear in the cell, then moved onto the surface; NaN outside the valid cells.
        """
        from geomdrap.fishnet.interpolate import at_fabric_coordinates

        return at_fabric_coordinates(self, np.atleast_1d(u), np.atleast_1d(v))

    def directions(self, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Unit directions of warp and weft (n, 3) in space at fabric coordinates u, v (n,) mm.

        Toward +u and +v, bilinear in the cell; NaN outside the valid cells.
        """
        from geomdrap.fishnet.interpolate import directions_at

        return directions_at(self, np.atleast_1d(u), np.atleast_1d(v))
