"""Contact with rigid tools: exact distances, no penalty stiffness, Coulomb's friction.

A node that would end its step inside a tool is pushed out along the tool's normal by the velocity −gap/step; friction
takes from its sliding at most μ times that. The force is the momentum that this takes, so that it is exact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError
from geomdrap.geodesic.compiled import kernel

KINDS = ("plane", "sphere", "cylinder")
(KIND, PX, PY, PZ, AX, AY, AZ, RADIUS, FRICTION, VX, VY, VZ) = range(12)
"""Numbers of a tool: kind, a point of it, its normal or axis, radius, friction, velocity."""
NUMBERS = 12


@dataclass(frozen=True)
class Tool:
    """A rigid tool.

    ``kind`` plane, sphere or cylinder (of no end); ``point`` mm on the plane, or on the axis; ``direction`` of the
    normal, away from the tool, or of the axis; ``radius`` mm; ``friction`` of Coulomb; ``velocity`` mm/s. Fabric
    stays outside.
    """

    kind: str
    point: tuple[float, float, float]
    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
    radius: float = 0.0
    friction: float = 0.0
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise FormingError(f"there is no tool '{self.kind}'; choose {', '.join(KINDS)}")
        if self.friction < 0.0 or (self.kind != "plane" and not self.radius > 0.0):
            raise FormingError(
                f"a {self.kind} needs a radius above 0 mm and a friction of 0 or more; got {self.radius:g} and "
                f"{self.friction:g}"
            )
        if not any(self.direction):
            raise FormingError(f"the direction of a {self.kind} must not be 0,0,0")


def packed(tools: tuple[Tool, ...]) -> NDArray[np.float64]:
    """Numbers of the tools (t, NUMBERS) for the kernel."""
    rows = np.zeros((len(tools), NUMBERS))
    for row, tool in zip(rows, tools, strict=True):
        axis = np.asarray(tool.direction, dtype=np.float64) / np.linalg.norm(tool.direction)
        row[:] = KINDS.index(tool.kind), *tool.point, *axis, tool.radius, tool.friction, *tool.velocity
    return rows


@kernel
def gap(tool: NDArray, x: float, y: float, z: float) -> tuple[float, float, float, float]:
    """Distance of a point from the tool, negative inside, and the unit normal there."""
    dx, dy, dz = x - tool[PX], y - tool[PY], z - tool[PZ]
    along = dx * tool[AX] + dy * tool[AY] + dz * tool[AZ]
    if tool[KIND] == 0.0:
        return along, tool[AX], tool[AY], tool[AZ]
    if tool[KIND] == 2.0:
        dx, dy, dz = dx - along * tool[AX], dy - along * tool[AY], dz - along * tool[AZ]
    far = math.sqrt(dx * dx + dy * dy + dz * dz)
    if far == 0.0:
        return -tool[RADIUS], 0.0, 0.0, 1.0
    return far - tool[RADIUS], dx / far, dy / far, dz / far


@kernel
def meet(tool: NDArray, point: NDArray, velocity: NDArray, step: float, push: NDArray, drag: NDArray) -> bool:
    """Change ``velocity`` (3,) of a node at ``point`` (3,) so that its step ends outside the tool; whether it had to.

    ``push`` and ``drag`` (3,): the changes of velocity along and across the normal. The tool is where it is at the
    end.
    """
    push[:] = 0.0
    drag[:] = 0.0
    depth, nx, ny, nz = gap(
        tool, point[0] + step * velocity[0], point[1] + step * velocity[1], point[2] + step * velocity[2]
    )
    if depth >= 0.0:
        return False
    out = -depth / step
    push[0], push[1], push[2] = nx * out, ny * out, nz * out
    sx, sy, sz = velocity[0] - tool[VX], velocity[1] - tool[VY], velocity[2] - tool[VZ]
    along = sx * nx + sy * ny + sz * nz
    sx, sy, sz = sx - along * nx, sy - along * ny, sz - along * nz
    speed = math.sqrt(sx * sx + sy * sy + sz * sz)
    if speed > 0.0:
        share = -min(tool[FRICTION] * out, speed) / speed
        drag[0], drag[1], drag[2] = share * sx, share * sy, share * sz
    for c in range(3):
        velocity[c] += push[c] + drag[c]
    depth, nx, ny, nz = gap(
        tool, point[0] + step * velocity[0], point[1] + step * velocity[1], point[2] + step * velocity[2]
    )
    if depth < 0.0:  # friction has pulled it back into a curved tool
        out = -depth / step
        push[0], push[1], push[2] = push[0] + nx * out, push[1] + ny * out, push[2] + nz * out
        velocity[0], velocity[1], velocity[2] = velocity[0] + nx * out, velocity[1] + ny * out, velocity[2] + nz * out
    return True
