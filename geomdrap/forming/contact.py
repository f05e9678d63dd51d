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
    normal = np.array((nx, ny, nz))
    out = -depth / step
    slide = velocity - tool[VX : VZ + 1]
    slide -= normal * (slide @ normal)
    speed = math.sqrt(slide @ slide)
    if speed > 0.0:
        drag[:] = slide * (-min(tool[FRICTION] * out, speed) / speed)
    push[:] = normal * out
    velocity += push + drag
    depth, nx, ny, nz = gap(
        tool, point[0] + step * velocity[0], point[1] + step * velocity[1], point[2] + step * velocity[2]
    )
    if depth < 0.0:  # friction has pulled it back into a curved tool
        normal = np.array((nx, ny, nz))
        push += normal * (-depth / step)
        velocity += normal * (-depth / step)
    return True
