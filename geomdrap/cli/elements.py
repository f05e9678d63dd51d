"""The finite element mesh that a command line names, and the ply on it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from geomdrap.cli.options import FE_OUTPUTS

if TYPE_CHECKING:
    from geomdrap.export.fe_mesh import FeMesh
    from geomdrap.export.map_onto import ElementPly
    from geomdrap.fields import Drape


def fe_mesh_of(onto: Path | None, outputs: tuple[str, ...]) -> tuple[FeMesh | None, tuple[str, ...]]:
    """Read the mesh, before anything is computed, and add the outputs of its format where none is named."""
    if onto is None:
        return None, outputs
    if not outputs:
        raise click.UsageError("--onto names a mesh, but --outputs none writes no files", click.get_current_context())
    from geomdrap.export.fe_read import FORMATS, read_fe_mesh

    mesh = read_fe_mesh(onto)
    if not set(outputs) & set(FE_OUTPUTS):
        outputs = (*outputs, FORMATS[onto.suffix.lower()].output, "acp")
    return mesh, outputs


def ply_on(
    result: Drape, mesh: FeMesh | None, axis: tuple[float, float, float] | None, outputs: tuple[str, ...]
) -> ElementPly | None:
    """The ply on the mesh, or on the part's own facets; None where no output is of elements."""
    if not set(outputs) & set(FE_OUTPUTS):
        return None
    from geomdrap.export.map_onto import map_onto

    return map_onto(result, mesh, axis)


def notes_on(elements: ElementPly | None, outputs: tuple[str, ...]) -> list[str]:
    """Sentences on what is doubtful about the ply on the mesh, and what an output lacks of it."""
    if elements is None:
        return []
    from geomdrap.export.fe_nastran import losses

    return [*elements.notes(), *(losses(elements) if "nastran" in outputs else ())]
