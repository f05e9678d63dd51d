"""Made tests/data/forming/kratos.npz: equilibria by Kratos Multiphysics 10.4.4 (membrane and truss elements).

``python tests/forming/make_kratos_fixture.py FILE`` where KratosMultiphysics and its StructuralMechanicsApplication are
installed. A square of distorted triangles with yarns along the grid is stretched, then twisted out of its plane; both
laws are Saint Venant–Kirchhoff's. The fixture holds the mesh, the two equilibria and the reactions of the moved side.
"""

from __future__ import annotations

import sys

import KratosMultiphysics as Km
import KratosMultiphysics.StructuralMechanicsApplication as Sm
import numpy as np

CELLS, PITCH = 6, 10.0
MODULUS, POISSON, THICKNESS = 45.0, 0.45, 2.0
YARN_MODULUS, SECTION = 2000.0, 5.0


def mesh() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nodes (n, 3), triangles, yarn pieces."""
    i, j = np.meshgrid(np.arange(CELLS + 1), np.arange(CELLS + 1), indexing="ij")
    points = PITCH * np.column_stack([i.ravel(), j.ravel(), 0 * i.ravel()]).astype(float)
    inner = np.all((points[:, :2] > 1.0) & (points[:, :2] < CELLS * PITCH - 1.0), axis=1)
    points[inner, :2] += np.random.default_rng(1).uniform(-2.0, 2.0, (inner.sum(), 2))
    n = np.arange(points.shape[0]).reshape(i.shape)
    a, b, c, d = n[:-1, :-1].ravel(), n[1:, :-1].ravel(), n[1:, 1:].ravel(), n[:-1, 1:].ravel()
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    pieces = np.concatenate(
        [np.stack([n[:-1].ravel(), n[1:].ravel()], 1), np.stack([n[:, :-1].ravel(), n[:, 1:].ravel()], 1)]
    )
    return points, triangles, pieces


def model_part(points: np.ndarray, triangles: np.ndarray, pieces: np.ndarray) -> tuple:
    """The model, and its part with elements and degrees of freedom."""
    model = Km.Model()
    part = model.CreateModelPart("sheet")
    part.ProcessInfo[Km.DOMAIN_SIZE] = 3
    for variable in (Km.DISPLACEMENT, Km.REACTION, Km.VOLUME_ACCELERATION):
        part.AddNodalSolutionStepVariable(variable)
    for k, place in enumerate(points, 1):
        part.CreateNewNode(k, *place)
    resin, yarn = part.CreateNewProperties(1), part.CreateNewProperties(2)
    for key, value in ((Km.THICKNESS, THICKNESS), (Km.YOUNG_MODULUS, MODULUS), (Km.POISSON_RATIO, POISSON)):
        resin.SetValue(key, value)
    resin.SetValue(Km.DENSITY, 1e-9)
    resin.SetValue(Km.CONSTITUTIVE_LAW, Sm.LinearElasticPlaneStress2DLaw())
    resin.SetValue(Sm.PRESTRESS_VECTOR, Km.Vector(3, 0.0))
    for key, value in ((Sm.CROSS_AREA, SECTION), (Km.YOUNG_MODULUS, YARN_MODULUS), (Km.DENSITY, 1e-9)):
        yarn.SetValue(key, value)
    yarn.SetValue(Sm.TRUSS_PRESTRESS_PK2, 0.0)
    yarn.SetValue(Km.CONSTITUTIVE_LAW, Sm.TrussConstitutiveLaw())
    for k, t in enumerate(triangles, 1):
        part.CreateNewElement("MembraneElement3D3N", k, [int(x) + 1 for x in t], resin)
    for k, t in enumerate(pieces, len(triangles) + 1):
        part.CreateNewElement("TrussElement3D2N", k, [int(x) + 1 for x in t], yarn)
    for name in "XYZ":
        Km.VariableUtils().AddDof(
            getattr(Km, f"DISPLACEMENT_{name}"), getattr(Km, f"REACTION_{name}"), part
        )
    return model, part


def solve(part: object, points: np.ndarray, moved: np.ndarray, flat: bool) -> tuple[np.ndarray, np.ndarray]:
    """Displacements and reactions (n, 3) with the left side fixed and the right one moved by ``moved`` (n, 3)."""
    size = CELLS * PITCH
    for node, place, by in zip(part.Nodes, points, moved, strict=True):  # type: ignore[attr-defined]
        node.Free(Km.DISPLACEMENT_Z)
        if flat:
            node.Fix(Km.DISPLACEMENT_Z)
        if place[0] < 1e-9 or place[0] > size - 1e-9:
            for k, name in enumerate("XYZ"):
                variable = getattr(Km, f"DISPLACEMENT_{name}")
                node.Fix(variable)
                node.SetSolutionStepValue(variable, float(by[k]))
    scheme = Km.ResidualBasedIncrementalUpdateStaticScheme()
    criterion = Km.ResidualCriteria(1e-15, 1e-12)
    criterion.SetEchoLevel(0)
    builder = Km.ResidualBasedBlockBuilderAndSolver(Km.SkylineLUFactorizationSolver())
    strategy = Km.ResidualBasedNewtonRaphsonStrategy(part, scheme, criterion, builder, 40, True, False, True)
    strategy.SetEchoLevel(0)
    strategy.Initialize()
    strategy.Solve()
    u = np.array([list(n.GetSolutionStepValue(Km.DISPLACEMENT)) for n in part.Nodes])  # type: ignore[attr-defined]
    r = np.array([list(n.GetSolutionStepValue(Km.REACTION)) for n in part.Nodes])  # type: ignore[attr-defined]
    return u, r


def main(path: str) -> None:
    """Solve and write."""
    points, triangles, pieces = mesh()
    _, part = model_part(points, triangles, pieces)
    right = points[:, 0] > CELLS * PITCH - 1e-9
    stretch = np.zeros_like(points)
    stretch[right, 0] = 6.0
    found = {}
    for k in range(1, 5):
        found["stretched"], found["stretched_reaction"] = solve(part, points, k / 4 * stretch, True)
    middle = 0.5 * CELLS * PITCH
    for k in range(1, 9):
        twist = stretch.copy()
        angle = np.deg2rad(30.0) * k / 8
        y = points[right, 1] - middle
        twist[right, 1], twist[right, 2] = y * (np.cos(angle) - 1.0), y * np.sin(angle)
        found["twisted"], found["twisted_reaction"] = solve(part, points, twist, False)
    np.savez_compressed(
        path, points=points, triangles=triangles, pieces=pieces, **found, modulus=MODULUS, poisson=POISSON,
        thickness=THICKNESS, yarn_modulus=YARN_MODULUS, section=SECTION,
    )  # fmt: skip


if __name__ == "__main__":
    main(sys.argv[1])
